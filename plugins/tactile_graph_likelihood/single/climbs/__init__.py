"""From an image to the mode of the posterior: where a search begins, and its steps."""
