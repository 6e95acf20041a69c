"""Images cut down, smoothed and cut into finer cells."""
