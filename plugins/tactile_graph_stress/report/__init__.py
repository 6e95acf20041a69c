"""What the rows of a study look like to people and programs."""
