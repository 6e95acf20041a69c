"""Steps: what they need, read from their signatures, and the rules they can declare."""

from tactile_graph.steps.injected import Report, TimeGap
from tactile_graph.steps.linked import Linked
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.steps.spread import Spread

__all__ = ["Grid", "Linked", "Quantity", "Report", "Spread", "TimeGap"]
