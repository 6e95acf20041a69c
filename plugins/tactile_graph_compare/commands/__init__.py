"""The commands ``compare`` and ``audit``."""
