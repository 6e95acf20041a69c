"""The command ``reproduce`` and what it shows."""
