"""Which format a file is of, what is said of one of no format, which sensor is asked for."""
