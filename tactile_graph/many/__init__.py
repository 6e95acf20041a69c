"""Many frames: work in portions, done by other processes, its results in order."""

from tactile_graph.many.division import one_process_only
from tactile_graph.many.executor_kind import ExecutorKind, Opened, Place
from tactile_graph.many.feed import Feed
from tactile_graph.many.portion import Portion
from tactile_graph.many.reading import Reader, Reading
from tactile_graph.many.sharing import KILLER, Sharing, for_the_way

__all__ = [
    "KILLER",
    "ExecutorKind",
    "Feed",
    "Opened",
    "Place",
    "Portion",
    "Reader",
    "Reading",
    "Sharing",
    "for_the_way",
    "one_process_only",
]
