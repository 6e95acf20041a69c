"""Pipeline files: read, checked in full, and turned into a frozen graph."""
