"""What operations call: steps with all they need, for each item, in processes apart, watched."""
