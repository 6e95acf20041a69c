"""A pad's record made from recordings of it."""
