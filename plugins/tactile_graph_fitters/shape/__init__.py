"""What kind of shape an outline is."""
