"""Commands about devices and recordings."""
