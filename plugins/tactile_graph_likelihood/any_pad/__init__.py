"""Outlines on pads that nobody described: noise, threshold and unevenness from the frame itself."""
