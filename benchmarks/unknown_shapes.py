"""Which shape lies on a pad that nobody described, how far off it is and what that takes.

Run with ``python benchmarks/unknown_shapes.py``; ``--scenes N`` takes so many of a kind and shape,
``--kinds`` some of the kinds only; ``--workers N`` shares the kinds among processes (times: measure
with one). ``locate`` chooses among disc, ellipse and rectangle; discs and
rectangles lie on the kinds of pads of `second_simulator`. Each line has, of discs and of
rectangles, how often the right name is given, the mean error of the centre, the mean difference of
the square roots of both areas (a size that every shape has), how often the 90 % region holds the
true outline where its name is right, how often ``fits`` is False, and median and 99 % of the
processor's time a frame. The last line is over all kinds. ``--quick`` asks for the most likely
outlines only.

Settings were tuned with seed 1; what is reported is of others.
"""

from __future__ import annotations

import argparse
import math
import time
from functools import partial
from typing import NamedTuple

import numpy as np
from by_workers import add_workers, in_order
from second_simulator import KINDS
from unknown_pads import Asked, frames_of

from tactile_graph import Pipeline, load
from tactile_graph.compiled import warm_up

SHAPES = ("disc", "rectangle")


class Row(NamedTuple):
    """What one frame came to; errors are NaN where there is no answer."""

    named: float
    centre_cm: float
    size_cm: float
    held: float
    flagged: float
    time_ms: float


def rows(pipeline: Pipeline, kind: str, asked: Asked) -> list[Row]:
    """Return a row for each frame of a kind of pad."""
    runner, found = pipeline.runner(), []
    for frame in frames_of(kind, asked):
        (true,) = (its.shape for its in frame.truth or ())
        began = time.thread_time()
        outcome = runner(frame).outcome("object")
        time_ms = 1e3 * (time.thread_time() - began)
        if not hasattr(outcome, "shape"):
            found.append(Row(0.0, math.nan, math.nan, math.nan, 1.0, time_ms))
            continue
        shape = outcome.shape
        centre_cm = math.hypot(shape.x_cm - true.x_cm, shape.y_cm - true.y_cm)
        size_cm = abs(math.sqrt(shape.area_cm2) - math.sqrt(true.area_cm2))
        named = outcome.name == asked.shape
        held = float(shape.posterior.contains(true)) if named else math.nan
        flagged = float(not shape.fits)
        found.append(Row(float(named), centre_cm, size_cm, held, flagged, time_ms))
    return found


def by_shape(pipeline: Pipeline, args: argparse.Namespace, kind: str) -> dict[str, list[Row]]:
    """Return the rows of a kind of pad, by shape."""
    return {s: rows(pipeline, kind, Asked(s, args.scenes, args.seed)) for s in SHAPES}


def cells(found: list[Row]) -> str:
    """Return a shape's part of a line."""
    named, centre_cm, size_cm, held, flagged, _ = np.nanmean(found, axis=0)
    times = [row.time_ms for row in found]
    return (
        f"{100 * named:6.1f} %{centre_cm:8.3f}{size_cm:8.3f}{100 * held:6.0f} %"
        f"{100 * flagged:6.0f} %"
        f"{np.median(times):7.2f}{np.quantile(times, 0.99):7.2f}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=36)
    parser.add_argument("--seed", type=int, default=57)
    parser.add_argument("--kinds", nargs="*", choices=[*KINDS], default=[*KINDS], metavar="KIND")
    parser.add_argument("--quick", action="store_true", help="most likely outlines, not sampled")
    add_workers(parser)
    args = parser.parse_args()
    pipeline = load("locate").with_settings({"object.quick": args.quick})
    warm_up()
    for shape in SHAPES:
        rows(pipeline, args.kinds[0], Asked(shape, 12, args.seed))
    head = f"{'named':>8}{'centre':>8}{'size':>8}{'held':>8}{'flagged':>8}{'ms':>7}{'99 %':>7}"
    print(f"{'':18}{''.join(f'{shape:>54}' for shape in SHAPES)}\n{'pad':18}{head}{head}")
    every: dict[str, list[Row]] = {shape: [] for shape in SHAPES}
    of_kinds = in_order(partial(by_shape, pipeline, args), args.kinds, args.workers)
    for kind, found in zip(args.kinds, of_kinds, strict=True):
        for shape, its in found.items():
            every[shape] += its
        print(f"{kind:18}" + "".join(cells(its) for its in found.values()), flush=True)
    print(f"{'all':18}" + "".join(cells(its) for its in every.values()))


if __name__ == "__main__":
    main()
