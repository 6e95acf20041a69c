"""The posterior around its mode: few points drawn evenly, and their weights."""
