"""The tables and figures, by chapter and subject."""
