"""Several outlines at once, and how many there are."""
