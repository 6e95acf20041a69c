"""Several objects: how often the count is right, how far off the centres are, how long it takes.

    python benchmarks/objects.py [--scenes 500] [--seed 2026]

Six objects of four kinds, sizes and weights drawn anew for each scene, are put down at random on
the thesis' simulated pad, at least so far apart as a line says; 0 cm is as it falls. Then
pairs that just touch, and single objects, those of the thesis among them, that ought to stay
whole. Settings and weights of ``split_contacts`` were chosen on other scenes (other seeds).
"""

from __future__ import annotations

import argparse
import math
import statistics
from collections.abc import Callable
from typing import Any

import numpy as np

from tactile_graph import Frame, Pipeline, load, loads
from tactile_graph.compiled import warm_up
from tactile_graph.errors import UsageError
from tactile_graph.steps import Report
from tactile_graph_sources.placement import are_apart
from tactile_graph_sources.scene import load_scene
from tactile_graph_sources.simulate import simulate
from tactile_graph_tracking.score_objects import score_objects

KINDS = ("disc", "rectangle", "ellipse", "polygon", "disc", "rectangle")
COUNTERS = {
    "contacts, 8-connected": "{step: contacts, in: [frame, footprint], with: {min_cells: 4}}",
    "split_watershed": (
        "{step: split_watershed, in: [frame, footprint], with: {neck: 0.8, min_cells: 4}}"
    ),
    "split_contacts, basins": (
        "{step: split_contacts, in: [frame, footprint], with: {recut: false}}"
    ),
    "split_contacts": "{step: split_contacts, in: [frame, footprint]}",
}
COUNTING = """
pipeline: counting
source: {step: sample, with: {name: discs}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  objects: %s
outputs: [objects]
"""


def thing(kind: str, rng: np.random.Generator) -> dict[str, Any]:
    """Return an object of 10 to 21 cm2 and 40 to 80 g/cm2."""

    def between(low: float, high: float) -> float:
        return round(float(rng.uniform(low, high)), 2)

    made: dict[str, Any] = {"shape": kind}
    if kind == "disc":
        made["radius_cm"] = between(1.9, 2.7)
        area = math.pi * made["radius_cm"] ** 2
    elif kind == "rectangle":
        made |= {"length_cm": between(4.2, 6.0), "breadth_cm": between(2.8, 3.6)}
        area = made["length_cm"] * made["breadth_cm"]
    elif kind == "ellipse":
        made |= {"semi_major_cm": between(2.5, 3.3), "semi_minor_cm": between(1.7, 2.1)}
        area = math.pi * made["semi_major_cm"] * made["semi_minor_cm"]
    else:
        sides = int(rng.integers(3, 7))
        made |= {"sides": sides, "radius_cm": between(2.4, 2.9) + (0.4 if sides == 3 else 0.0)}
        area = sides / 2 * made["radius_cm"] ** 2 * math.sin(2 * math.pi / sides)
    made["weight_g"] = round(area * between(40, 80))
    return made


def scenes(n: int, apart_cm: float, seed: int) -> list[Frame]:
    """Return one frame each of ``n`` scenes of six objects; those that do not fit are redrawn."""
    rng = np.random.default_rng(seed)
    found: list[Frame] = []
    while len(found) < n:
        scene = {"objects": [thing(k, rng) for k in KINDS], "apart_cm": apart_cm}
        try:
            found += simulate(scene=scene, frames=1, rng=rng, report=Report())
        except UsageError as error:
            if "found no place" not in str(error):
                raise
    return [f.with_index(i) for i, f in enumerate(found)]


def large(shape: str, rng: np.random.Generator) -> dict[str, Any]:
    """Return a disc or rectangle one and a half times as wide, as heavy for its area."""
    made = thing(shape, rng)
    made |= {k: round(1.5 * v, 2) for k, v in made.items() if k.endswith("_cm")}
    return made | {"weight_g": round(2.25 * made["weight_g"])}


def touching(one: dict[str, Any], other: dict[str, Any], rng: np.random.Generator) -> Frame | None:
    """Return a frame of two objects that just touch at random; None where they leave the pad."""
    turns = rng.uniform(-90.0, 90.0, 2)
    outlines = []
    for made, turn in zip((one, other), turns.tolist(), strict=True):
        made |= {} if made["shape"] == "disc" else {"angle_deg": turn}
        outlines.append(load_scene({"objects": [made]}).group(0)[0].footprint)
    start, way = rng.uniform(0.0, 20.5, 2), rng.uniform(0.0, 2.0 * math.pi)
    near, far = 0.0, 20.0
    first = outlines[0](*start, math.radians(turns[0]))
    for _ in range(25):
        middle = 0.5 * (near + far)
        x, y = start + middle * np.array([math.cos(way), math.sin(way)])
        second = outlines[1](x, y, math.radians(turns[1]))
        near, far = (near, middle) if are_apart(first, second) else (middle, far)
    if not all(((o := s.outline_cm()) >= 0.0).all() and (o <= 20.5).all() for s in (first, second)):
        return None
    pair = [
        {**m, "place": [float(s.x_cm), float(s.y_cm)]}
        for m, s in zip((one, other), (first, second), strict=True)
    ]
    return next(iter(simulate(scene={"objects": pair}, frames=1, rng=rng, report=Report())))


PAIRS: dict[str, tuple[str, str, Callable[[str, np.random.Generator], dict[str, Any]]]] = {
    "two discs": ("disc", "disc", thing),
    "two large discs": ("disc", "disc", large),
    "two rectangles": ("rectangle", "rectangle", thing),
    "disc and rectangle": ("disc", "rectangle", thing),
}


def pairs(name: str, n: int, seed: int) -> list[Frame]:
    one, other, make = PAIRS[name]
    rng = np.random.default_rng([seed, *name.encode()])
    found: list[Frame] = []
    while len(found) < n:
        frame = touching(make(one, rng), make(other, rng), rng)
        found += [] if frame is None else [frame]
    return found


def singles(name: str, n: int, seed: int) -> list[Frame]:
    """Return frames of a shipped scene, or of one object of a kind, drawn anew each time."""
    rng = np.random.default_rng([seed, *name.encode()])
    if name.startswith(("disc-", "rectangle-")):
        return list(simulate(scene=name, frames=n, rng=rng, report=Report()))
    size, _, shape = name.partition(" ")
    make = {"small": thing, "large": large}[size]
    return [
        f
        for _ in range(n)
        for f in simulate(scene={"objects": [make(shape, rng)]}, frames=1, rng=rng, report=Report())
    ]


SINGLES = (
    "disc-1", "disc-2", "disc-3", "rectangle-1", "rectangle-2", "small disc", "small rectangle",
    "small ellipse", "large disc", "large rectangle", "large ellipse",
)  # fmt: skip


def spread(errors: list[float], unit: str) -> str:
    e = np.array(errors)
    return (
        f"mean {e.mean():.3f} {unit}, median {np.median(e):.3f}, "
        f"95th percentile {np.percentile(e, 95):.3f} ({e.size} objects)"
    )


def count_scenes(frames: list[Frame], what: str) -> None:
    """Print how often each counter finds as many objects as there are."""
    for name, step in COUNTERS.items():
        pipeline = loads(COUNTING % step)
        run = pipeline.runner()
        off, times = [], []
        for frame in frames:
            result = run(frame)
            assert frame.truth is not None
            off.append(int(np.sign(result["objects"].count - len(frame.truth))))
            times.append(result.times_us["objects"])
        print(
            f"{what:22s} {name:22s} right {off.count(0) / len(off):6.1%}"
            f"  too many {off.count(1) / len(off):5.1%}  too few {off.count(-1) / len(off):5.1%}"
            f"  {statistics.median(times):6.0f} us"
        )


def locate(frames: list[Frame]) -> None:
    pipeline: Pipeline = load("objects")
    run = pipeline.runner()
    errors: dict[str, list[float]] = {"contacts (load)": [], "shapes": []}
    times = []
    for frame in frames:
        result = run(frame)
        times.append(sum(result.times_us.values()))
        errors["contacts (load)"] += [
            e for _, _, e in score_objects(frame, result["objects"].contacts).pairs
        ]
        errors["shapes"] += [e for _, _, e in score_objects(frame, result["shapes"]).pairs]
    for name, found in errors.items():
        print(f"centres of {name:16s} {spread(found, 'cm')}")
    print(f"objects.yaml: {statistics.median(times) / 1e3:.2f} ms a frame (sum of its nodes)")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", type=int, default=500)
    parser.add_argument("--seed", type=int, default=2026)
    chosen = parser.parse_args()
    warm_up()
    for apart_cm in (1.3, 1.0, 0.65, 0.0):
        frames = scenes(chosen.scenes, apart_cm, chosen.seed)
        count_scenes(frames, f"six, {apart_cm:.2f} cm apart")
        if apart_cm == 1.3:
            locate(frames)
    for name in PAIRS:
        count_scenes(pairs(name, chosen.scenes, chosen.seed), name)
    for name in SINGLES:
        count_scenes(singles(name, chosen.scenes, chosen.seed), name)


if __name__ == "__main__":
    main()
