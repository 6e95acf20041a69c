"""Recordings as Zarr stores: what lies in them, what vouches for it, what is mended."""
