"""The table of times and exponents, and the page it stands on."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from growth_parts.fit import Exponent, exponent, large_end, median_s
from growth_parts.timing import Point

HEAD = (
    "| step | scene | 16x16, us | largest | there, ms | ns a cell | exponent, all | large end |\n"
    "|---|---|---|---|---|---|---|---|"
)


def table(points: Sequence[Point]) -> str:
    return "\n".join([HEAD, *map(_row, _scenes(points))])


def page(points: Sequence[Point], bound_s: float) -> str:
    return ""


def _scenes(points):
    return [list(g) for _, g in groupby(points, key=lambda p: (p.step, p.scene))]


def _row(points: list[Point]) -> str:
    first = points[0]
    timed = [p for p in points if p.rounds_s]
    told = points[-1].told
    if not timed:
        return f"| {first.step} | {first.scene} | | | | | | {told} |"
    last = timed[-1]
    t = median_s(last)
    mark = lambda e: "" if e is None else f"{e.value:.2f} [{e.low:.2f}, {e.high:.2f}]" + (" !" if e.faster else "")
    return (
        f"| {first.step} | {first.scene} | {1e6 * median_s(timed[0]):.0f} | {last.side} | "
        f"{1e3 * t:.3g} | {1e9 * t / last.side**2:.3g} | {mark(exponent(timed))} | "
        f"{mark(large_end(timed))} | {told[:60]}"
    )
