"""Frames as they come: read by one thread, answered by another, the oldest shed under load."""

from tactile_graph.engine.calls.isolated import ProcessState
from tactile_graph.engine.deadlines.deadline import Deadline
from tactile_graph.engine.deadlines.options import Recorded
from tactile_graph.live.beside import Beside
from tactile_graph.live.live_result import LiveResult
from tactile_graph.live.live_run import LiveRun
from tactile_graph.live.live_stream import LiveStream
from tactile_graph.live.paced import paced

__all__ = [
    "Beside",
    "Deadline",
    "LiveResult",
    "LiveRun",
    "LiveStream",
    "ProcessState",
    "Recorded",
    "paced",
]
