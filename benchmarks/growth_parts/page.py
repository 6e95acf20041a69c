"""The table of times and exponents, and the page it stands on."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from growth_parts.fit import FASTER, LARGE_END, Exponent, exponent, large_end, median_s
from growth_parts.timing import COPY, Point

HEAD = (
    "| step | scene | smallest, us | largest pad | there, ms | ns a cell | exponent: all sizes "
    "| the largest | |\n|---|---|---|---|---|---|---|---|---|"
)
SORTED = "sorts its points: n log n"
PAGES = "memory that goes back to the system with each large array, see above"
CACHE = (
    "the time of a cell rises once, between 128×128 and 256×256, and stays: probably what it works "
    "on leaves the cache (2 MB a core)"
)
OTHERS = (
    "finds one outline where there are several: none explains such a load, so that the search goes "
    "through all its attempts and the sample to its end; scene `one` is what it is for"
)
MORE = (
    "an outline over more elements leaves more unexplained than is usual, so that it is parted in "
    "more ways: `partings` is called {} times on 16, 32 and 64 (`one`)"
)
WHY = {
    "boundary_scan": PAGES,
    "bridge_lines": "sorts each row and column to find dead ones: n log n",
    "choose_shape": OTHERS,
    "compress": PAGES,
    "contours": CACHE,
    "digital_gradient": PAGES,
    "ellipse_sweep": PAGES,
    "find_bad": "probably " + PAGES + "; where it is kept 1.16 (0.68–1.43), which decides nothing",
    "fit_circle_load": PAGES,
    "fit_ellipse": CACHE,
    "fit_ellipse_direct": PAGES,
    "fit_footprint": OTHERS,
    "fit_footprints": MORE.format("0, 1 and 40"),
    "fit_rectangle": SORTED,
    "flip_cells": PAGES,
    "follow_footprint": "probably the cache: 1.11 on the other scenes, too",
    "footprint_disc": OTHERS,
    "footprint_ellipse": OTHERS,
    "footprint_rectangle": OTHERS,
    "gibbs": "probably the cache: its rounds are as many on every pad, and `grown` has 1.04",
    "graph_cuts": "minimum cuts by augmenting paths, which grow longer with the pad: no bound is "
    "linear",
    "hull": SORTED,
    "hull_graham": SORTED,
    "identify_footprint": OTHERS,
    "line_contacts": "an even load falls into basins as many as its cells (7, 50, 250 on 32, 64, "
    "128), and each one that is joined has the whole group weighed again with all its neighbours",
    "locate_objects": MORE.format("7, 16 and 165"),
    "min_area_rectangle": SORTED,
    "near_hull": "each point with each side; a hull has few, this outline of all objects many",
    "pick_contact": "sorts the contacts: n log n",
    "restore": "probably its rounds, which go on until none lowers the energy: up to 8",
    "rotate_points": PAGES,
    "simplify_polygon": "a tree of all corners, as in sorting: n log n, then probably the cache",
    "skeleton": "scikit-image's thinning: pass after pass, more for thicker objects",
    "sobel": PAGES,
    "split_watershed": "takes cells in turn from a heap: n log n",
    "subdivide_image": PAGES,
    "threshold_otsu": PAGES,
}
"""What was found where a time grows faster than the cells."""

INTRODUCTION = """\
# Growth with the pad

What a frame and a cell cost each built-in step on pads from 16×16 to 512×512 cells, and how that
grows, on scenes of two kinds: `grown`, two objects that take the same share of every pad (`one`:
the larger of them alone, for steps that find an outline), and `many`, objects of a fixed size, one
in each 8×8 cells. Settings are the defaults, machine code is on disk,
times are of the processor, medians over rounds (`python benchmarks/growth.py --page PAGE`, which
also says how steps are fed). A call over {bound:g} s ends the step's scene there, and so does a
first call over a minute, compiling counted.

The exponent is the slope of log time over log cells: 1 where a frame of four times the cells takes
four times as long. Fixed costs pull it down on small pads, so what counts is the exponent over the
{n} largest pads that were timed. Its interval of 95 % is of rounds drawn anew; it knows noise, and
nothing of a line that is bent. Bold is what surely grows faster than the cells (above {faster:g}).
A copy of the image is what going through memory once costs.

Not all of that is an algorithm's fault. On Linux the C library gives a large array back to the
system when it is done with, and gets the next one a page at a time. With
`MALLOC_MMAP_THRESHOLD_=4000000000 MALLOC_TRIM_THRESHOLD_=8000000000` and
`MALLOC_TOP_PAD_=200000000` in the environment it is kept: `sobel` on 512×512 takes 4 ms in place of
8, `threshold_otsu` 4 in place of 10, and their exponents of 1.4 become 1.1. Worth setting for
pads of that size.
"""
MENDED_HEAD = """
## Mended

What this table named when it was first made, before and after, scene `many`:

| step | what grew | before | after |
|---|---|---|---|
"""
MASK = "a contact's mask was looked for on the whole pad"
MENDED = {
    "contours": ("the next start was looked for in all that is left", "326 ms at 256×256"),
    "correct_place": ("each contact looked at the whole pad", "65 ms at 128×128, over 2 s at 256"),
    "simplify_polygon": ("the corner to go was looked for among all", "1180 ms at 256×256"),
    "score_objects": ("one pairing of all objects", "243 ms at 512×512"),
    "lean_contacts": (MASK, "110 ms at 512×512"),
    "sharpen_contacts": (f"{MASK}, as wherever a pipeline runs for each", "233 ms at 512×512"),
}


def page(points: Sequence[Point], bound_s: float, missing: Sequence[str] = ()) -> str:
    """Return the whole page; ``missing`` steps are told not to be timed."""
    told = INTRODUCTION.format(bound=bound_s, n=LARGE_END, faster=FASTER)
    left = f"\nNot timed: {', '.join(f'`{name}`' for name in missing)}.\n" if missing else ""
    body = f"\n## Every step\n\n{table(points)}\n"
    return f"{told}{_mended(points)}{_faster(points)}{body}{left}"


def _mended(points: Sequence[Point]) -> str:
    rows = []
    for name, (what, before) in MENDED.items():
        timed = [p for p in points if (p.step, p.scene) == (name, "many") and p.rounds_s]
        if timed:
            after = f"{1e3 * median_s(timed[-1]):.3g} ms at {timed[-1].side}×{timed[-1].side}"
            rows.append(f"| `{name}` | {what} | {before} | {after} |\n")
    return MENDED_HEAD + "".join(rows)


def table(points: Sequence[Point]) -> str:
    """Return a row for each step and scene."""
    return "\n".join([HEAD, *(_row(of) for of in _scenes(points))])


def _faster(points: Sequence[Point]) -> str:
    """Return what surely grows faster than the cells, of steps timed on enough sizes to tell."""
    found: dict[str, list[str]] = {}
    for of in _scenes(points):
        slope = large_end(of) if sum(bool(p.rounds_s) for p in of) >= LARGE_END else None
        if slope is not None and slope.faster and of[0].step != COPY:
            found.setdefault(of[0].step, []).append(f"{of[0].scene} {_plain(slope)}")
    if not found:
        return "\n## Faster than the cells\n\nNothing.\n"
    rows = [
        f"| `{s}` | {', '.join(how)} | {WHY.get(s, 'not looked into yet')} |"
        for s, how in found.items()
    ]
    head = "| step | exponent over the largest pads | why |\n|---|---|---|"
    return "\n## Faster than the cells\n\n" + "\n".join([head, *rows]) + "\n"


def _scenes(points: Sequence[Point]) -> list[list[Point]]:
    return [list(of) for _, of in groupby(points, key=lambda p: (p.step, p.scene))]


def _row(points: list[Point]) -> str:
    name = points[0].step if points[0].step == COPY else f"`{points[0].step}`"
    timed = [p for p in points if p.rounds_s]
    told = points[-1].told.replace("|", "/")
    told = f"{points[-1].side}: {told}" if told else ""
    if not timed:
        return f"| {name} | {points[0].scene} | | | | | | | {told} |"
    last = timed[-1]
    there_s = median_s(last)
    cells = (
        name, points[0].scene, f"{1e6 * median_s(timed[0]):.3g}", f"{last.side}×{last.side}",
        f"{1e3 * there_s:.3g}", f"{1e9 * there_s / last.side**2:.3g}", _told(exponent(timed)),
        _told(large_end(timed)), told,
    )  # fmt: skip
    return f"| {' | '.join(cells)} |"


def _told(slope: Exponent | None) -> str:
    if slope is None:
        return ""
    return f"**{_plain(slope)}**" if slope.faster else _plain(slope)


def _plain(slope: Exponent) -> str:
    return f"{slope.value:.2f} ({slope.low:.2f}–{slope.high:.2f})"
