"""Circles fitted to points and loads."""
