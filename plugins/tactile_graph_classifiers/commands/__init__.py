"""Commands about known objects."""
