"""The main axis of a footprint, and what is turned about it."""
