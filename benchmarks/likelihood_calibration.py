"""Do the likelihood's 90 % regions contain the truth in 90 % of scenes, and what does it cost?

Run with ``python benchmarks/likelihood_calibration.py`` (about a minute); ``--scenes N`` takes
other than 1000. Discs of table 4.2 and rectangles of table 4.6 on the pad ``thesis``. The second
table gives times on one frame beside circle-3 and rectangle-3, and how they grow with the pad.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from rounds import print_table, time_side_by_side

from tactile_graph import Frame, load
from tactile_graph.compiled import warm_up

PIPELINES = {
    "discs": ("circle-likelihood", "circle"),
    "rectangles": ("rectangle-likelihood", "rectangle"),
}
ORDER = {
    "discs": ("x", "y", "radius"),
    "rectangles": ("x", "y", "half length", "half breadth", "angle"),
}


def calibration(kind: str, scenes: int, seed: int) -> None:
    name, output = PIPELINES[kind]
    pipeline = load(name).with_source("simulate", scene=kind, frames=scenes)
    run = pipeline.runner()
    inside, scores, points, fits, lost = 0, [], [], 0, 0
    for frame in pipeline.frames(seed):
        found = run(frame).get(output)
        if found is None:
            lost += 1
            continue
        assert frame.truth is not None
        posterior, true = found.posterior, frame.truth[0].shape
        inside += posterior.contains(true)
        numbers = posterior.numbers(true)
        n = len(numbers)
        scores.append((posterior.mean[:n] - numbers) / np.sqrt(np.diag(posterior.covariance)[:n]))
        points.append(len(posterior.points))
        fits += posterior.fits
    rms = np.sqrt(np.mean(np.square(scores), axis=0))
    print(f"{kind}: 90 % region holds the truth in {inside / scenes:6.1%} of {scenes} scenes")
    print("  root mean square of error over stated deviation: ", end="")
    print(", ".join(f"{n} {r:.2f}" for n, r in zip(ORDER[kind], rms, strict=True)))
    print(f"  fits in {fits / scenes:.1%}; no answer in {lost}", end="")
    print(f"; points: median {np.median(points):.0f}, most {max(points)}")


def cycled(run: Callable[[Frame], object], frames: list[Frame]) -> Callable[[], object]:
    turn = itertools.cycle(frames)
    return lambda: run(next(turn))


def times(seed: int) -> None:
    contestants = {}
    for kind, first in (("discs", "circle-3"), ("rectangles", "rectangle-3")):
        frames = list(load("circle-3").with_source("simulate", scene=kind, frames=12).frames(seed))
        for name in (first, PIPELINES[kind][0]):
            contestants[name] = cycled(load(name).runner(), frames)
    for side in (32, 64):
        pad = {"geometry": {"rows": side, "columns": side}}
        source = load("circle-likelihood").with_source(
            "simulate", scene="discs", frames=6, pad=pad, sigma=0.483, voids=0.164
        )
        run = source.runner(only=["grams"])
        step = load("circle-likelihood").runner()
        contestants[f"circle-likelihood, {side}x{side}"] = cycled(step, list(source.frames(seed)))
        contestants[f"  of which up to grams, {side}x{side}"] = cycled(
            run, list(source.frames(seed))
        )
    print("\nOne frame (targets: circle-likelihood 500 us, rectangle-likelihood 1500 us)")
    print_table(time_side_by_side(contestants), "circle-3")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=11)
    chosen = parser.parse_args()
    warm_up()
    for kind in PIPELINES:
        calibration(kind, chosen.scenes, chosen.seed)
    times(chosen.seed)


if __name__ == "__main__":
    main()
