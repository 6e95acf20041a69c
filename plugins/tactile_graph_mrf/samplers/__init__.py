"""Restorers that draw from the distribution the energy means."""
