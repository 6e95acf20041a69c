"""How often shape by evidence is right, whether its probability says so, and what it costs.

Run with ``python benchmarks/likelihood_shapes.py`` (about a minute); ``--objects N`` takes other
than 400. Objects as in ``shape_confidence.py``: discs, ellipses, rectangles and regular polygons of
3, 5 and 6 corners of 12 to 140 cm2 on the pad ``thesis``. First without the polygons, three shapes
to choose from; then all four. `shape_decision` gets the same choice: its confidences in the
others are left out and the rest normalised.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections import Counter
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from rounds import print_table, time_side_by_side
from shape_confidence import frames

from tactile_graph import Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph_likelihood.choose_shape import ChooseShape

BINS = (0.25, 0.5, 0.7, 0.8, 0.9, 0.97, 1.0)
Answer = dict[str, float]


def by_evidence(names: tuple[str, ...]) -> Callable[[Frame], Answer | None]:
    step = ChooseShape(shapes=list(names), on_pad="whole")  # type: ignore[arg-type]
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


def times(some: list[Frame]) -> None:
    run = load("circle-likelihood").runner(only=["grams"])
    images = [image for f in some[:24] if (image := run(f).get("grams")) is not None]

    def cycled(names: list[Any]) -> Callable[[], object]:
        step, turn = ChooseShape(shapes=names, on_pad="whole"), itertools.cycle(images)
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
    times(some)


if __name__ == "__main__":
    main()
