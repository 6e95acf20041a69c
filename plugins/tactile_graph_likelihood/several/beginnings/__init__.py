"""Where the search for several outlines begins: touched elements in as many sets."""
