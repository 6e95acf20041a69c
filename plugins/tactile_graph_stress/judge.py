"""``Judge``: runs a step on a case and says what it came to."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Mask, Points
from tactile_graph_stress import measure
from tactile_graph_stress.affine import Affine, restored_values
from tactile_graph_stress.answer import answer_of, half_extent, largest, off_by
from tactile_graph_stress.case import Case, Given
from tactile_graph_stress.finite import numbers
from tactile_graph_stress.references.known import HULLS, reference_of
from tactile_graph_stress.references.network import conductances
from tactile_graph_stress.similarity import Similarity
from tactile_graph_stress.subject import OWN_FRAME
from tactile_graph_stress.trial import Came, Trial
from tactile_graph_stress.verdict import Outcome, Verdict

Values = NDArray[np.float64]

PROBE = 1e-6
"""Size of the changes, in extents, by which a step without a reference is asked how it moves."""
PROBES = 6
ROUNDING = 1e-9
"""By so much of its largest number an answer may move where nothing but memory's layout differs."""


class Judge:
    """Says of one step what its cases come to.

    Parameters
    ----------
    trial : Trial
    rng : numpy.random.Generator
        Of the small changes that probe the conditioning.
    """

    def __init__(self, trial: Trial, rng: np.random.Generator) -> None:
        self.trial = trial
        self._rng = rng
        self._reference = reference_of(trial.subject.name)
        self._bases: dict[bytes, tuple[Any, float]] = {}
        self._run_twice: set[str] = set()

    def of(self, case: Case) -> Verdict:
        """Return the verdict on a case."""
        came = self.trial.run(case.given, case.settings)
        if came.broke:
            return Verdict(Outcome.BROKEN, note=came.broke)
        if self._ends_otherwise(case, came):
            told = "gives another answer the second time; what is kept, or random?"
            return Verdict(Outcome.BROKEN, note=told)
        if came.gave_up:
            return Verdict(Outcome.GAVE_UP, note=came.gave_up)
        if case.must_refuse:
            return Verdict(Outcome.BROKEN, note="an answer from what is not finite")
        return self._measured(case, came.value)

    def _ends_otherwise(self, case: Case, came: Came) -> bool:
        """Return whether a step that does not draw ends otherwise when it is run again.

        Asked of one case of each group, and of no step in a process apart: it starts anew anyway.
        """
        if self.trial.subject.signature.rng or self.trial.is_apart or case.group in self._run_twice:
            return False
        self._run_twice.add(case.group)
        again = self.trial.anew(case.given, case.settings)
        ends = [(bool(c.gave_up), bool(c.broke)) for c in (came, again)]
        return ends[0] != ends[1] or not _alike(came.value, again.value)

    def _measured(self, case: Case, value: Any) -> Verdict:
        if "siemens" in case.facts:
            right = conductances(case.facts["circuit"], _array(case.given), case.facts["siemens"])
            if right is not None:
                return measure.of_conductances(value.values, right)
        if isinstance(case.given, Points):
            found = self._of_points(case.given, value)
            if found is not None:
                return found
        if case.base is not None and case.law is not None:
            return self.by_law(case, value)
        if "restored" in case.facts and not self.trial.subject.signature.rng:
            got = restored_values(value)
            if got is not None:
                return measure.of_values(got, case.facts["restored"], _array(case.given), 1.0)
        return Verdict(Outcome.FINITE)

    def _of_points(self, given: Points, value: Any) -> Verdict | None:
        xy = np.asarray(given.xy_cm, dtype=np.float64)
        if self.trial.subject.name in HULLS:
            return measure.of_hull(value, xy)
        if self._reference is None:
            return None
        right = self._reference(xy, value)
        return None if right is None else measure.against_reference(value, xy, right)

    def by_law(self, case: Case, value: Any) -> Verdict:
        """Return the verdict on an answer beside that to the case's base."""
        assert case.base is not None
        plain, condition = self._plain(case.base, case.law)
        if plain is None:
            return Verdict(Outcome.FINITE, note="the plain case gave up")
        if isinstance(case.law, Affine):
            got, want = restored_values(value), restored_values(plain)
            if got is None or want is None:
                return Verdict(Outcome.FINITE)
            return measure.of_values(got, case.law.of(want), _array(case.given), condition)
        assert isinstance(case.law, Similarity)
        subject = self.trial.subject
        if subject.signature.rng or (case.law.turn_rad and subject.name in OWN_FRAME):
            return Verdict(Outcome.FINITE)  # what is drawn follows no law of the input
        here, there = _places(case.given), _places(case.base)
        reach = largest(here), largest(there), half_extent(here)
        return measure.against_law(value, plain, case.law, reach, condition)

    def _plain(self, base: Given, law: Similarity | Affine | None) -> tuple[Any, float]:
        """Return the answer to a plain case and how much it moves with its input; kept."""
        key = _array(base).tobytes()
        if key not in self._bases:
            came = self.trial.run(base)
            if came.value is None:
                self._bases[key] = None, 1.0
            else:
                self._bases[key] = came.value, self._condition(base, came.value)
        return self._bases[key]

    def _condition(self, base: Given, value: Any) -> float:
        """Return the largest change of the answer for small changes of the input, each by 1."""
        if isinstance(base, Mask):
            return 1.0
        plain = _array(base)
        extent = half_extent(plain) if isinstance(base, Points) else float(np.ptp(plain))
        most = 0.0
        for _ in range(PROBES):
            change = PROBE * extent * self._rng.choice((-1.0, 1.0), size=plain.shape)
            moved = plain + change
            given = Points(moved) if isinstance(base, Points) else base.with_values(moved)
            came = self.trial.run(given)
            if came.value is not None:
                most = max(most, _moved(came.value, value, extent) / (PROBE * extent))
        return most


def _moved(value: Any, plain: Any, extent: float) -> float:
    restored, before = restored_values(value), restored_values(plain)
    if restored is not None and before is not None:
        return float(np.abs(restored - before).max())
    off = off_by(answer_of(value), answer_of(plain), extent)
    return 0.0 if off is None else off.most_cm


def _array(given: Given) -> Values:
    return np.asarray(given.xy_cm if isinstance(given, Points) else given.values, dtype=np.float64)


def _places(given: Given) -> Values:
    """Return points, or the corners of a grid, shape (N, 2)."""
    if isinstance(given, Points):
        return _array(given)
    left, right, bottom, top = given.extent_cm
    return np.array([(left, top), (right, bottom)])


def _alike(one: Any, other: Any) -> bool:
    """Return whether two answers have the same numbers and masks, but for rounding."""
    if isinstance(one, (int, str)):
        return bool(one == other)
    mine, theirs = ([np.ravel(v) for _, v in numbers(x, "")] for x in (one, other))
    if [v.size for v in mine] != [v.size for v in theirs]:
        return False
    if not mine:
        return True
    a, b = np.concatenate(mine), np.concatenate(theirs)
    return np.allclose(a, b, rtol=ROUNDING, atol=ROUNDING * float(np.abs(a).max(initial=0.0)))
