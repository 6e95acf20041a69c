"""How the figures are drawn: masks, points and outlines in cm, numbers beside numbers."""
