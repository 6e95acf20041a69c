"""The posterior of one outline."""
