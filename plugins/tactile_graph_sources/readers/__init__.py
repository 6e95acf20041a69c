"""Readers of recordings, one format a file: ``recognises(head)`` and ``read(reading)``."""
