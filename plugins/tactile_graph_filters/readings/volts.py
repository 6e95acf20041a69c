"""Step ``volts``: a converter's counts as the voltages they stand for."""

from __future__ import annotations

import math
import sys
from typing import Annotated, Any

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import refuse_nan


@compiled_later
def to_volts(counts, zero, step, first, last, out):  # type: ignore[no-untyped-def]
    """Write ``(counts - zero) * step`` into ``out``; return how many are within first and last."""
    possible = 0
    for i in range(counts.shape[0]):
        given, wanted = counts[i], out[i]
        for j in range(counts.shape[1]):
            wanted[j] = (given[j] - zero) * step
            possible += first <= given[j] <= last
    return possible


class Volts:
    """Return the voltages that (averaged) counts stand for.

    Parameters
    ----------
    pad : str or mapping
        Name of a pad, its YAML file, or the pad itself: its converter is meant.
    keep_full_scale : bool
        Whether a cell at the converter's last count is kept: there the voltage may be anything
        from that on. It becomes invalid otherwise.

    Notes
    -----
    Thesis section 4.1: 12 bits over -5 to 5 V. Counts that the converter cannot give become
    invalid; they are never clipped.
    """

    stateless = True

    def __init__(
        self, *, pad: str | dict[str, Any] = "thesis", keep_full_scale: bool = False
    ) -> None:
        from tactile_graph_pads.pad import load_pad

        converter = load_pad(pad).converter
        self._zero, self._step = converter.zero_counts, converter.step_v
        ideal = converter.bits is None
        last = 2.0 ** (converter.bits or 0) - 1.0
        self._first = -sys.float_info.max if ideal else 0.0
        self._last = (
            sys.float_info.max if ideal else last if keep_full_scale else math.nextafter(last, 0.0)
        )

    def __call__(
        self, image: Annotated[Image, Quantity("counts")]
    ) -> Annotated[Image, Quantity("volt"), Grid.like("image")]:
        """Return the image in volts."""
        counts, valid = image.values, image.valid
        volts = np.empty(counts.shape)
        n = to_volts(counts, self._zero, self._step, self._first, self._last, volts)
        if n != counts.size:
            refuse_nan(image)
            possible = (counts >= self._first) & (counts <= self._last)
            valid = possible if valid is None else valid & possible
        if valid is not None:
            volts[~valid] = 0.0
        return Image(volts, image.pitch_cm, image.origin_cm, "volt", valid)
