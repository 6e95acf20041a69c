"""Commands of the stress family."""
