"""What is seen from frame to frame only: garbage, leaps of time, any range, which file."""
