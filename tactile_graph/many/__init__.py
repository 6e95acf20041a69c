"""Many frames: work in portions, done by other processes, its results in order."""

from tactile_graph.many.executor_kind import ExecutorKind, Opened

__all__ = ["ExecutorKind", "Opened"]
