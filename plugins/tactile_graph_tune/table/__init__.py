"""What every node came to in every frame, kept once."""
