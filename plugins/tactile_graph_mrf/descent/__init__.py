"""Restorers that lower the energy by rules."""
