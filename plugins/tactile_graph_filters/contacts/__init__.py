"""The separate contacts of a footprint, and what is done to them."""
