"""Hold one variant's answers against the truth, frame by frame."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tactile_graph.inspect import NO_VALUE, shape_kind, with_value
from tactile_graph.wires.frame import Frame, TrueObject
from tactile_graph_compare.score.answers import Answers, Outcomes
from tactile_graph_compare.score.pairing import paired
from tactile_graph_compare.score.quantities import distance_cm, errors_against, quantities_of

GATE_CM = 2.0
"""What lies farther from any true object is no answer for one, where several are looked for."""
NOBODY = -1
"""The object of a target that is the whole frame, or of which nobody can say which was meant."""


@dataclass
class QuantityErrors:
    """The targets of one quantity so far: what there was to answer, and how far the answer is off.

    ``offsets`` are (x, y) of centres, in cm.
    """

    positions: list[int] = field(default_factory=list)
    objects: list[int] = field(default_factory=list)
    errors: list[float] = field(default_factory=list)
    offsets: list[tuple[float, float]] = field(default_factory=list)
    n_extra: int = 0

    def add(self, position: int, number: int, error: float = math.nan) -> None:
        """Enter a target; without an error it has no answer."""
        self.positions.append(position)
        self.objects.append(number)
        self.errors.append(error)

    def join(self, later: QuantityErrors, start: int) -> None:
        """Enter the targets of later frames, whose positions are counted from ``start``."""
        self.positions += [start + p for p in later.positions]
        self.objects += later.objects
        self.errors += later.errors
        self.offsets += later.offsets
        self.n_extra += later.n_extra


class Scorer:
    """Scores one variant.

    Parameters
    ----------
    answers : Answers
    gate_cm : float
        For outputs that are lists.
    """

    def __init__(self, answers: Answers, gate_cm: float = GATE_CM) -> None:
        self.answers = answers
        self.gate_cm = gate_cm
        self.errors: dict[str, QuantityErrors] = defaultdict(QuantityErrors)

    def add(self, position: int, frame: Frame, outcomes: Outcomes) -> dict[str, float]:
        """Enter a frame; return its worst error of each quantity, NaN where something is missing.

        Parameters
        ----------
        position : int
            Row of the frame.
        frame : Frame
        outcomes : callable
            Gives the outcome at a reference of the variant.
        """
        if frame.truth is None:
            return {}
        before = {name: len(t.errors) for name, t in self.errors.items()}
        self._places(position, frame.truth, outcomes)
        self._count(position, frame.truth, outcomes)
        self._identity(position, frame.truth, outcomes)
        return {
            name: _worst(new)
            for name, t in self.errors.items()
            if (new := t.errors[before.get(name, 0) :])
        }

    def join(self, later: Mapping[str, QuantityErrors], start: int) -> None:
        """Enter what came of later frames, whose positions are counted from ``start``."""
        for name, targets in later.items():
            self.errors[name].join(targets, start)

    # -- where things are ----------------------------------------------------------------------

    def _places(self, position: int, truth: tuple[TrueObject, ...], outcomes: Outcomes) -> None:
        if not self.answers.places:
            return
        place, value = self.answers.placed(outcomes)
        if value.__class__ in NO_VALUE:
            meant = range(len(truth)) if place.many or len(truth) == 1 else [NOBODY] * bool(truth)
            for number in meant:
                kinds = truth if number == NOBODY else truth[number : number + 1]
                self._missing(position, number, {q for t in kinds for q in self._of(t)})
            return
        things = [place.thing(item) for item in with_value(place.items(value))]
        pairs = self._many(truth, things) if place.many else self._single(truth, things)
        for number, thing in pairs:
            self._compare(position, number, truth[number], thing)
        if place.many:
            for number in sorted(set(range(len(truth))) - {n for n, _ in pairs}):
                self._missing(position, number, set(self._of(truth[number])))
        self.errors["centre"].n_extra += len(things) - len(pairs)

    def _single(self, truth: tuple[TrueObject, ...], things: list[Any]) -> list[tuple[int, Any]]:
        """Return the true object an only answer is nearest to, one of its kind before others."""
        if not truth:
            return []
        (thing,) = things
        kind = shape_kind(type(thing))
        alike = [i for i, t in enumerate(truth) if kind and isinstance(t.shape, kind)]
        near = min(alike or range(len(truth)), key=lambda i: distance_cm(thing, truth[i].shape))
        return [(near, thing)]

    def _many(self, truth: tuple[TrueObject, ...], things: list[Any]) -> list[tuple[int, Any]]:
        off = np.array([[distance_cm(g, t.shape) for g in things] for t in truth])
        pairs = paired(off.reshape(len(truth), len(things)), self.gate_cm)
        return [(i, things[j]) for i, j in pairs]

    def _of(self, true: TrueObject) -> list[str]:
        """Return the quantities of a true object that the variant can answer."""
        kind = shape_kind(type(true.shape))
        mine = {q for p in self.answers.places for q in p.quantities}
        kinds = {k for p in self.answers.places for k in p.kinds}
        of_kind = quantities_of(kind) if kind else ("centre",)
        return [q for q in of_kind if q in mine and (q in ("centre", "angle") or kind in kinds)]

    def _missing(self, position: int, number: int, quantities: set[str]) -> None:
        for name in sorted(quantities):
            self.errors[name].add(position, number)

    def _compare(self, position: int, number: int, true: TrueObject, thing: Any) -> None:
        errors = errors_against(thing, true.shape)
        for name in self._of(true):
            error = errors.get(name, math.nan)
            # What is not finite is no answer.
            self.errors[name].add(position, number, error if math.isfinite(error) else math.nan)
        offset = (thing.x_cm - true.shape.x_cm, thing.y_cm - true.shape.y_cm)
        if math.isfinite(errors["centre"]):
            self.errors["centre"].offsets.append(offset)

    # -- how many, and which --------------------------------------------------------------------

    def _count(self, position: int, truth: tuple[TrueObject, ...], outcomes: Outcomes) -> None:
        if not self.answers.counts:
            return
        count = self.answers.counted(outcomes)
        if count is not None:
            self.errors["count"].add(position, NOBODY, float(count - len(truth)))
        elif truth:
            self.errors["count"].add(position, NOBODY)

    def _identity(self, position: int, truth: tuple[TrueObject, ...], outcomes: Outcomes) -> None:
        names = {t.name for t in truth} - {""}
        if not self.answers.identities:
            return
        said = self.answers.named(outcomes)
        if names:
            error = float(said not in names) if said else math.nan
            self.errors["identity"].add(position, NOBODY, error)
        elif said and not truth:
            self.errors["identity"].n_extra += 1


def _worst(errors: list[float]) -> float:
    return max(errors, key=lambda e: math.inf if math.isnan(e) else abs(e))
