"""Outlines of known objects: which of them it is."""
