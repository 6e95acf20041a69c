"""The command ``live``."""
