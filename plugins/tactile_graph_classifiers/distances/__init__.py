"""Which known object is nearest, by several distances."""
