"""The weights by which ``split_contacts`` tells two objects from one: measured, and fitted anew.

    python benchmarks/split_weights.py [--fit] [--scenes 40] [--seed 7]

Scenes with known objects are simulated on the thesis' pad. Of each the cells of every single
object are a sample of one object, and those of two objects within reach a sample of two. Every
straight cut that ``split_contacts`` would try is described by the terms of `two_or_one`; a sample
counts as two objects if its likeliest cut has log odds above 0. What is measured: how often that
is so, on scenes of other seeds than those fitted to.

``--fit`` fits the weights by logistic regression. Which cut stands for a sample depends on the
weights, so both are improved in turn: of one object its likeliest cut, which should be unlikely;
of two the likeliest of those that part the cells as they truly are.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import objects
from numpy.typing import NDArray

from tactile_graph import Frame
from tactile_graph.compiled import warm_up
from tactile_graph.errors import UsageError
from tactile_graph.steps import Report
from tactile_graph_filters.parting.hull_terms import CELLS, FLOOR, Levels, hull_terms
from tactile_graph_filters.parting.partition import Partition
from tactile_graph_filters.parting.straight_cuts import (
    COSINES,
    LEAST_CELLS,
    REACH_CELLS,
    SINES,
    STEP_CELLS,
    moved_over,
    reach,
)
from tactile_graph_filters.parting.two_or_one import NAMES, WEIGHTS, cut_terms
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.geometry import Geometry
from tactile_graph_sources.simulate import simulate

Array = NDArray[np.float64]
LEVEL_V, WEAK = 0.01, 0.5
SINGLE_WEIGHT = 2.0
"""What single objects count beside pairs: a wrong cut is worse than one that is missed."""
AGREE = 0.85
"""Share of cells a cut must part as they truly are, if none is within 0.05 of a better one."""
RIDGE, N_ROUNDS = 1e-3, 8
"""Penalty on squared weights of terms scaled to deviation 1; rounds of fit and choice of cuts."""


def thing(kind: str, scale: float, rng: np.random.Generator) -> dict[str, Any]:
    """Return an object of a kind of ``objects.py``, or a long or large rectangle, scaled."""
    ranges = {"bar": (7.0, 12.0, 2.5, 3.6, 35, 80), "slab": (8.0, 14.0, 4.5, 8.0, 25, 60)}
    if kind in ranges:
        low, high, thin, thick, light, heavy = ranges[kind]
        length, breadth = rng.uniform(low, high), rng.uniform(thin, thick)
        weight = length * breadth * rng.uniform(light, heavy)
        return {"shape": "rectangle", "length_cm": float(length), "breadth_cm": float(breadth),
                "weight_g": round(weight)}  # fmt: skip
    made = objects.thing(kind, rng)
    made |= {k: v * scale for k, v in made.items() if k.endswith("_cm")}
    return made | {"weight_g": round(made["weight_g"] * scale**2)}


def six(apart_cm: float, rng: np.random.Generator) -> Frame | None:
    scene = {"objects": [objects.thing(k, rng) for k in objects.KINDS], "apart_cm": apart_cm}
    try:
        return shipped(scene, rng)
    except UsageError:  # no place found for all
        return None


def pair(one: str, other: str, scale: float, rng: np.random.Generator) -> Frame | None:
    sizes = scale * rng.uniform(0.9, 1.1, 2)
    return objects.touching(thing(one, sizes[0], rng), thing(other, sizes[1], rng), rng)


def single(kind: str, scale: float, rng: np.random.Generator) -> Frame:
    return shipped({"objects": [thing(kind, scale, rng)]}, rng)


def shipped(scene: str | dict[str, Any], rng: np.random.Generator) -> Frame:
    return next(iter(simulate(scene=scene, frames=1, rng=rng, report=Report())))


MAKERS: dict[str, Callable[[np.random.Generator], Frame | None]] = {
    **{f"six, {gap:g} cm apart": partial(six, gap) for gap in (0.0, 0.65, 1.0, 1.3)},
    **{
        f"{one} and {other}, x {scale:g}": partial(pair, one, other, scale)
        for one, other, scale in (
            ("disc", "disc", 1.0), ("disc", "disc", 1.6), ("rectangle", "rectangle", 1.0),
            ("disc", "rectangle", 1.2), ("ellipse", "polygon", 1.2), ("bar", "disc", 1.0),
            ("bar", "bar", 1.0), ("slab", "disc", 1.0),
        )
    },
    **{
        name: partial(shipped, name)
        for name in ("disc-1", "disc-2", "disc-3", "rectangle-1", "rectangle-2")
    },
    **{
        f"{kind}, x {scale:g}": partial(single, kind, scale)
        for kind, scale in (
            ("disc", 1.0), ("rectangle", 1.0), ("ellipse", 1.0),
            ("polygon", 1.0), ("disc", 1.6), ("rectangle", 1.6), ("ellipse", 1.6),
            ("polygon", 1.8), ("bar", 1.0), ("slab", 1.0),
        )
    },
}  # fmt: skip


@dataclass(frozen=True)
class Sample:
    """Cells of one object or of two: the terms of each cut (cuts, 10), and how right it is."""

    kind: str
    two: bool
    terms: Array
    right: Array


def samples(seed: int, n: int) -> list[Sample]:
    """Return what ``n`` scenes of each kind hold."""
    found: list[Sample] = []
    for number, (kind, make) in enumerate(MAKERS.items()):
        rng = np.random.default_rng([seed, number])
        frames: list[Frame] = []
        while len(frames) < n:
            frame = make(rng)
            frames += [] if frame is None else [frame]
        found += [sample for frame in frames for sample in samples_of(kind, frame)]
    return found


def samples_of(kind: str, frame: Frame) -> Iterator[Sample]:
    assert frame.truth is not None
    cover = np.array([coverage_cm2(t.shape, Geometry()) for t in frame.truth])
    values = np.maximum(frame.image.values, 0.0)
    on = (frame.image.values >= LEVEL_V) & (cover.max(axis=0) > 0.0)
    truth = np.where(on, cover.argmax(axis=0) + 1, 0)
    numbers = [k for k in range(1, len(cover) + 1) if np.count_nonzero(truth == k) > LEAST_CELLS]
    for a in numbers:
        for b in (b for b in numbers if b >= a):
            if a == b or _apart(truth == a, truth == b) <= REACH_CELLS:
                terms, right = cuts(np.where(on, values, 0.0), on, truth, a, b)
                if len(terms):
                    yield Sample(kind, a != b, terms, right)


def _apart(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> int:
    steps = np.argwhere(one)[:, None] - np.argwhere(other)[None]
    return int(np.abs(steps).max(axis=-1).min())


def cuts(
    values: Array, on: NDArray[np.bool_], truth: NDArray[np.int64], a: int, b: int
) -> tuple[Array, Array]:
    """Return the terms of each straight cut through the cells of ``a`` and ``b``, and how right.

    How right: the share of cells that lie on the side on which most of their object lies.
    """
    mine = (truth == a) | (truth == b)
    rows, columns = (np.flatnonzero(mine.any(axis=k)) for k in (1, 0))
    box = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    group, new = 1, 3
    owner = np.where(mine, group, np.where(on, 2, 0)).astype(np.int32)[box].copy()
    cells = Partition(owner, values[box].copy(), np.ones(owner.shape, np.bool_))
    first, full = (truth == a)[box], WEAK * float(np.median(values[on]))
    levels = Levels(WEAK, full, FLOOR * full)
    both = hull_terms(cells, group, group, levels)
    terms, right = [], []
    for cosine, sine in zip(COSINES, SINES, strict=True):
        low, high = reach(owner, group, new, cosine, sine)
        before = 0
        for at in np.arange(low + 0.5 * STEP_CELLS, high, STEP_CELLS):
            moved = moved_over(owner, group, new, cosine, sine, at)
            if moved != before and LEAST_CELLS <= moved <= both[CELLS] - LEAST_CELLS:
                terms.append(cut_terms(cells, new, group, levels, both))
                same = np.mean((owner == new)[mine[box]] == first[mine[box]])
                right.append(max(same, 1.0 - same))
            before = moved
    return np.array(terms).reshape(-1, len(NAMES)), np.array(right)


def fitted(found: list[Sample]) -> Array:
    """Return the weights of the regression; every kind of scenes counts alike."""
    from scipy.optimize import minimize

    every = np.concatenate([s.terms for s in found])
    middle, spread = every.mean(axis=0), every.std(axis=0)
    middle[0], spread[0] = 0.0, 1.0
    scaled = [(s.terms - middle) / spread for s in found]
    groups = [(s.kind, s.two) for s in found]
    sizes = {group: groups.count(group) for group in set(groups)}
    share = np.array([(1.0 if g[1] else SINGLE_WEIGHT) / sizes[g] for g in groups])
    share /= share.sum()
    sign = np.array([1.0 if s.two else -1.0 for s in found])
    weights = (WEIGHTS * spread).copy()
    weights[0] = WEIGHTS @ middle + WEIGHTS[0]
    for _ in range(N_ROUNDS):
        rows = np.array([chosen(s, x, weights) for s, x in zip(found, scaled, strict=True)])

        def loss(w: Array, rows: Array = rows) -> tuple[float, Array]:
            margin = sign * (rows @ w)
            slope = -(share * sign / (1.0 + np.exp(margin))) @ rows
            held = np.where(np.arange(len(w)) > 0, w, 0.0)
            cost = share @ np.logaddexp(0.0, -margin) + RIDGE * held @ held
            return float(cost), slope + 2.0 * RIDGE * held

        weights = minimize(loss, weights, jac=True, method="L-BFGS-B").x
    plain = weights / spread
    plain[0] = weights[0] - (plain * middle)[1:].sum()
    return np.asarray(plain)


def chosen(sample: Sample, scaled: Array, weights: Array) -> Array:
    """Return the terms of the cut that stands for a sample."""
    if sample.two:
        good = sample.right >= max(AGREE, sample.right.max() - 0.05)
        if not good.any():
            good = sample.right == sample.right.max()
        scaled = scaled[good]
    return np.asarray(scaled[(scaled @ weights).argmax()])


def measure(found: list[Sample], candidates: dict[str, Array]) -> None:
    """Print how often samples of one and of two objects are told right, by each set of weights."""
    odds = {k: np.array([(s.terms @ w).max() for s in found]) for k, w in candidates.items()}
    two = np.array([s.two for s in found])
    kinds = np.array([s.kind for s in found])
    head = "".join(f"{name:>22}" for name in candidates)
    print(f"{'held out':34}{'samples':>14}{head}")
    for kind in [*MAKERS, "all"]:
        those = np.full(len(found), True) if kind == "all" else kinds == kind
        n = [np.count_nonzero(those & (two == way)) for way in (False, True)]
        cells = []
        for o in odds.values():
            rates = [np.mean((o > 0)[those & (two == w)] == w) if m else None
                     for w, m in zip((False, True), n, strict=True)]  # fmt: skip
            cells.append(" / ".join("-" if r is None else f"{r:6.1%}" for r in rates))
        print(f"{kind:34}{n[0]:>7}/{n[1]:<6}" + "".join(f"{c:>22}" for c in cells))
    print("right of one object / of two that touch or nearly")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--fit", action="store_true", help="fit the weights anew as well")
    parser.add_argument(
        "--scenes", type=int, default=40, help="of each kind, to fit and to measure"
    )
    parser.add_argument("--seed", type=int, default=7)
    options = parser.parse_args()
    warm_up()
    candidates = {"shipped": WEIGHTS}
    if options.fit:
        candidates["fitted"] = fitted(samples(options.seed, options.scenes))
    for k, name in enumerate(NAMES):
        print(f"{name:24}" + "".join(f"{way:>10} {w[k]:8.3f}" for way, w in candidates.items()))
    measure(samples(options.seed + 1000, options.scenes), candidates)


if __name__ == "__main__":
    main()
