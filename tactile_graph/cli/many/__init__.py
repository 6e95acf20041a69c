"""``run`` with workers: what they do, what is kept of it, how it is gone on with."""
