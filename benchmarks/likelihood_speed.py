"""How long the likelihood's localisers take, how that grows with the pad, and what time buys.

Run with ``python benchmarks/likelihood_speed.py`` (about three minutes); ``--quick`` takes fewer
frames and rounds, ``--plot FILE`` draws error against time. Three tables: time on one 16x16 frame
beside circle-3 and rectangle-3; growth with the pad's side, for the same object and for one that
grows with the pad; error against time as ``precision`` varies. Whole pipelines are timed, from
the frame's voltages on; each frame's time is the median over rounds that run all in turn.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from tactile_graph import Circle, Frame, load
from tactile_graph.compiled import warm_up

Run = Callable[[Frame], Any]
PRECISIONS = (1.0, 0.5, 0.3, 0.2, 0.1, 0.05)
EARLIER = ("circle-1", "circle-2", "circle-3", "rectangle-1", "rectangle-2", "rectangle-3")
RADIUS_CM, WEIGHT_G = 5.1, 2700.0


def times_ms(runs: dict[str, Run], frames: list[Frame], rounds: int) -> dict[str, np.ndarray]:
    """Return each frame's median time; in every round each contestant runs each frame once."""
    spent = {name: np.empty((rounds, len(frames))) for name in runs}
    for run in runs.values():
        run(frames[0])
    for turn in range(rounds):
        for k, frame in enumerate(frames):
            for name, run in runs.items():
                start = time.perf_counter()
                run(frame)
                spent[name][turn, k] = 1e3 * (time.perf_counter() - start)
    return {name: np.median(t, axis=0) for name, t in spent.items()}


def frames_of(kind: str, count: int, seed: int) -> list[Frame]:
    return list(load("circle-3").with_source("simulate", scene=kind, frames=count).frames(seed))


def one_frame(count: int, rounds: int, seed: int) -> None:
    print("\nOne 16x16 frame, ms; ratio of medians to the first line of each scene")
    print(f"{'':34}{'median':>9}{'p95':>9}{'least':>9}{'ratio':>9}")
    for kind, names in (
        ("discs", ("circle-3", "circle-likelihood", "object-likelihood")),
        ("rectangles", ("rectangle-3", "rectangle-likelihood", "object-likelihood")),
    ):
        found = times_ms({n: load(n).runner() for n in names}, frames_of(kind, count, seed), rounds)
        first = float(np.median(found[names[0]]))
        for name, t in found.items():
            middle = float(np.median(t))
            print(f"{kind + ': ' + name:34}{middle:9.3f}{np.percentile(t, 95):9.3f}", end="")
            print(f"{t.min():9.3f}{middle / first:9.2f}")


def growth(sides: list[int], count: int, rounds: int, seed: int) -> None:
    print("\nGrowth with the pad: circle-likelihood, all of it and the step alone; ms")
    heads = f"{'touched':>9}{'pipeline':>10}{'step':>9}{'centre cm':>11}{'radius':>9}"
    print(f"{'':24}{'side':>6}{heads}")
    for name, grows in (("same object", False), ("object grows too", True)):
        for side in sides:
            scale = side / 16 if grows else 1.0
            thing = {"shape": "disc", "name": "disc", "radius_cm": RADIUS_CM * scale,
                     "weight_g": WEIGHT_G * scale**2}  # fmt: skip
            source = load("circle-likelihood").with_source(
                "simulate", scene={"objects": [thing]}, frames=count, sigma=0.483, voids=0.164,
                pad={"geometry": {"rows": side, "columns": side}},
            )  # fmt: skip
            frames = list(source.frames(seed))
            run, before = source.runner(), source.runner(only=["grams"])
            found = times_ms({"all": run, "before": before}, frames, rounds)
            off, radius = errors(run, frames, "circle")
            touched = np.median([(before(f)["grams"].values > 0).sum() for f in frames])
            whole = float(np.median(found["all"]))
            step = float(np.median(found["all"] - found["before"]))
            print(
                f"{name:24}{side:6}{touched:9.0f}{whole:10.2f}{step:9.2f}{off:11.4f}{radius:9.4f}"
            )


def errors(run: Run, frames: list[Frame], output: str) -> tuple[float, float]:
    """Return the mean error of centre and size (radius, or root of the area) in cm."""
    off, size = [], []
    for frame in frames:
        found = run(frame).get(output)
        if found is None:
            continue
        assert frame.truth is not None
        true = frame.truth[0].shape
        off.append(math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm))
        if isinstance(true, Circle):
            size.append(abs(found.radius_cm - true.radius_cm))
        else:
            size.append(abs(math.sqrt(found.area_cm2) - math.sqrt(true.area_cm2)))
    return float(np.mean(off)), float(np.mean(size))


def trade(count: int, rounds: int, seed: int) -> dict[str, list[tuple[str, float, float]]]:
    """Print and return time and centre error of each localiser, by scene."""
    points: dict[str, list[tuple[str, float, float]]] = {}
    print("\nError against time: median ms of the pipeline, mean error in cm")
    print(f"{'':44}{'ms':>9}{'centre':>9}{'size':>9}")
    for kind, shape in (("discs", "circle"), ("rectangles", "rectangle")):
        runs = {n: load(n).runner() for n in EARLIER if n.startswith(shape)}
        if shape == "circle":
            runs["bayes-circle"] = load("bayes-circle").runner()
        for p in PRECISIONS:
            settings = {f"{shape}.precision": p}
            name = f"{shape}-likelihood, precision {p:g}"
            runs[name] = load(f"{shape}-likelihood").with_settings(settings).runner()
        settings = {f"{shape}.most_points": 32}
        runs[f"{shape}-likelihood, 32 points"] = (
            load(f"{shape}-likelihood").with_settings(settings).runner()
        )
        frames = frames_of(kind, count, seed)
        found = times_ms(runs, frames[: max(6, count // 5)], rounds)
        points[kind] = []
        for name, run in runs.items():
            off, size = errors(run, frames, shape)
            middle = float(np.median(found[name]))
            points[kind].append((name, middle, off))
            print(f"{kind + ': ' + name:44}{middle:9.3f}{off:9.4f}{size:9.4f}")
    return points


def draw(points: dict[str, list[tuple[str, float, float]]], file: Path) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FixedLocator, FormatStrFormatter, NullFormatter

    figure, axes = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
    for axis, (kind, its) in zip(axes, points.items(), strict=True):
        line = [(t, e, n) for n, t, e in its if "precision" in n]
        axis.plot(*zip(*[(t, e) for t, e, _ in line], strict=True), "o-", label="likelihood")
        for t, e, name in (line[0], line[-1]):
            axis.annotate(
                name.partition(", ")[2], (t, e), (0, -14), textcoords="offset points", ha="center"
            )
        for name, t, e in its:
            if "likelihood" not in name:
                axis.plot(t, e, "s", label=name)
        axis.set(xscale="log", yscale="log", title=kind, xlabel="time of a frame, ms")
        for one, ticks in (
            (axis.xaxis, (0.05, 0.1, 0.2, 0.5, 1, 2, 5)), (axis.yaxis, (0.05, 0.1, 0.2, 0.5, 1))
        ):  # fmt: skip
            one.set_major_locator(FixedLocator(ticks))
            one.set_major_formatter(FormatStrFormatter("%g"))
            one.set_minor_formatter(NullFormatter())
        axis.margins(0.15)
        axis.set_ylabel("mean error of the centre, cm")
        axis.grid(visible=True, which="both", alpha=0.3)
        axis.legend()
    figure.savefig(file, dpi=110)
    print(f"wrote {file}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--plot", type=Path)
    parser.add_argument("--sides", type=int, nargs="*", default=[16, 32, 64])
    parser.add_argument("--seed", type=int, default=11)
    chosen = parser.parse_args()
    warm_up()
    count, rounds = (20, 3) if chosen.quick else (100, 7)
    one_frame(count, rounds, chosen.seed)
    growth(chosen.sides, 5 if chosen.quick else 12, rounds, chosen.seed)
    points = trade(count, rounds, chosen.seed)
    if chosen.plot:
        draw(points, chosen.plot)


if __name__ == "__main__":
    main()
