"""Chapter 3: the techniques, each shown on its own."""
