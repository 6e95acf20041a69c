"""Outlines fitted to readings under each pressure: the first, further climbs, contests of kinds."""
