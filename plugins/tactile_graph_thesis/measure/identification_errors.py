"""Identification on the simulated pad (thesis section 4.4): table 4.9, figures 4.38 to 4.43."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.distances.identity import Identity
from tactile_graph_thesis.measure.simulated_readings import (
    N_READINGS,
    Readings,
    as_database,
    known_from,
    simulated,
)
from tactile_graph_thesis.measure.weighing import Kind, weighing

Array = NDArray[np.float64]
STACK_OFFSET_CM = 1.0
LARGEST_STACKED_G = 500.0
THESIS_CLASSIFIER = "minimum_distance_normalised"


# -- table 4.9 -------------------------------------------------------------------------------


class Confusion(NamedTuple):
    """How often readings of one object were taken for which.

    Parameters
    ----------
    names : tuple of str
    nearest : mapping
        (true name, nearest name) -> number of readings.
    rejected : mapping
        True name -> readings called unknown.
    n : int
        Readings tested.
    """

    names: tuple[str, ...]
    nearest: Mapping[tuple[str, str], int]
    rejected: Mapping[str, int]
    n: int

    @property
    def share_right(self) -> float:
        """Share of the readings whose nearest object is the true one."""
        return sum(c for (true, got), c in self.nearest.items() if true == got) / self.n

    @property
    def share_rejected(self) -> float:
        """Share of the readings called unknown."""
        return sum(self.rejected.values()) / self.n


def confusion(classifier: Any, readings: Mapping[str, Readings], skip: int) -> Confusion:
    """Return how a classifier does on the readings after the first ``skip`` of each object.

    Parameters
    ----------
    classifier : callable
        From `Measurements` to `Identity`.
    readings : mapping
    skip : int
    """
    nearest: Counter[tuple[str, str]] = Counter()
    rejected: Counter[str] = Counter()
    for name, of_object in readings.items():
        for row in of_object.rows[skip:]:
            identity: Identity = classifier(row)
            nearest[name, identity.nearest] += 1
            rejected[name] += not identity.known
    return Confusion(tuple(readings), nearest, rejected, nearest.total())


def classifiers(known: Known) -> dict[str, Any]:
    """Return each kind of classifier of weight and area, by the step's name.

    Parameters
    ----------
    known : Known
    """
    from tactile_graph_classifiers.distances.mahalanobis import Mahalanobis
    from tactile_graph_classifiers.distances.minimum_distance import MinimumDistance
    from tactile_graph_classifiers.distances.minimum_distance_normalised import (
        MinimumDistanceNormalised,
    )

    data = as_database(known)
    return {
        "minimum_distance": MinimumDistance(database=data),
        "minimum_distance_normalised": MinimumDistanceNormalised(database=data),
        "mahalanobis": Mahalanobis(database=data),
    }


def table_4_9(
    n: int = N_READINGS, seed: int = 0, pad: str = "thesis", kind: Kind = "curve"
) -> dict[str, Confusion]:
    """Return how each classifier tells the five objects of table 4.9 apart.

    Parameters
    ----------
    n : int
        Readings of each object to learn it, and as many others to test it.
    seed : int
    pad : str
    kind : "curve", "decoupled" or "footprint"
        How they are measured, see `weighing`.

    Notes
    -----
    Thesis section 4.4.2: all 25 readings of each object were identified.
    """
    readings = simulated(weighing(kind, seed, pad), "identify", 2 * n, 5, seed, pad)
    known = known_from(readings, n)
    return {name: confusion(one, readings, n) for name, one in classifiers(known).items()}


def added(found: Sequence[Confusion]) -> Confusion:
    """Return several confusions of the same objects as one.

    Parameters
    ----------
    found : sequence of Confusion
    """
    nearest: Counter[tuple[str, str]] = Counter()
    rejected: Counter[str] = Counter()
    for one in found:
        nearest.update(one.nearest)
        rejected.update(one.rejected)
    return Confusion(found[0].names, nearest, rejected, sum(one.n for one in found))


def strangers_rejected(n: int = N_READINGS, seed: int = 0) -> dict[str, float]:
    """Return the share of an object's readings called unknown where it was not learned.

    Parameters
    ----------
    n : int
        Readings to learn each of the other objects of table 4.9, and as many to test this one.
    seed : int

    Notes
    -----
    Each of the five is the stranger once; the thesis has no such test.
    """
    from tactile_graph import load

    readings = simulated(load("features"), "identify", n, 5, seed)
    shares: dict[str, list[float]] = {}
    for stranger in readings:
        others = {name: r for name, r in readings.items() if name != stranger}
        for step, one in classifiers(known_from(others)).items():
            found = confusion(one, {stranger: readings[stranger]}, 0)
            shares.setdefault(step, []).append(found.share_rejected)
    return {step: float(np.mean(values)) for step, values in shares.items()}


# -- figures 4.38 to 4.43 --------------------------------------------------------------------


class Pair(NamedTuple):
    """Two discs to be told apart: one as it is, the other heavier by the difference.

    Parameters
    ----------
    figure : str
    base_g : float
        Weight of the first disc.
    radius_cm, other_radius_cm : float
    """

    figure: str
    base_g: float
    radius_cm: float
    other_radius_cm: float


PAIRS = (
    Pair("4.38", 1860, 6.9, 6.9),
    Pair("4.39", 1090, 6.1, 6.1),
    Pair("4.40", 475, 4.3, 4.3),
    Pair("4.41", 1860, 6.9, 6.1),
    Pair("4.42", 1860, 6.9, 4.3),
    Pair("4.43", 1090, 6.1, 4.3),
)


class Curve(NamedTuple):
    """Identification error of a pair against its weight difference.

    Parameters
    ----------
    pair : Pair
    differences_g : ndarray, shape (n,)
    error : mapping
        Classifier -> share of readings taken for the wrong one of the two, shape (n,).
    """

    pair: Pair
    differences_g: Array
    error: Mapping[str, Array]


class Trials(NamedTuple):
    """What the curves are measured with.

    Parameters
    ----------
    kind : "curve", "decoupled" or "footprint"
        How discs are measured, see `weighing`.
    differences_g : tuple of float
    n_learn, n_test : int
        Readings of each disc and weight to learn it, and to test it.
    pad : str
    """

    kind: Kind = "curve"
    differences_g: tuple[float, ...] = (
        0, 50, 100, 200, 300, 400, 600, 800, 1000, 1250, 1500, 2000,
    )  # fmt: skip
    n_learn: int = N_READINGS
    n_test: int = 50
    pad: str = "thesis"


AS_IN_THE_THESIS = Trials()


def mean_curves(seeds: range, trials: Trials = AS_IN_THE_THESIS) -> list[Curve]:
    """Return the identification errors of figures 4.38 to 4.43, averaged over pads.

    Parameters
    ----------
    seeds : range
        One simulated pad each.
    trials : Trials
    """
    runs = [error_curves(PAIRS, trials, seed) for seed in seeds]
    return [
        same[0]._replace(
            error={step: np.mean([c.error[step] for c in same], axis=0) for step in same[0].error}
        )
        for same in zip(*runs, strict=True)
    ]


def error_curves(
    pairs: Sequence[Pair], trials: Trials = AS_IN_THE_THESIS, seed: int = 0
) -> list[Curve]:
    """Return identification error against weight difference, for each pair of discs.

    Parameters
    ----------
    pairs : sequence of Pair
    trials : Trials
    seed : int

    Notes
    -----
    Thesis section 4.4.3: heavier discs are made by piling weights on, a little off centre. Only
    the two of a pair are known at a time, and the nearest counts, however far.
    """
    discs = _discs(pairs, trials.differences_g)
    scene = {"in_turn": [[_disc(*disc)] for disc in discs]}
    n, pipeline = trials.n_learn + trials.n_test, weighing(trials.kind, seed, trials.pad)
    readings = simulated(pipeline, scene, n, len(discs), seed, trials.pad)
    return [_curve(pair, readings, trials) for pair in pairs]


def _curve(pair: Pair, readings: Mapping[str, Readings], trials: Trials) -> Curve:
    errors: dict[str, list[float]] = {}
    for difference in trials.differences_g:
        two = {name: readings[name] for name in _names(pair, difference)}
        for step, one in classifiers(known_from(two, trials.n_learn)).items():
            right = confusion(one, two, trials.n_learn).share_right
            errors.setdefault(step, []).append(1.0 - right)
    found = {step: np.array(values) for step, values in errors.items()}
    return Curve(pair, np.array(trials.differences_g, dtype=np.float64), found)


def _discs(
    pairs: Sequence[Pair], differences_g: Sequence[float]
) -> list[tuple[str, float, float, float]]:
    """Return (name, radius, own weight, stacked weight) of every disc that is needed, once."""
    discs: dict[str, tuple[str, float, float, float]] = {}
    for pair in pairs:
        for difference in differences_g:
            first, second = _names(pair, difference)
            discs[first] = (first, pair.radius_cm, pair.base_g, 0.0)
            discs[second] = (second, pair.other_radius_cm, pair.base_g, float(difference))
    return list(discs.values())


def _names(pair: Pair, difference_g: float) -> tuple[str, str]:
    first = f"{pair.radius_cm:g} cm, {pair.base_g:g} g"
    return first, f"{pair.other_radius_cm:g} cm, {pair.base_g:g} + {difference_g:g} g"


def _disc(name: str, radius_cm: float, weight_g: float, stacked_g: float) -> dict[str, Any]:
    n = int(np.ceil(stacked_g / LARGEST_STACKED_G))
    return {
        "shape": "disc",
        "name": name,
        "radius_cm": radius_cm,
        "weight_g": weight_g,
        "stacked_g": [stacked_g / n] * n if n else [],
        "stack_offset_cm": STACK_OFFSET_CM,
    }
