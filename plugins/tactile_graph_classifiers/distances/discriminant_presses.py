"""Step ``discriminant_presses``: the likeliest known object by the last few presses together."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge, Gt, Lt, MinLen

from tactile_graph.steps import TimeGap
from tactile_graph_classifiers.database.choice import CONFIDENCE
from tactile_graph_classifiers.distances.discriminant import CanonicalDiscriminant
from tactile_graph_classifiers.distances.identity import Identity
from tactile_graph_classifiers.measuring.measurements import Measurements


class DiscriminantOfPresses:
    """Return which known object the last few readings are of, or that they are of none.

    As `discriminant`, but by all presses of one object so far: each further one tells more, of
    strangers above all.

    Parameters
    ----------
    database : Path or mapping, optional
        The object database, or an export of one; the sample of the thesis' objects if not given.
        It is read once, when the pipeline is loaded.
    features : list of str, optional
        Which features to compare; all that were learned if not given.
    reject : bool
        Whether readings too far from the object they most likely are of are unknown.
    confidence : float
        Share of known objects' readings to be accepted: the less, the more strangers are found.
    presses : int
        How many readings are named together, or as many as there are.
    start_anew_s : float, optional
        Forget the readings before a gap longer than this, or where the clock goes back: another
        object may lie there.

    Raises
    ------
    DataError
        If no object has two readings.
    """

    def __init__(
        self,
        *,
        database: Path | dict[str, Any] | None = None,
        features: Annotated[list[str], MinLen(1)] | None = None,
        reject: bool = True,
        confidence: Annotated[float, Gt(0), Lt(1)] = CONFIDENCE,
        presses: Annotated[int, Ge(1)] = 5,
        start_anew_s: Annotated[float, Gt(0)] | None = None,
    ) -> None:
        self._discriminant = CanonicalDiscriminant(
            database=database, features=features, reject=reject, confidence=confidence
        )
        self.takes, self.takes_by = self._discriminant.takes, self._discriminant.takes_by
        self.takes_hint = self._discriminant.takes_hint
        self._presses = presses
        self._kept: list[Measurements] = []
        self._start_anew_s = start_anew_s

    def __call__(self, features: Measurements, *, gap_s: TimeGap = None) -> Identity:
        """Return the likeliest object, the runner-up and their margin.

        Raises
        ------
        DataError
            If a feature was not measured or is not finite, or the reading is in another unit.
        """
        longest_s = self._start_anew_s
        if gap_s is not None and longest_s is not None and not 0.0 <= gap_s <= longest_s:
            self._kept = []
        last = [*self._kept, features][-self._presses :]
        found = self._discriminant.together(last)
        self._kept = last
        return found
