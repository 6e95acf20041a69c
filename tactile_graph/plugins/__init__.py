"""Plugins: the hooks they may answer and the registry of what they offer."""
