"""Outlines as numbers, and how much of each element they cover."""
