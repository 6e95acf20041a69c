"""The command ``tune``."""
