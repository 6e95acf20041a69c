"""The colours of what is drawn over a pad, the same in picture strips and reports."""

from __future__ import annotations

from tactile_graph.wires.cells_png import MASK_OFF as MASK_OFF
from tactile_graph.wires.cells_png import MASK_ON as MASK_ON
from tactile_graph.wires.notebook import TRUE as TRUE

FOUND = "#d81b60"
"""What was found; of what is `TRUE` apart for the colour-blind and in grey."""
BEFORE = "#1f4fa8"
"""What an earlier variant found, where two are laid over one another."""
SKIPPED, FAILED = "#f3f3f3", "#fde7e7"
