"""The frames through the merged graph, and what each variant alone would have given."""
