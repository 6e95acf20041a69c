"""What was found, for people and files."""
