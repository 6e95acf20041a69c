"""Comparisons as tables and files."""
