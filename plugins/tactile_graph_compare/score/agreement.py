"""Hold one variant's answers against another's, frame by frame, whatever is true."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from tactile_graph.inspect import NO_VALUE, with_value
from tactile_graph_compare.records.scores import Agreement
from tactile_graph_compare.score.answers import Answers, Outcomes
from tactile_graph_compare.score.pairing import paired
from tactile_graph_compare.score.quantities import distance_cm, errors_against
from tactile_graph_compare.score.scoring import GATE_CM
from tactile_graph_compare.score.statistics import frozen

OF_FRAMES = ("count", "identity")


class Found(NamedTuple):
    """What a variant answered in a frame.

    Parameters
    ----------
    things : tuple of object
        Whatever it found that has a place.
    many : bool
        Whether it looks for several.
    n_counted : int or None
    name : str
        Empty for a stranger, and without an answer.
    """

    things: tuple[Any, ...] = ()
    many: bool = False
    n_counted: int | None = None
    name: str = ""


def found_in(answers: Answers, outcomes: Outcomes) -> Found:
    """Return what a variant answered in a frame."""
    things: tuple[Any, ...] = ()
    many = False
    if answers.places:
        place, value = answers.placed(outcomes)
        many = place.many
        if value.__class__ not in NO_VALUE:
            found = (place.thing(item) for item in with_value(place.items(value)))
            # A place that is not finite is no answer.
            things = tuple(t for t in found if math.isfinite(t.x_cm) and math.isfinite(t.y_cm))
    name = answers.named(outcomes) if answers.identities else ""
    return Found(things, many, answers.counted(outcomes), name)


@dataclass
class Differences:
    """How far two variants lie apart in one quantity so far, and who had no answer."""

    positions: list[int] = field(default_factory=list)
    values: list[float] = field(default_factory=list)
    offsets: list[tuple[float, float]] = field(default_factory=list)
    n_only_variant: int = 0
    n_only_reference: int = 0
    n_neither: int = 0

    def add(self, position: int, value: float) -> None:
        """Enter one."""
        self.positions.append(position)
        self.values.append(value)

    def join(self, later: Differences, start: int) -> None:
        """Enter those of later frames, whose positions are counted from ``start``."""
        self.positions += [start + p for p in later.positions]
        self.values += later.values
        self.offsets += later.offsets
        self.n_only_variant += later.n_only_variant
        self.n_only_reference += later.n_only_reference
        self.n_neither += later.n_neither


class Agreeing:
    """Collects how far one variant lies from another.

    Parameters
    ----------
    variant, reference : str
        Labels.
    units : mapping of str to str
        The quantities that both can answer, in the order of tables, with their units.
    gate_cm : float
        Where either looks for several things: farther apart is no pair.

    Attributes
    ----------
    differences : dict of str to Differences
        By quantity.
    """

    def __init__(
        self, variant: str, reference: str, units: Mapping[str, str], gate_cm: float = GATE_CM
    ) -> None:
        self.variant = variant
        self.reference = reference
        self.gate_cm = gate_cm
        self.units = units
        self.differences = {q: Differences() for q in units}

    def add(self, position: int, one: Found, other: Found) -> dict[str, float]:
        """Enter a frame; return the largest absolute difference of each quantity in it."""
        before = {q: len(d.values) for q, d in self.differences.items()}
        if "centre" in self.differences:
            self._things(position, one, other)
        if "count" in self.differences:
            off = None
            if one.n_counted is not None and other.n_counted is not None:
                off = float(one.n_counted - other.n_counted)
            self._whole(
                "count", position, off, one.n_counted is not None, other.n_counted is not None
            )
        if "identity" in self.differences:
            off = float(one.name != other.name) if one.name and other.name else None
            self._whole("identity", position, off, bool(one.name), bool(other.name))
        new = {q: d.values[before[q] :] for q, d in self.differences.items()}
        return {q: max(map(abs, values)) for q, values in new.items() if values}

    def _things(self, position: int, one: Found, other: Found) -> None:
        centres = self.differences["centre"]
        pairs = self._pairs(one, other)
        for i, j in pairs:
            mine, theirs = one.things[i], other.things[j]
            for quantity, off in errors_against(mine, theirs).items():
                if quantity in self.differences and math.isfinite(off):
                    self.differences[quantity].add(position, off)
            centres.offsets.append((mine.x_cm - theirs.x_cm, mine.y_cm - theirs.y_cm))
        centres.n_only_variant += len(one.things) - len(pairs)
        centres.n_only_reference += len(other.things) - len(pairs)
        centres.n_neither += not one.things and not other.things

    def _pairs(self, one: Found, other: Found) -> list[tuple[int, int]]:
        if not (one.many or other.many):
            return [(0, 0)] if one.things and other.things else []
        off = np.array([[distance_cm(a, b) for b in other.things] for a in one.things])
        return paired(off.reshape(len(one.things), len(other.things)), self.gate_cm)

    def _whole(
        self, quantity: str, position: int, off: float | None, mine: bool, theirs: bool
    ) -> None:
        """Enter a difference of a whole frame, or who of the two has no answer."""
        of = self.differences[quantity]
        if off is not None:
            of.add(position, off)
        of.n_only_variant += mine and not theirs
        of.n_only_reference += theirs and not mine
        of.n_neither += not mine and not theirs

    def agreements(self) -> list[Agreement]:
        """Return what was collected, a record a quantity that either ever answered."""
        found = []
        for quantity, of in self.differences.items():
            if of.values or of.n_only_variant or of.n_only_reference:
                found.append(self._agreement(quantity, of))
        return found

    def _agreement(self, quantity: str, of: Differences) -> Agreement:
        values = np.asarray(of.values, dtype=np.float64)
        off, some = np.abs(values), values.size > 0
        bias = float(values.mean()) if some else None
        if some and quantity == "centre":
            bias = float(np.hypot(*np.mean(of.offsets, axis=0)))
        told = quantity == "centre" or quantity in OF_FRAMES
        return Agreement(
            self.variant,
            self.reference,
            quantity,
            self.units[quantity],
            frozen(of.positions, np.int64),
            frozen(values),
            float(off.mean()) if some else None,
            float(np.median(off)) if some else None,
            float(np.percentile(off, 95)) if some else None,
            float(off.max()) if some else None,
            bias,
            of.n_only_variant if told else None,
            of.n_only_reference if told else None,
            of.n_neither if told else None,
        )
