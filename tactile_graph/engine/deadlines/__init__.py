"""What may be left undone when time is short, and who decides about it."""
