"""Step ``mean_reading``: the mean of an object's last few readings."""

from __future__ import annotations

from collections import deque
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.steps import Quantity, TimeGap
from tactile_graph_classifiers.measuring.measurements import Measurements


class MeanReading:
    """Return the mean of the last few readings, or of as many as there are.

    Parameters
    ----------
    readings : int
        How many; Christ and Sanderson present a test object five times (thesis section 4.4.1).
    start_anew_s : float, optional
        Forget the readings before a gap longer than this, or where the clock goes back: another
        object may lie there.
    """

    def __init__(
        self,
        *,
        readings: Annotated[int, Ge(1)] = 5,
        start_anew_s: Annotated[float, Gt(0)] | None = None,
    ) -> None:
        self.remembers = readings
        self._kept: deque[NDArray[np.float64]] = deque(maxlen=readings)
        self._names: tuple[str, ...] = ()
        self._start_anew_s = start_anew_s

    def __call__(
        self, features: Measurements, *, gap_s: TimeGap = None
    ) -> Annotated[Measurements, Quantity.like("features")]:
        """Return the mean with this reading included."""
        longest_s = self._start_anew_s
        anew = gap_s is not None and longest_s is not None and not 0.0 <= gap_s <= longest_s
        if anew or features.names != self._names:
            self._kept.clear()
        self._names = features.names
        self._kept.append(features.values)
        return Measurements(features.names, np.mean(self._kept, axis=0), features.quantity)
