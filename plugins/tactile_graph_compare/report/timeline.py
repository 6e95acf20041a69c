"""What every node came to in every frame, as bars along the frames."""

from __future__ import annotations

from collections.abc import Set

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.svg_text import text_width
from tactile_graph_compare.records.comparison import Comparison, Variant
from tactile_graph_compare.records.graph import STATES
from tactile_graph_compare.report.axes import plot, scale_of
from tactile_graph_compare.report.markup import Html, tag

WIDTH, RIGHT, TOP, ROW = 760.0, 746.0, 18.0, 16.0
WORDS = ("idle", "ran", "skipped", "failed")
"""Classes of the codes in `STATES`."""


def timeline(comparison: Comparison, variant: Variant, shown: Set[int]) -> Html:
    """Return a variant's nodes below each other, its frames side by side.

    Marks lead to the pictures of the frames that are ``shown``.
    """
    line, frames = variant.timeline, comparison.frames
    names = [n if len(n) <= 28 else n[:27] + "…" for n in line.nodes]
    left = max([60.0, *(text_width(n, 11.0) for n in names)]) + 12
    wide = (RIGHT - left) / max(frames.n, 1)
    bottom = TOP + ROW * len(names)
    parts: list[Html] = []
    for i, (name, full) in enumerate(zip(names, line.nodes, strict=True)):
        y = TOP + ROW * i
        states = line.states[:, i]
        told = ", ".join(
            f"{STATES[code]} in {n}" for code in (1, 2, 3, 0) if (n := int((states == code).sum()))
        )
        bars = [
            tag("path", d=_runs(states == code, left, wide, y), class_=WORDS[code])
            for code in range(len(STATES))
            if (states == code).any()
        ]
        label = tag("text", name, x=left - 6, y=y + 12, class_="tick end")
        parts.append(tag("g", tag("title", f"{full}: {told}"), bars, label))
    parts += _chosen(comparison, shown, left, wide)
    parts += _axis(frames.n, comparison.frames.indices, left, wide, bottom)
    return plot(WIDTH, bottom + 38, f"What ran in each frame: {variant.label}", parts)


def _runs(on: NDArray[np.bool_], left: float, wide: float, y: float) -> str:
    """Return a bar for each unbroken run of frames."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], on, [False]]).astype(np.int8)))
    gap = 0.8 if wide > 4 else 0.0
    return "".join(
        f"M{left + a * wide:.1f} {y + 2:.0f}h{(b - a) * wide - gap:.1f}v12"
        f"h{gap - (b - a) * wide:.1f}z"
        for a, b in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
    )


def _chosen(comparison: Comparison, shown: Set[int], left: float, wide: float) -> list[Html]:
    """Return a mark above each frame whose pictures are shown, leading there."""
    made = []
    for frame in (f for f in comparison.chosen if f.position in shown):
        x = left + (frame.position + 0.5) * wide
        mark = tag("path", d=f"M{x:.1f} 15l-4.5 -9h9z", class_="pin")
        told = tag("title", f"frame {frame.frame.index}: {', '.join(map(str, frame.choices))}")
        made.append(tag("a", told, mark, href=f"#frame-{frame.position}"))
    return made


def _axis(
    n: int, indices: NDArray[np.int64], left: float, wide: float, bottom: float
) -> list[Html]:
    scale = scale_of([0.0, float(max(n - 1, 1))], 0.0, 1.0, log=False)
    made = [tag("path", d=f"M{left:.1f} {bottom + 1:.1f}H{RIGHT:.1f}", class_="axis")]
    for tick in scale.ticks():
        if tick != int(tick) or not 0 <= tick < n:
            continue
        x = left + (tick + 0.5) * wide
        told = str(int(indices[int(tick)]))
        made.append(tag("text", told, x=x, y=bottom + 16, class_="tick mid"))
    middle = (left + RIGHT) / 2
    return [*made, tag("text", "frame", x=middle, y=bottom + 32, class_="label mid")]


def key() -> Html:
    """Return what the colours mean."""
    order = (1, 2, 3, 0)
    items = [tag("li", tag("span", class_=f"swatch {WORDS[c]}"), " ", STATES[c]) for c in order]
    items.append(tag("li", tag("span", "▼", class_="pinned"), " pictures of it are shown"))
    return tag("ul", items, class_="legend")
