"""What the text of each section states, chapters 2 to 6, and what here measures it."""
