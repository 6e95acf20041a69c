"""From counts to grams, cell by cell, and which cells can be believed."""
