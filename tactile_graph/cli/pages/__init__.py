"""What commands show of what there is: lists, searches, one thing in full."""
