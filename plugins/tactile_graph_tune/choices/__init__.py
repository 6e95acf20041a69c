"""What of a pipeline may be chosen: comparisons, the order of its ladder, free settings."""
