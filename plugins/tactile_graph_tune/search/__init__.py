"""Choices weighed against the table, and the least that any could reach."""
