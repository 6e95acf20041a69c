"""Counts on larger pads: the same objects, of more and more cells, told apart by split_contacts.

    python benchmarks/object_sizes.py [--scenes 40] [--seed 5] [--sizes 16 32 64]

Objects grow with the pad, so only the number of cells changes; small ones stay as they are on 16
by 16. Beside it the same with ``working_cells`` out of reach, which looks at every cell at once.
"""

from __future__ import annotations

import argparse
import statistics
import time
from typing import Any

import numpy as np
import objects
from suite_parts.scenes import pad_of, scene

from tactile_graph import Frame
from tactile_graph.compiled import warm_up
from tactile_graph.errors import UsageError
from tactile_graph.steps import Report
from tactile_graph_filters.parting.split_contacts import SplitContacts
from tactile_graph_sources.simulate import simulate

LEVEL_V = 0.01
STEPS = {"as shipped": SplitContacts(), "every cell": SplitContacts(working_cells=10**9)}


def scaled(made: dict[str, Any], scale: float) -> dict[str, Any]:
    """Return an object so many times as wide, as heavy for its area."""
    wider = {k: v * scale for k, v in made.items() if k.endswith("_cm")}
    return {**made, **wider, "weight_g": made["weight_g"] * scale**2}


def drawn(
    kinds: tuple[str, ...], size: int, scale: float, apart_cm: float, n: int, seed: int
) -> list[Frame]:
    """Return frames of objects at random places, each at least so far from another."""
    rng = np.random.default_rng([seed, size])
    pad = pad_of("noisy", size, rng)
    found: list[Frame] = []
    while len(found) < n:
        made = [scaled(objects.thing(kind, rng), scale) for kind in kinds]
        try:
            found += simulate(
                scene={"objects": made, "apart_cm": apart_cm}, pad=pad, frames=1, rng=rng,
                report=Report(),
            )  # fmt: skip
        except UsageError:  # no place for all
            continue
    return found


def count(name: str, size: int, frames: list[Frame]) -> None:
    """Print how often either way finds as many objects as there are, and its time."""
    masks = [f.image.mask(f.image.values >= LEVEL_V) for f in frames]
    cells = []
    for step in STEPS.values():
        off, times = [], []
        for frame, mask in zip(frames, masks, strict=True):
            assert frame.truth is not None
            start = time.process_time()
            found = step(frame.image, mask)
            times.append(time.process_time() - start)
            off.append(found.count - len(frame.truth))
        many, few = (np.mean(np.sign(off) == way) for way in (1, -1))
        cells.append(f"{1 - many - few:7.1%} ({many:5.1%} / {few:5.1%})"
                     f"{1e3 * statistics.median(times):8.2f} ms")  # fmt: skip
    mean = np.mean([mask.count for mask in masks])
    print(f"{name:28}{size:4}{mean:7.0f}" + "".join(f"{cell:>36}" for cell in cells))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", type=int, default=40)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--sizes", type=int, nargs="+", default=[16, 32, 64])
    chosen = parser.parse_args()
    warm_up()
    n, seed = chosen.scenes, chosen.seed
    head = "".join(f"{name + ': right (many / few)':>36}" for name in STEPS)
    print(f"{'':28} pad  cells{head}")
    for name in ("noisy", "broken", "dead row", "two objects"):
        for size in chosen.sizes:
            count(name, size, list(scene(name, size, n, seed).frames))
    for size in chosen.sizes:
        frames = drawn(objects.KINDS, size, size / 16, 0.0, n, seed)
        count("six grown, none apart", size, frames)
    for size in chosen.sizes:
        if size > 16:
            kinds = objects.KINDS * (size // 16) ** 2
            count("small ones, 1.3 cm apart", size, drawn(kinds, size, 1.0, 1.3, n // 4, seed))


if __name__ == "__main__":
    main()
