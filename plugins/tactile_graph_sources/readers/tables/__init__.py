"""Plain tables: how the numbers lie in them, by their words and by the numbers themselves."""
