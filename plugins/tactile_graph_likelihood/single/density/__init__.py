"""How probable an outline is, given what the elements read: density, slopes, information."""
