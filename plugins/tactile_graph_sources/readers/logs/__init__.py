"""Logs of messages (MCAP): which hold frames, and what these hold."""
