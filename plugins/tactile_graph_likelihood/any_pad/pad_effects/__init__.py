"""What a pad does to readings that nobody told: unevenness, gaps, turn-on, limits, foam, rims."""
