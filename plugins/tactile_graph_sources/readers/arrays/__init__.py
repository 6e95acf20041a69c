"""Arrays as they lie in files: NumPy's, MATLAB's, HDF5, Zarr stores, pictures."""
