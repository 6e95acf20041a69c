"""Conditions of ``when``: compiled, over the items of lists, refused where they are nonsense."""
