"""Outlines whose loads add up: their joint density, mode, evidence and posteriors."""
