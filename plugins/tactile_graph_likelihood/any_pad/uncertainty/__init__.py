"""How certain an outline is said to be, and when it is flagged."""
