"""Chapter 6: what the conclusions wish for."""
