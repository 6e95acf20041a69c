"""From readings of known loads to grams."""
