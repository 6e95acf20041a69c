"""How often `shape_decision` is right, and whether its confidence says so.

Run with ``python benchmarks/shape_confidence.py`` (about a minute); ``--objects N`` takes N
objects, ``--seed`` other ones. ``--fit`` (some ten minutes) draws `FITTED_OBJECTS` others from
`FITTED_SEED` on and prints the weights that stand in
``plugins/tactile_graph_fitters/shape/shape_confidence.py``.

Single objects lie at random on the pad ``thesis``: discs, ellipses, rectangles and regular
polygons of 3, 5 and 6 corners in turn, of 12 to 140 cm2, spread evenly over its logarithm, under 20
to 60 g/cm2. Ellipses are 0.4 to 0.8 as broad as long, rectangles 0.3 to 0.9. Outlines are taken as
the pipeline ``objects`` does; of an object that falls apart the largest contact counts.
"""

from __future__ import annotations

import argparse
import math
import time
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph.errors import Degenerate, UsageError
from tactile_graph.steps import Report
from tactile_graph.wires import Points
from tactile_graph_fitters.shape.shape_confidence import KINDS, MOST_CORNERS, features
from tactile_graph_fitters.shape.shape_decision import PER_CELL, shape_decision
from tactile_graph_fitters.shape.shape_fits import shape_fits
from tactile_graph_hull.hull import hull
from tactile_graph_sources.simulate import simulate

Values = NDArray[np.float64]
AREA_CM2, PRESSURE_G_CM2 = (12.0, 140.0), (20.0, 60.0)
CELL_CM = 1.3
FITTED_SEED, FITTED_OBJECTS, FITTED_AT_ONCE = 70, 9000, 1500
RIDGE = 3e-4
BINS = (0.25, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97, 1.0)


class Case(NamedTuple):
    """An outline and what it is of."""

    kind: str
    name: str
    outline: Points


def thing(kind: str, rng: np.random.Generator) -> dict[str, Any]:
    """Draw an object of a kind."""
    area = math.exp(rng.uniform(*np.log(AREA_CM2)))
    made: dict[str, float] = {}
    name = kind
    if kind == "disc":
        made = {"radius_cm": math.sqrt(area / math.pi)}
    elif kind == "ellipse":
        ratio = rng.uniform(0.4, 0.8)
        made = {"semi_major_cm": math.sqrt(area / math.pi / ratio)}
        made["semi_minor_cm"] = ratio * made["semi_major_cm"]
    elif kind == "rectangle":
        ratio = rng.uniform(0.3, 0.9)
        made = {"length_cm": math.sqrt(area / ratio)}
        made["breadth_cm"] = ratio * made["length_cm"]
    else:
        sides = int(rng.choice([3, 5, 6]))
        made = {"radius_cm": math.sqrt(2.0 * area / sides / math.sin(2.0 * math.pi / sides))}
        name = f"{sides} corners"
        made["sides"] = sides
    made["weight_g"] = area * rng.uniform(*PRESSURE_G_CM2)
    return {"shape": kind, "name": name, **made}


def frames(n: int, seed: int) -> list[Frame]:
    """Frames with one object each; one that finds no place is drawn again."""
    rng = np.random.default_rng(seed)
    found: list[Frame] = []
    while len(found) < n:
        scene = {"objects": [thing(KINDS[len(found) % len(KINDS)], rng)]}
        try:
            found += simulate(scene=scene, frames=1, rng=rng, report=Report())
        except UsageError as error:
            if "found no place" not in str(error):
                raise
    return found


def cases(n: int, seed: int) -> list[Case]:
    run = load("objects").runner(only=["objects", "outlines"])
    found = []
    for frame in frames(n, seed):
        assert frame.truth is not None
        result = run(frame)
        outlines = result.get("outlines")
        if not outlines:
            continue
        counts = [contact.n_cells for contact in result["objects"].contacts]
        name = frame.truth[0].name
        kind = name if name in KINDS else "polygon"
        found.append(Case(kind, name, outlines[int(np.argmax(counts))]))
    return found


# -- the fit ---------------------------------------------------------------------------------


def observed(some: list[Case]) -> tuple[Values, NDArray[np.int64]]:
    """Features, shape (n, 9), and kinds of the cases whose hull has an area."""
    rows, kinds = [], []
    for case in some:
        corners = hull(case.outline).xy_cm
        if len(corners) < 3:
            continue
        _, length, mean_squares, _, _ = shape_fits(
            corners, CELL_CM / PER_CELL, MOST_CORNERS, CELL_CM
        )
        rows.append(features(length, mean_squares, CELL_CM))
        kinds.append(KINDS.index(case.kind))  # type: ignore[arg-type]
    return np.array(rows), np.array(kinds)


def fitted(x: Values, kinds: NDArray[np.int64]) -> Values:
    """Weights of the likeliest logistic regression, shape (9, 4), with a ridge."""
    from scipy.optimize import minimize

    n, size = x.shape

    def cost(flat: Values) -> tuple[float, Values]:
        weights = flat.reshape(size, len(KINDS))
        scores = x @ weights
        scores -= scores.max(axis=1, keepdims=True)
        share = np.exp(scores)
        share /= share.sum(axis=1, keepdims=True)
        loss = -np.log(share[np.arange(n), kinds]).mean() + RIDGE * (weights[1:] ** 2).sum()
        share[np.arange(n), kinds] -= 1.0
        slope = x.T @ share / n
        slope[1:] += 2.0 * RIDGE * weights[1:]
        return float(loss), slope.ravel()

    found = minimize(cost, np.zeros(size * len(KINDS)), jac=True, method="L-BFGS-B",
                     options={"maxiter": 5000})  # fmt: skip
    weights = np.asarray(found.x.reshape(size, len(KINDS)))
    return weights - weights.mean(axis=1, keepdims=True)


def fit() -> None:
    parts = []
    for k in range(FITTED_OBJECTS // FITTED_AT_ONCE):
        parts.append(observed(cases(FITTED_AT_ONCE, FITTED_SEED + k)))
        print(f"seed {FITTED_SEED + k}: {len(parts[-1][1])} outlines", flush=True)
    weights = fitted(np.concatenate([x for x, _ in parts]), np.concatenate([k for _, k in parts]))
    print("WEIGHTS = np.array([")
    for row in weights:
        print(f"    ({', '.join(f'{w:.3f}' for w in row)}),")
    print("])")


# -- the measurement -------------------------------------------------------------------------


def measure(n: int, seed: int) -> None:
    some = cases(n, seed)
    right, sure, lost, answers = [], [], 0, []
    start = time.perf_counter()
    for case in some:
        try:
            answers.append((case, shape_decision(case.outline, cell_cm=CELL_CM)))
        except Degenerate:
            lost += 1
    each_us = 1e6 * (time.perf_counter() - start) / len(some)
    for case, decision in answers:
        right.append(decision.kind == case.kind)
        sure.append(decision.confidence)
    hit, claimed = np.array(right), np.array(sure)
    print(f"{len(answers)} objects, {lost} without an answer, {n - len(some)} not seen at all; "
          f"{each_us:.0f} us a decision")  # fmt: skip
    print(f"right: {hit.mean():.1%}; claimed: {claimed.mean():.1%}")
    for name in ("disc", "ellipse", "rectangle", "3 corners", "5 corners", "6 corners"):
        of = np.array([case.name == name for case, _ in answers])
        named = [decision.kind for case, decision in answers if case.name == name]
        taken = ", ".join(f"{kind} {named.count(kind) / len(named):.0%}" for kind in KINDS)
        print(f"  {name:12}{hit[of].mean():6.1%}   taken for {taken}")
    print("\nconfidence      objects   claimed    right   difference, points (standard error)")
    for low, high in pairwise(BINS):
        within = (claimed >= low) & ((claimed < high) | (high == 1.0))
        if within.sum() < 2:
            continue
        share, said = hit[within].mean(), claimed[within].mean()
        error = math.sqrt(share * (1.0 - share) / within.sum())
        print(f"{low:.2f} to {high:.2f}{within.sum():12d}{said:10.1%}{share:9.1%}"
              f"{100 * (share - said):+9.1f} ({100 * error:.1f})")  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--objects", type=int, default=1600)
    parser.add_argument("--seed", type=int, default=101)
    parser.add_argument("--fit", action="store_true", help="fit the weights instead")
    arguments = parser.parse_args()
    warm_up()
    if arguments.fit:
        fit()
    else:
        measure(arguments.objects, arguments.seed)


if __name__ == "__main__":
    main()
