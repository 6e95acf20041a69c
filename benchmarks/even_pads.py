"""Localisers on pads whose elements are nearly alike, or whose gap nobody said.

Run with ``python benchmarks/even_pads.py``; ``--shape rectangle`` takes rectangles instead of
discs, ``--scenes N`` so many of a kind, ``--kinds`` other kinds of `second_simulator`, which shares
no code with the project's own pads. `locate-circle` and `locate-rectangle` are told nothing.

A line has the mean errors of centre and size in cm (of a disc the radius, of a rectangle the mean
of both sides), the mean of the size with its sign, both over what was stated (root mean square; of
a rectangle the length's), how often the 90 % region holds the truth, and how many frames are
flagged. Beside them, what plain sums come to: the centroid, and for a disc the radius of the area
that the sum of all readings over that of a face's makes up.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

import numpy as np
from second_simulator import KINDS, MORE_KINDS
from unknown_pads import Asked, frames_of, off

from tactile_graph import Circle, Frame, load
from tactile_graph.compiled import warm_up

DEFAULT = [name for name, kind in MORE_KINDS.items() if kind.noise_g or kind.reads == "counts"]
PLATEAU = 0.7
"""Of the largest reading, from which on one is a face's."""
SHOWS = 0.1
"""Of the largest reading, from which on one counts for the plain sums."""


def plain(frame: Frame) -> Circle:
    """Return the disc that plain sums make of a frame."""
    image = frame.image
    values = np.where(image.values > SHOWS * image.values.max(), image.values, 0.0)
    total = float(values.sum())
    x = float((values.sum(axis=0) * image.x_cm).sum()) / total
    y = float((values.sum(axis=1) * image.y_cm).sum()) / total
    face = float(np.median(values[values > PLATEAU * values.max()]))
    across, down = image.pitch_cm
    return Circle(x, y, math.sqrt(total / face * across * down / math.pi))


def line(kind: str, asked: Asked) -> list[str]:
    """Return a kind's line of the table."""
    name = "locate-circle" if asked.shape == "disc" else "locate-rectangle"
    pipeline, output = load(name), "circle" if asked.shape == "disc" else "rectangle"
    rows, sums = [], []
    for frame in frames_of(kind, asked):
        true: Any = (frame.truth or ())[0].shape
        found, simple = pipeline.run(frame)[output], plain(frame)
        error = off(found, true)
        size = ("radius_cm", "radius_std_cm") if asked.shape == "disc" else (
            "length_cm", "length_std_cm")  # fmt: skip
        more = getattr(found, size[0]) - getattr(true, size[0])
        rows.append((
            error.centre_cm, error.size_cm, more,
            (error.centre_cm / found.posterior.centre_std_cm) ** 2,
            (more / getattr(found, size[1])) ** 2, found.posterior.contains(true), not found.fits,
        ))  # fmt: skip
        sums.append(off(simple, true)[:2])
    centre, its_size, more, over, size_over, held, flagged = np.mean(rows, axis=0)
    by_sums = np.mean(sums, axis=0)
    beside = f"{by_sums[0]:.3f}" + (f" / {by_sums[1]:.3f}" if asked.shape == "disc" else "")
    return [
        kind, f"{centre:.3f} / {its_size:.3f}", f"{more:+.3f}", f"{math.sqrt(over):.1f}, "
        f"{math.sqrt(size_over):.1f}", f"{100 * held:.0f} %", f"{100 * flagged:.0f} %", beside,
    ]  # fmt: skip


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--shape", choices=("disc", "rectangle"), default="disc")
    parser.add_argument("--scenes", type=int, default=48)
    parser.add_argument("--seed", type=int, default=2)
    parser.add_argument("--kinds", nargs="*", choices=[*KINDS, *MORE_KINDS], default=DEFAULT,
                        metavar="KIND")  # fmt: skip
    args = parser.parse_args()
    warm_up()
    head = (
        "pad",
        "off, cm",
        "size, on average",
        "over deviations",
        "held",
        "flagged",
        "plain sums",
    )
    print("| " + " | ".join(head) + " |\n|" + " --- |" * len(head))
    for kind in args.kinds:
        asked = Asked(args.shape, args.scenes, args.seed)
        print("| " + " | ".join(line(kind, asked)) + " |", flush=True)


if __name__ == "__main__":
    main()
