"""Formats of text that no instrument stands for: plain tables in three layouts, JSON."""
