"""Recordings written: NumPy files, tables, Zarr stores."""
