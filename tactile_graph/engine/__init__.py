"""The engine: a graph and a demand become a flat plan, and frames run through it."""
