"""Plain tables: how they are recognised, taken apart and read."""
