"""How often images that were smoothed, median-filtered or enlarged before are noticed.

Run with ``python benchmarks/filtered_images.py``; ``--frames N`` of each kind of pad, ``--shape
rectangle`` for rectangles, ``--kinds`` other kinds of `second_simulator`, ``--by-kind`` a table for
each, ``--workers N``. Edges are continued by their last row before a filter goes over them.

`locate_disc` (or `locate_rectangle`) is told nothing of it. A table, one for the kinds together and
one for the built-in simulator, has for each filter: in how many frames it was noticed
(`posterior.filtered`), of those that are answered, and how often the 90 % region holds the truth:
of those unnoticed that fit, and of those noticed.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any, NamedTuple

from by_workers import add_workers, in_order
from scipy import ndimage
from second_simulator import KINDS, MORE_KINDS, Values
from unknown_pads import Asked, frames_of

from tactile_graph import Frame, Image, load
from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.any_pad.locate import LocateDisc, LocateRectangle

BUILT_IN = "built-in"
"""Stands for the frames of `simulate` among the kinds."""
LOCALISERS: dict[str, Callable[[Image], Any]] = {
    "disc": LocateDisc(),
    "rectangle": LocateRectangle(),
}
FINER = partial(ndimage.zoom, zoom=2, mode="nearest", grid_mode=True)


class Filter(NamedTuple):
    """What is done to an image, which makes it so many times as fine."""

    of: Callable[[Values], Values]
    times: int = 1


FILTERS = {
    "none": Filter(lambda values: values),
    "Gaussian, sigma 0.5": Filter(partial(ndimage.gaussian_filter, sigma=0.5, mode="nearest")),
    "Gaussian, sigma 1": Filter(partial(ndimage.gaussian_filter, sigma=1.0, mode="nearest")),
    "3x3 mean": Filter(partial(ndimage.uniform_filter, size=3, mode="nearest")),
    "3x3 median": Filter(partial(ndimage.median_filter, size=3, mode="nearest")),
    "twice as fine, copied": Filter(lambda values: values.repeat(2, 0).repeat(2, 1), 2),
    "twice as fine, linear": Filter(partial(FINER, order=1), 2),
    "twice as fine, cubic": Filter(partial(FINER, order=3), 2),
}


class Found(NamedTuple):
    """What came of a frame that went through a filter."""

    noticed: bool
    fits: bool
    held: bool


def filtered(image: Image, its: Filter) -> Image:
    """Return an image after a filter."""
    across, down = image.pitch_cm
    pitch_cm = across / its.times, down / its.times
    return Image(its.of(image.values), pitch_cm, image.origin_cm, image.quantity)


def frames(kind: str, asked: Asked) -> list[Frame]:
    """Return the frames of a kind of pad, or of the built-in simulator."""
    if kind != BUILT_IN:
        return frames_of(kind, asked)
    source = load("circle-3").with_source(
        "simulate", scene=f"{asked.shape}s", frames=asked.n_scenes
    )
    return list(source.frames(asked.seed))


def answers(asked: Asked, kind: str) -> dict[str, list[Found]]:
    """Return what came of a kind's frames, by filter."""
    locate, found = LOCALISERS[asked.shape], {name: [] for name in FILTERS}
    for frame in frames(kind, asked):
        true: Any = (frame.truth or ())[0].shape
        for name, its in FILTERS.items():
            try:
                answer = locate(filtered(frame.image, its))
            except Degenerate:
                continue
            posterior = answer.posterior
            found[name].append(Found(posterior.filtered, answer.fits, posterior.contains(true)))
    return found


def share(held: Sequence[bool]) -> str:
    """Return of how many the region holds the truth."""
    return f"{sum(held)} of {len(held)}" if held else ""


def table(name: str, every: Iterable[dict[str, list[Found]]]) -> str:
    """Return the table of some kinds together."""
    head = (name, "noticed", "held, unnoticed that fit", "held, noticed")
    rows, every = [head, ("---",) * len(head)], list(every)
    for its in FILTERS:
        found = [one for kind in every for one in kind[its]]
        noticed = [one.held for one in found if one.noticed]
        passed = [one.held for one in found if one.fits and not one.noticed]
        said = f"{len(noticed)} of {len(found)} ({len(noticed) / len(found):.0%})"
        rows.append((its, said, share(passed), share(noticed)))
    return "\n".join("| " + " | ".join(row) + " |" for row in rows) + "\n"


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--shape", choices=LOCALISERS, default="disc")
    parser.add_argument("--frames", type=int, default=4)
    parser.add_argument("--seed", type=int, default=2)
    parser.add_argument("--kinds", nargs="*", choices=[*KINDS, *MORE_KINDS], default=[*KINDS],
                        metavar="KIND")  # fmt: skip
    parser.add_argument("--by-kind", action="store_true")
    add_workers(parser)
    args = parser.parse_args()
    of_pads = partial(answers, Asked(args.shape, args.frames, args.seed))
    every = dict(zip(args.kinds, in_order(of_pads, args.kinds, args.workers), strict=True))
    if args.by_kind:
        for kind, found in every.items():
            print(table(kind, [found]))
    print(table(f"{len(every)} kinds", every.values()))
    built_in = Asked(args.shape, args.frames * len(every), args.seed)
    print(table(BUILT_IN, [answers(built_in, BUILT_IN)]))


if __name__ == "__main__":
    main()
