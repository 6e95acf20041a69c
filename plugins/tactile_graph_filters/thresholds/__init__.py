"""The cells that are touched: levels, told or found."""
