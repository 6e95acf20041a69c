"""Frames as they come: read by one thread, answered by another, the oldest shed under load."""

from tactile_graph.live.live_result import LiveResult
from tactile_graph.live.live_run import LiveRun
from tactile_graph.live.paced import paced

__all__ = ["LiveResult", "LiveRun", "paced"]
