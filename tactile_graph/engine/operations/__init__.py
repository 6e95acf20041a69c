"""What stands in a program for each node: a step called, fields read, guards, what is frozen."""
