"""Rectangles fitted to outlines and loads."""
