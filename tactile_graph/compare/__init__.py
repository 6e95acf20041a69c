"""Compare variants: merged into one graph, on the same frames, against the same truth."""

from tactile_graph.compare.records import Comparison
from tactile_graph.compare.side_by_side import compare
from tactile_graph.compare.wanted import Wanted

__all__ = ["Comparison", "Wanted", "compare"]
