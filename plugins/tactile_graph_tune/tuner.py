"""``tune``: from one run of everything to a pipeline file with its guards, order and settings."""

from __future__ import annotations

from collections.abc import Sequence

from tactile_graph.wires.frame import Frame
from tactile_graph_tune.finish import finished
from tactile_graph_tune.request import Request
from tactile_graph_tune.searching import Told, searched
from tactile_graph_tune.tuned import Tuned


def tune(
    request: Request,
    frames: Sequence[Frame],
    held_out: Sequence[Frame] = (),
    told: Told = lambda what, n, of: None,
) -> Tuned:
    """Return the guards, the order and the settings that are cheapest for their error.

    Parameters
    ----------
    request : Request
    frames : sequence of Frame
        With their truth; those without are left out.
    held_out : sequence of Frame
        Frames to report on; half of ``frames`` if there are none.
    told : callable

    Raises
    ------
    UsageError
        If there is no truth, nothing to choose, nothing that answers, or too little to tell.
    """
    return finished(searched(request, frames, held_out, told), told)
