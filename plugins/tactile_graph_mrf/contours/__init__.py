"""Objects read off line fields."""
