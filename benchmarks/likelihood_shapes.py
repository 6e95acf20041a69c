"""How often shape by evidence is right, whether its probability says so, and what it costs.

Run with ``python benchmarks/likelihood_shapes.py`` (about a minute); ``--objects N`` takes other
than 400. Objects as in ``shape_confidence.py``: discs, ellipses, rectangles and regular polygons of
3, 5 and 6 corners of 12 to 140 cm2 on the pad ``thesis``. First without the polygons, three shapes
to choose from; then all four. `shape_decision` gets the same choice: its confidences in the
others are left out and the rest normalised. Then the three shapes pressing unevenly: as a ball
does, (1 - r**2) to the power 1/2 or 1, with the weight a fifth of the way from the middle to the
rim, and through foam half a cell wide; and so the discs of table 4.2, as in
``likelihood_robustness.py``.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from likelihood_robustness import GEOMETRY, KINDS, THESIS, gains
from likelihood_robustness import frames as discs_of
from rounds import print_table, time_side_by_side
from shape_confidence import frames

from tactile_graph import Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph.wires import Circle, Ellipse, Rectangle
from tactile_graph_likelihood.settings import ROUGHER
from tactile_graph_likelihood.single.choose_shape import ChooseShape
from tactile_graph_pads.contact import spread

WHOLE = replace(ROUGHER, on_pad="whole")
FINE = 24
Shape = Circle | Ellipse | Rectangle
Load = np.ndarray[Any, np.dtype[np.float64]]
BINS = (0.25, 0.5, 0.7, 0.8, 0.9, 0.97, 1.0)
Answer = dict[str, float]


def by_evidence(names: tuple[str, ...]) -> Callable[[Frame], Answer | None]:
    step = ChooseShape(shapes=list(names), settings=WHOLE)  # type: ignore[arg-type]
    run = load("circle-likelihood").runner(only=["grams"])

    def answer(frame: Frame) -> Answer | None:
        image = run(frame).get("grams")
        if image is None:
            return None
        found = step(image)
        return {name: getattr(found, name) for name in names}

    return answer


def by_outline(names: tuple[str, ...]) -> Callable[[Frame], Answer | None]:
    run = load("objects").runner()

    def answer(frame: Frame) -> Answer | None:
        result = run(frame)
        shapes: Any = result.get("shapes")
        if not shapes:
            return None
        counts = [contact.n_cells for contact in result["objects"].contacts]
        if len(counts) != len(shapes):
            return None
        found = shapes[int(np.argmax(counts))]
        chances = {name: getattr(found, name) for name in names}
        total = sum(chances.values())
        return {name: c / total for name, c in chances.items()} if total > 0.0 else None

    return answer


def show(title: str, names: tuple[str, ...], some: list[Frame], contestants: Any) -> None:
    print(f"\n{title}: {len(some)} objects")
    for label, answer in contestants.items():
        counts: Counter[tuple[str, str]] = Counter()
        stated, right = [], []
        for frame in some:
            found = answer(frame)
            assert frame.truth is not None
            true = frame.truth[0].name
            true = true if true in names else "polygon"
            if found is None:
                counts[true, "none"] += 1
                continue
            best = max(found, key=lambda name: found[name])
            counts[true, best] += 1
            stated.append(found[best])
            right.append(best == true)
        n = sum(counts.values())
        hits = sum(c for (a, b), c in counts.items() if a == b)
        print(f"{label}: right {hits / n:.1%}; mean stated probability {np.mean(stated):.1%}")
        print(f"  {'true / found':<14}", *(f"{name:>10}" for name in (*names, "none")))
        for true in names:
            row = [counts[true, found] for found in (*names, "none")]
            print(f"  {true:<14}", *(f"{c:10d}" for c in row))
        values, hit = np.array(stated), np.array(right)
        for low, high in pairwise(BINS):
            inside = (values > low) & (values <= high)
            if inside.any():
                print(
                    f"  stated {low:4.0%} to {high:4.0%}: mean {values[inside].mean():6.1%}, "
                    f"right {hit[inside].mean():6.1%} of {inside.sum()}"
                )


def round_face(shape: Shape, power: float) -> Load:
    """Return the mean of ``(1 - r**2) ** power`` over each element, r the distance to the rim."""
    steps = (np.arange(FINE) + 0.5) / FINE - 0.5
    off = (steps * (GEOMETRY.pitch_cm - GEOMETRY.gap_cm))[None, :]
    x, y = np.meshgrid(
        (GEOMETRY.x_cm[:, None] + off).ravel(), (GEOMETRY.y_cm[:, None] + off).ravel()
    )
    angle = getattr(shape, "angle_rad", 0.0)
    u = (x - shape.x_cm) * np.cos(angle) - (y - shape.y_cm) * np.sin(angle)
    v = (x - shape.x_cm) * np.sin(angle) + (y - shape.y_cm) * np.cos(angle)
    if isinstance(shape, Rectangle):
        r = np.maximum(2.0 * np.abs(u) / shape.length_cm, 2.0 * np.abs(v) / shape.breadth_cm)
    elif isinstance(shape, Ellipse):
        r = np.hypot(u / shape.semi_major_cm, v / shape.semi_minor_cm)
    else:
        r = np.hypot(u, v) / shape.radius_cm
    pressure = np.where(r < 1.0, np.maximum(1.0 - r * r, 0.0) ** power, 0.0)
    rows, columns = GEOMETRY.shape
    return np.asarray(pressure.reshape(rows, FINE, columns, FINE).mean(axis=(1, 3)))


def ball(power: float) -> Callable[[Shape, float, np.random.Generator], Load]:
    def load_g(shape: Shape, weight: float, rng: np.random.Generator) -> Load:
        part = round_face(shape, power) * gains(rng)
        return np.asarray(part * (weight / part.sum()))

    return load_g


def leaning(shape: Shape, weight: float, rng: np.random.Generator) -> Load:
    way, off = rng.uniform(0.0, 2.0 * np.pi), 0.1 * np.sqrt(shape.area_cm2 / np.pi) * 2.0
    offset = off * np.cos(way), off * np.sin(way)
    return THESIS.contact.load_g(shape, weight, GEOMETRY, gains(rng), offset)


def even(shape: Shape, weight: float, rng: np.random.Generator) -> Load:
    return THESIS.contact.load_g(shape, weight, GEOMETRY, gains(rng))


FACES: dict[str, Callable[[Shape, float, np.random.Generator], Load]] = {
    "even": even,
    "ball on an elastic pad": ball(0.5),
    "ball on a soft layer": ball(1.0),
    "weight off centre": leaning,
    "foam, half a cell": lambda *of: spread(even(*of), GEOMETRY, 0.65),
}


def uneven(some: list[Frame], seed: int) -> None:
    """Print how often each setting of ``pressure`` names the shape, by how it presses."""
    print(f"\nThree shapes pressing unevenly, {len(some)} objects: named rightly, and stated")
    grams = load("circle-likelihood").runner(only=["grams"])
    steps = {p: ChooseShape(settings=replace(WHOLE, pressure=p)) for p in ("even", "any")}  # type: ignore[arg-type]
    for name, face in FACES.items():
        rng = np.random.default_rng(seed)
        found: dict[str, list[tuple[bool, float]]] = {p: [] for p in steps}
        for frame in some:
            assert frame.truth is not None
            true: Any = frame.truth[0]
            siemens = THESIS.conductance_s(face(true.shape, true.weight_g, rng), THESIS.built(rng))
            siemens *= np.exp(THESIS.law.repeatability * rng.standard_normal(siemens.shape))
            counts = THESIS.scan.counts(THESIS.volts_of(siemens), THESIS.converter, rng)
            volts = THESIS.image(THESIS.converter.volts(counts), "volt")
            image = grams(Frame(volts, frame.index, frame.time_s))["grams"]
            for pressure, step in steps.items():
                answer = step(image)
                found[pressure].append((answer.name == true.name, answer.probability))
        text = (f"{p}: {np.mean(its, axis=0)[0]:6.1%}, {np.mean(its, axis=0)[1]:6.1%}"
                for p, its in found.items())  # fmt: skip
        print(f"  {name:<24}", "   ".join(text))


def large_discs(scenes: int, seed: int) -> None:
    """Print how often a disc of table 4.2 stays one, how sure that is, and the centre's error."""
    print(f"\nDiscs of table 4.2, {scenes} of a kind: named rightly, stated, centre's error in cm")
    grams = load("circle-likelihood").runner(only=["grams"])
    steps = {p: ChooseShape(settings=replace(WHOLE, pressure=p)) for p in ("even", "any")}  # type: ignore[arg-type]
    for name in ("as designed", *list(FACES)[1:]):
        found: dict[str, list[tuple[bool, float, float]]] = {p: [] for p in steps}
        for frame in discs_of(*KINDS[name], scenes, seed):
            assert frame.truth is not None
            true: Any = frame.truth[0].shape
            image = grams(frame)["grams"]
            for pressure, step in steps.items():
                its = step(image)
                off = np.hypot(its.shape.x_cm - true.x_cm, its.shape.y_cm - true.y_cm)
                found[pressure].append((its.name == "disc", its.disc, off))
        means = {p: np.mean(its, axis=0) for p, its in found.items()}
        text = (f"{p}: {m[0]:6.1%}, {m[1]:6.1%}, {m[2]:.3f}" for p, m in means.items())
        print(f"  {name:<24}", "   ".join(text))


def times(some: list[Frame]) -> None:
    run = load("circle-likelihood").runner(only=["grams"])
    images = [image for f in some[:24] if (image := run(f).get("grams")) is not None]

    def cycled(names: list[Any]) -> Callable[[], object]:
        step, turn = ChooseShape(shapes=names, settings=WHOLE), itertools.cycle(images)
        return lambda: step(next(turn))

    print("\nThe step alone on one frame (target for three: 3000 us)")
    contestants = {
        "disc": cycled(["disc"]),
        "disc, ellipse, rectangle": cycled(["disc", "ellipse", "rectangle"]),
        "and polygons": cycled(["disc", "ellipse", "rectangle", "polygon"]),
    }
    print_table(time_side_by_side(contestants), "disc")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--objects", type=int, default=400)
    parser.add_argument("--seed", type=int, default=12)
    chosen = parser.parse_args()
    warm_up()
    some = frames(chosen.objects, chosen.seed)
    three, four = ("disc", "ellipse", "rectangle"), ("disc", "ellipse", "rectangle", "polygon")
    no_polygons = [f for f in some if f.truth is not None and f.truth[0].name in three]
    for title, names, of in (("three shapes", three, no_polygons), ("four", four, some)):
        contestants = {
            "choose_shape": by_evidence(names), "shape_decision": by_outline(names),
        }  # fmt: skip
        show(title, names, of, contestants)
    uneven(no_polygons, chosen.seed)
    large_discs(chosen.objects // 3, chosen.seed)
    times(some)


if __name__ == "__main__":
    main()
