"""Step ``threshold_learned``: the cells that read more than an empty pad does."""

from __future__ import annotations

from typing import Annotated, Any

from annotated_types import Gt
from pydantic import AllowInfNan

from tactile_graph.errors import RuleError
from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.thresholds.threshold import footprint


class ThresholdLearned:
    """Turn on the valid cells that reach the level from which a learned pad is touched.

    Parameters
    ----------
    pad : str or mapping
        A file that ``tactile-graph learn-pad`` has written: the level is six times its noise, or
        the one at which contacts at known places were counted right most often.
    times : float
        The level, over that.

    Raises
    ------
    UsageError
        If the pad was not learned from recordings.

    Notes
    -----
    The level is above the offset: put ``correct_readings`` before this step.
    """

    stateless = True

    def __init__(
        self, *, pad: str | dict[str, Any], times: Annotated[float, Gt(0), AllowInfNan(False)] = 1.0
    ) -> None:
        from tactile_graph_pads.pad import learned_of

        learned = learned_of(pad)
        self._level, self._reading = times * learned.touched_from, learned.reading

    def __call__(self, image: Image) -> Annotated[Mask, Grid.like("image")]:
        """Return the mask of the cells that are on.

        Raises
        ------
        RuleError
            If the image holds another quantity than the pad was learned from.
        """
        if image.quantity != self._reading:
            raise RuleError(f"the pad was learned from {self._reading}, got {image.quantity}")
        return footprint(image, self._level)
