"""What the right answers are, to 50 digits, and how much rounding of the input may move them."""
