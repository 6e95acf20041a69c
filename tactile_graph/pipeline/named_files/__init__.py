"""Files that settings name: found, told apart by what stands in them, named from elsewhere."""
