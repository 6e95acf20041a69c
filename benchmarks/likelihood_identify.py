"""Identification and place in one likelihood, beside the thesis' two stages (figure 4.37).

Run with ``python benchmarks/likelihood_identify.py`` (about two minutes); ``--pads N`` takes other
than 3 simulated pads. Five objects of table 4.9, 25 readings each to learn, 25 others to test;
then each of them as a stranger; then objects that weigh and cover the same, of other shapes;
then the discs among the five pressing unevenly, as in ``likelihood_shapes.py``, and strangers that
weigh what a known disc does and are smaller.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections import Counter, defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from likelihood_robustness import HEIGHT, THESIS, WIDTH
from likelihood_shapes import FACES
from rounds import print_table, time_side_by_side

from tactile_graph import Circle, Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.distances.identity import UNKNOWN
from tactile_graph_classifiers.distances.mahalanobis import Mahalanobis
from tactile_graph_likelihood.known.identify_footprint import IdentifyFootprint
from tactile_graph_likelihood.settings import ROUGHER
from tactile_graph_sources.scene import load_scene
from tactile_graph_thesis.measure.simulated_readings import as_database, known_from, simulated

N = 25
WHOLE = replace(ROUGHER, on_pad="whole")
SHAPE_FEATURES = ["weight", "area_cm2", "axis_ratio", "compactness", "hu_1"]
ALIKE: dict[str, Any] = {
    "in_turn": [
        [{"shape": "disc", "name": "disc", "weight_g": 2000, "radius_cm": 4.5}],
        [{"shape": "rectangle", "name": "slab", "weight_g": 2000, "length_cm": 10.2,
          "breadth_cm": 6.1}],
        [{"shape": "rectangle", "name": "square", "weight_g": 2000, "length_cm": 7.85,
          "breadth_cm": 7.85}],
        [{"shape": "ellipse", "name": "ellipse", "weight_g": 2000, "semi_major_cm": 5.9,
          "semi_minor_cm": 3.4}],
        [{"shape": "polygon", "name": "triangle", "weight_g": 2000, "sides": 3,
          "radius_cm": 6.6}],
    ]
}  # fmt: skip


def tested(scene: Any, seed: int) -> tuple[Known, list[Frame]]:
    """Return objects learned from a pad's first frames, and its frames after those."""
    n = len(load_scene(scene).in_turn)
    known = known_from(simulated(load("features"), scene, N, n, seed))
    source = load("features").with_source("simulate", scene=scene, frames=2 * N * n)
    return known, list(source.frames(seed))[N * n :]


def run_all(scene: Any, pads: int, exact: bool) -> None:
    """Print how often each names the object, and how far its centre is off."""
    right: Counter[str] = Counter()
    chances: list[float] = []
    off: dict[str, list[float]] = defaultdict(list)
    total = 0
    stated = {
        g[0].name: _lengths(g[0]) for g in load_scene(scene).in_turn
    } if exact else {}  # fmt: skip
    features = load("features").runner()
    located = load("identify-locate").runner(only=["circle"])
    for seed in range(pads):
        known, frames = tested(scene, seed)
        data = as_database(known)
        weight_area = Mahalanobis(database=data)
        shapes = Mahalanobis(database=data, features=SHAPE_FEATURES)
        step = IdentifyFootprint(database=data, sizes=stated, settings=WHOLE)
        grams = load("circle-likelihood").runner(only=["grams"])
        for frame in frames:
            assert frame.truth is not None
            it = frame.truth[0]
            measured = features(frame)["features"].measurements
            found = step(grams(frame)["grams"])
            right["weight and area"] += weight_area(measured).nearest == it.name
            right["five features"] += shapes(measured).nearest == it.name
            right["likelihood"] += found.name == it.name
            chances.append(found.probability)
            total += 1
            true = it.shape
            off["likelihood"].append(
                np.hypot(found.object.x_cm - true.x_cm, found.object.y_cm - true.y_cm)
            )
            circle = located(frame).get("circle")
            if circle is not None and type(true).__name__ == "Circle":
                off["circle-3 of discs"].append(
                    np.hypot(circle.x_cm - true.x_cm, circle.y_cm - true.y_cm)
                )
                off["likelihood of discs"].append(off["likelihood"][-1])
    for name, count in right.items():
        print(f"  {name:<22} {count / total:7.2%} right of {total}")
    print(f"  mean stated probability {np.mean(chances):.4f}")
    for name, errors in off.items():
        print(f"  centre error, {name:<22} {np.mean(errors):.3f} cm")


def _lengths(thing: Any) -> dict[str, Any]:
    given = {"shape": thing.shape}
    for name in ("radius_cm", "length_cm", "breadth_cm", "semi_major_cm", "semi_minor_cm", "sides"):
        if getattr(thing, name, None) is not None:
            given[name] = getattr(thing, name)
    return given


def strangers(pads: int) -> None:
    """Print how often an object that was not learned is called unknown."""
    rejected: Counter[str] = Counter()
    total = 0
    features = load("features").runner()
    grams = load("circle-likelihood").runner(only=["grams"])
    for seed in range(pads):
        known, frames = tested("identify", seed)
        for stranger in known.names:
            others = tuple(o for o in known.objects if o.name != stranger)
            rest = Known(known.where, known.features, known.quantity, others)
            data = as_database(rest)
            old = Mahalanobis(database=data)
            step = IdentifyFootprint(database=data, settings=WHOLE)
            for frame in frames:
                assert frame.truth is not None
                if frame.truth[0].name == stranger:
                    measured = features(frame)["features"].measurements
                    rejected["weight and area"] += not old(measured).known
                    rejected["likelihood"] += step(grams(frame)["grams"]).name == UNKNOWN
                    total += 1
    for name, count in rejected.items():
        print(f"  {name:<22} {count / total:7.2%} of {total} called unknown")


def image_of(disc: Circle, weight: float, face: Any, rng: np.random.Generator) -> Any:
    """Return a disc's image in grams on the thesis' pad."""
    siemens = THESIS.conductance_s(face(disc, weight, rng), THESIS.built(rng))
    siemens *= np.exp(THESIS.law.repeatability * rng.standard_normal(siemens.shape))
    counts = THESIS.scan.counts(THESIS.volts_of(siemens), THESIS.converter, rng)
    volts = THESIS.image(THESIS.converter.volts(counts), "volt")
    return load("circle-likelihood").runner(only=["grams"])(Frame(volts, 0, 0.0))["grams"]


def placed(radius: float, rng: np.random.Generator) -> Circle:
    return Circle(rng.uniform(radius, WIDTH - radius), rng.uniform(radius, HEIGHT - radius), radius)


def pressed(objects: int, seed: int) -> None:
    """Print how often discs that press unevenly, or are smaller, are called unknown."""
    known, _ = tested("identify", 0)
    things = [g[0] for g in load_scene("identify").in_turn]
    sizes = {it.name: _lengths(it) for it in things}
    discs = [it for it in things if it.shape == "disc"]
    steps = {
        pressure: IdentifyFootprint(
            database=as_database(known), sizes=sizes, settings=replace(WHOLE, pressure=pressure)
        )
        for pressure in ("even", "any")
    }  # type: ignore[arg-type]
    cases = [(name, face, 1.0) for name, face in FACES.items()]
    cases += [(f"stranger, {s:g} as wide", FACES["even"], s) for s in (0.95, 0.9, 0.85, 0.8)]
    for name, face, scale in cases:
        rng = np.random.default_rng(seed)
        rows: dict[str, list[tuple[bool, bool, float]]] = defaultdict(list)
        for k in range(objects):
            it = discs[k % len(discs)]
            disc = placed(scale * it.radius_cm, rng)
            image = image_of(disc, it.weight_g, face, rng)
            for pressure, step in steps.items():
                found = step(image)
                off = np.hypot(found.object.x_cm - disc.x_cm, found.object.y_cm - disc.y_cm)
                rows[pressure].append((found.name == it.name, found.name == UNKNOWN, off))
        for pressure, its in rows.items():
            right, strange, off = np.mean(its, axis=0)
            print(
                f"  {name:<24} pressure: {pressure:<5} {right:7.2%} its name, {strange:7.2%}"
                f" unknown, centre off by {off:.3f} cm"
            )


def times() -> None:
    frames = list(
        load("identify-likelihood").with_source("simulate", scene="identify", frames=10).frames(3)
    )

    def cycled(name: str) -> Any:
        run, turn = load(name).runner(), itertools.cycle(frames)
        return lambda: run(next(turn))

    names = ("identify-locate", "identify-likelihood", "object-likelihood")
    print_table(time_side_by_side({n: cycled(n) for n in names}), "identify-locate")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--pads", type=int, default=3)
    chosen = parser.parse_args()
    warm_up()
    print("Table 4.9, sizes from the learned areas")
    run_all("identify", chosen.pads, exact=False)
    print("Table 4.9, sizes stated")
    run_all("identify", chosen.pads, exact=True)
    print("One of the five not learned")
    strangers(chosen.pads)
    for exact in (False, True):
        print(f"Same weight and area, other shape, sizes {'stated' if exact else 'learned'}")
        run_all(ALIKE, chosen.pads, exact)
    print("Discs of the five pressing unevenly, sizes stated")
    pressed(120, 5)
    print("One frame of the five, objects of the shipped sample")
    times()


if __name__ == "__main__":
    main()
