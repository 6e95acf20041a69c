"""Ellipses fitted to points."""
