"""How often small shapes are named rightly, and how surely.

Run with ``python benchmarks/small_names.py``; ``--objects N`` of each range of sizes,
``--seed N``, ``--pipelines`` those to ask. Discs, ellipses and rectangles are equally likely, radii
and half sides log-uniform over a range, all told the pipelines, and pressed at so many grams an
element; the project's own pad. A row holds how many are named rightly, the mean probability told
for the name (the same, if probabilities are true), the mean of -ln of the true shape's probability
(1.10 says nothing), and by what was told for any shape how often that was true.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Pipeline, load

NAMES = ("disc", "ellipse", "rectangle")
SHAPES = {"Circle": 0, "Ellipse": 1, "Rectangle": 2}
PIPELINES = ("locate", "object-likelihood")
CELL_CM2 = 1.69
TOLD = (0.0, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 1.0)
"""Limits of what was told, between which it is counted how often it was true."""
FEWEST = 10
"""Probabilities told between two limits, for a share that was true to be given."""


class Range(NamedTuple):
    """Sizes in cm, radii and half sides, and what an element bears in grams."""

    smallest_cm: float
    largest_cm: float
    load_g: float


RANGES = (
    Range(1.0, 3.0, 60.0),
    Range(1.0, 3.0, 300.0),
    Range(1.5, 5.0, 60.0),
    Range(2.0, 7.0, 60.0),
)


def scene(its: Range, count: int, rng: np.random.Generator) -> str:
    """Return a scene of so many objects, one a frame."""
    lines = ["about: shapes of a range of sizes", "in_turn:"]
    log_range = np.log([its.smallest_cm, its.largest_cm])
    for _ in range(count):
        b, a = np.sort(np.exp(rng.uniform(*log_range, 2))).round(3).tolist()
        r = round(float(np.exp(rng.uniform(*log_range))), 3)
        area, text = (
            (np.pi * r * r, f"disc, radius_cm: {r}"),
            (np.pi * a * b, f"ellipse, semi_major_cm: {a}, semi_minor_cm: {b}"),
            (4.0 * a * b, f"rectangle, length_cm: {2 * a:.3f}, breadth_cm: {2 * b:.3f}"),
        )[rng.integers(3)]
        weight_g = max(1, round(its.load_g * area / CELL_CM2))
        lines.append(f"  - [{{shape: {text}, weight_g: {weight_g}}}]")
    return "\n".join(lines) + "\n"


def named(
    pipeline: Pipeline, path: Path, its: Range, count: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return what is told of each shape, (N, 3), and which it is, (N,), where anything is found."""
    pipeline = pipeline.with_settings(
        {"object.smallest_cm": its.smallest_cm, "object.largest_cm": its.largest_cm}
    ).with_source("simulate", scene=str(path), frames=count)
    run, told, true = pipeline.runner(), [], []
    for frame in pipeline.frames():
        found = run(frame).get("object")
        if found is not None:
            told.append([getattr(found, name) for name in NAMES])
            true.append(SHAPES[type(frame.truth[0].shape).__name__])
    return np.array(told), np.array(true)


def row(told: NDArray[np.float64], true: NDArray[np.int64]) -> str:
    """Return what the answers come to."""
    right, surprise = told.argmax(axis=1) == true, -np.log(told[np.arange(len(true)), true] + 1e-6)
    every, hits = told.ravel(), np.eye(3)[true].ravel() > 0
    shares = []
    for least, most in zip(TOLD, (*TOLD[1:-1], 1.01), strict=False):
        its = (every >= least) & (every < most)
        if its.sum() >= FEWEST:
            shares.append(f"{every[its].mean():.3f}: {hits[its].mean():.3f}")
    return (
        f"{right.mean():.1%} right, {told.max(axis=1).mean():.1%} told, "
        f"-ln {surprise.mean():.3f}; told: true {', '.join(shares)}"
    )


def main() -> None:
    """Print a row for each pipeline and range."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--objects", type=int, default=400)
    parser.add_argument("--seed", type=int, default=2)
    parser.add_argument("--pipelines", nargs="+", default=PIPELINES)
    asked = parser.parse_args()
    for name in asked.pipelines:
        for k, its in enumerate(RANGES):
            rng = np.random.default_rng([asked.seed, k])
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "scene.yaml"
                path.write_text(scene(its, asked.objects, rng))
                found = row(*named(load(name), path, its, asked.objects))
            print(
                f"{name}, {its.smallest_cm:g} to {its.largest_cm:g} cm, {its.load_g:g} g: {found}",
                flush=True,
            )


if __name__ == "__main__":
    main()
