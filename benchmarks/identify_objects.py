"""Identification on instruments and of objects nobody described: 22 objects, 25 presses to learn.

    python benchmarks/identify_objects.py                     # three pads, three catalogues each
    python benchmarks/identify_objects.py --pads resistive --seeds 1 2 3 --curve

Objects and pads are those of `pressed_objects`, which shares no code with the project's own. In
five sessions each of 22 objects is pressed five times and learned; in five later sessions, zeros
and gains having drifted, as often and named. Every way learns from the same frames:

- weight and area, Mahalanobis: `identify`, the thesis' two features
- 18 features, Mahalanobis: all that `features` measures
- all, discriminant: `identify-any`

"Right" is the share of readings that are given their own name, "lost" that of known objects called
unknown. A stranger is each object in turn, its test readings shown to what learned the 21 others
(four of which are the like of another: found as strangers only as far as the two can be told
apart); "foreign" are 22 objects of another catalogue on the same pad. With --curve strangers
found and knowns lost at other confidences. Settings were chosen on the pads capacitive and strip
with seeds 1 to 3; reported are others.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pressed_objects import INSTRUMENTS, Pad, Thing, catalogue

from tactile_graph import Frame, load
from tactile_graph_classifiers.database.text import FORMAT, VERSION
from tactile_graph_classifiers.distances.discriminant import CanonicalDiscriminant
from tactile_graph_classifiers.distances.mahalanobis import Mahalanobis
from tactile_graph_classifiers.measuring.describe import NAMES
from tactile_graph_classifiers.measuring.features import NAMES as FEATURES
from tactile_graph_classifiers.measuring.measurements import Measurements

Rows = list[Measurements]
SESSIONS, PRESSES = 5, 5
CONFIDENCES = (0.99, 0.975, 0.95, 0.925, 0.9, 0.85, 0.8)
WAYS: dict[str, tuple[Any, dict[str, Any]]] = {
    "weight and area, Mahalanobis": (Mahalanobis, {"features": ["weight", "area_cm2"]}),
    "18 features, Mahalanobis": (Mahalanobis, {"features": list(FEATURES)}),
    "all, discriminant": (CanonicalDiscriminant, {}),
}


class Readings(NamedTuple):
    """Readings by object: to learn, to test, and of objects of another catalogue."""

    learned: dict[str, Rows]
    tested: dict[str, Rows]
    foreign: dict[str, Rows]


def presses(pad: Pad, things: Sequence[Thing]) -> Iterator[Frame]:
    """Yield the presses of all sessions."""
    for _ in range(SESSIONS):
        pad.begin_session()
        for thing in things:
            for _ in range(PRESSES):
                yield pad.press(thing)


def measured(frames: Iterator[Frame]) -> dict[str, Rows]:
    """Return readings by the object pressed."""
    found: dict[str, Rows] = {}
    for result in load("describe").stream(frames):
        found.setdefault(result.frame.label, []).append(result["features"].measurements)
    return found


def readings_of(pad: str, seed: int) -> Readings:
    """Return all readings of a pad and catalogue."""
    rng = np.random.default_rng([seed])
    one = Pad(INSTRUMENTS[pad], rng)
    things = catalogue(INSTRUMENTS[pad], rng)
    learned, tested = measured(presses(one, things)), measured(presses(one, things))
    others = catalogue(INSTRUMENTS[pad], np.random.default_rng([seed, 1]), "foreign ")
    return Readings(learned, tested, measured(presses(one, others)))


def database(learned: dict[str, Rows], without: str = "") -> dict[str, Any]:
    """Return objects as the steps take them."""
    objects = [
        {"name": name, "readings": [m.values.tolist() for m in rows]}
        for name, rows in learned.items()
        if name != without
    ]
    return {"format": FORMAT, "version": VERSION, "quantity": "raw", "features": list(NAMES),
            "objects": objects}  # fmt: skip


class Distances(NamedTuple):
    """How far the known readings, those of left out objects and foreign ones are, over the limit.

    Parameters
    ----------
    known, right : ndarray, shape (n,)
        And whether the nearest is the true one.
    strangers, foreign : ndarray
    """

    known: NDArray[np.float64]
    right: NDArray[np.bool_]
    strangers: NDArray[np.float64]
    foreign: NDArray[np.float64]

    def line(self) -> str:
        """Return shares of right, nearest, lost, strangers found and foreign found."""
        accepted = self.known <= 1.0
        shares = ((accepted & self.right).mean(), self.right.mean(), 1.0 - accepted.mean(),
                  (self.strangers > 1.0).mean(), (self.foreign > 1.0).mean())  # fmt: skip
        return " ".join(f"{100 * share:9.1f}" for share in shares)


def tried(way: str, all_of: Readings, confidence: float | None = None) -> Distances:
    """Return what one way makes of the readings."""
    kind, settings = WAYS[way]
    settings = settings if confidence is None else {**settings, "confidence": confidence}
    ratios = lambda step, rows: [(i.distance / i.limit, i.nearest)  # noqa: E731
                                 for i in map(step, rows)]  # fmt: skip
    step = kind(database=database(all_of.learned), **settings)
    known = [(r, n == name) for name, rows in all_of.tested.items() for r, n in ratios(step, rows)]
    foreign = [r for rows in all_of.foreign.values() for r, _ in ratios(step, rows)]
    strangers: list[float] = []
    for name, rows in all_of.tested.items():
        others = kind(database=database(all_of.learned, name), **settings)
        strangers += [r for r, _ in ratios(others, rows)]
    far, right = zip(*known, strict=True)
    return Distances(np.array(far), np.array(right), np.array(strangers), np.array(foreign))


def joined(parts: Sequence[Distances]) -> Distances:
    """Return several catalogues' readings together."""
    return Distances(*(np.concatenate(some) for some in zip(*parts, strict=True)))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--pads", nargs="*", choices=INSTRUMENTS, default=[*INSTRUMENTS])
    parser.add_argument("--seeds", nargs="*", type=int, default=[11, 12, 13])
    parser.add_argument("--curve", action="store_true")
    args = parser.parse_args()
    head = f"{'%':<31}" + "".join(f"{t:>10}" for t in ("right", "nearest", "lost", "strangers",
                                                        "foreign"))  # fmt: skip
    every: dict[str, list[Distances]] = {}
    for pad in args.pads:
        sets = [readings_of(pad, seed) for seed in args.seeds]
        print(f"\n{pad}, catalogues {args.seeds}\n{head}")
        for way in WAYS:
            found = [tried(way, one) for one in sets]
            print(f"{way:<31} {joined(found).line()}", flush=True)
            every.setdefault(way, []).extend(found)
    print(f"\nall of them\n{head}")
    for way, found in every.items():
        print(f"{way:<31} {joined(found).line()}")
    if args.curve:
        curve(joined(every["all, discriminant"]))


def curve(found: Distances) -> None:
    """Print what more strangers found cost in known objects lost."""
    print("\nthe discriminant's trade-off, %\n     lost strangers   foreign")
    for confidence in CONFIDENCES:
        limit = np.quantile(found.known, confidence)
        shares = (1.0 - confidence, (found.strangers > limit).mean(),
                  (found.foreign > limit).mean())  # fmt: skip
        print(" ".join(f"{100 * share:9.1f}" for share in shares))


if __name__ == "__main__":
    main()
