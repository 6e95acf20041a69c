"""The lineage: what each variant did to the one it evolved from, and what that did."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.grid_png import change_uri
from tactile_graph.draw.paint_svg import View
from tactile_graph.wires import Image, Mask
from tactile_graph_compare.output.tables import by_other, signed, signed_us
from tactile_graph_compare.records.comparison import Comparison, Evolution, NodeChange
from tactile_graph_compare.records.frames import ChosenFrame, NodeStory
from tactile_graph_compare.records.scores import Difference
from tactile_graph_compare.report.album import Album
from tactile_graph_compare.report.badges import named
from tactile_graph_compare.report.markup import Child, Html, join, scroll, tag
from tactile_graph_compare.report.strips import cell, head_of, node_order, told_choices

MOST_FRAMES = 2


def lineage(comparison: Comparison, album: Album) -> Html:
    """Return one part for each step."""
    return join([_step(comparison, album, e) for e in comparison.lineage])


def _step(comparison: Comparison, album: Album, e: Evolution) -> Html:
    title = tag("h3", named(comparison, e.parent), " → ", named(comparison, e.child))
    did = [
        *_listed("added", e.added),
        *_listed("removed", e.removed),
        *(p for c in e.changed for p in _changed(c)),
        *_listed("kept", e.kept),
    ]
    effect = [
        *(_effect(d) for d in e.differences if d.mean is not None),
        tag("li", f"time: {by_other(e.time.ratio)} ({signed_us(e.time.median_us)} µs), medians "
            "over the frames of the time by the parent's, and less it"),
    ]  # fmt: skip
    frames = _frames(comparison, e)
    pictures = [_pictures(comparison, album, e, f) for f in frames]
    both = tag("div", tag("dl", did, class_="did"), tag("ul", effect, class_="effect"),
               class_="step")  # fmt: skip
    shown = tag("div", pictures, class_="beside")
    return tag("article", title, both, shown, class_="evolution")


def _listed(what: str, names: tuple[str, ...]) -> list[Html]:
    if not names:
        return []
    return [tag("dt", what), tag("dd", [part for n in names for part in (tag("code", n), " ")])]


def _changed(change: NodeChange) -> list[Html]:
    told: list[Child] = [tag("code", change.node)]
    for c in change.changes:
        before = "–" if c.before is None else str(c.before)
        after = "–" if c.after is None else str(c.after)
        told.append(tag("span", f"{c.what}: ", tag("del", before), " ", tag("ins", after)))
    return [tag("dt", "changed"), tag("dd", told)]


def _effect(d: Difference) -> Html:
    unit = f" {d.unit}" if d.unit else ""
    bounds = f" [{signed(d.low, d.unit)}, {signed(d.high, d.unit)}]" if d.low is not None else ""
    kind = {"better": "good", "worse": "bad"}.get(d.verdict)
    told = f"mean error of {d.quantity}: {signed(d.mean, d.unit)}{unit}{bounds}, "
    return tag("li", told, tag("b", d.verdict, class_=kind))


# -- node by node --------------------------------------------------------------------------------


def _frames(comparison: Comparison, e: Evolution) -> list[ChosenFrame]:
    """Return the frames in which parent or child was worst, or else the first."""
    worst = [
        f for f in comparison.chosen
        if any(c.why == "worst" and c.variant in (e.parent, e.child) for c in f.choices)
    ]  # fmt: skip
    return (worst or list(comparison.chosen))[:MOST_FRAMES]


def _pictures(comparison: Comparison, album: Album, e: Evolution, frame: ChosenFrame) -> Html:
    before, after = frame.stories[e.parent], frame.stories[e.child]
    differ = [
        n for n in node_order(frame, (e.parent, e.child))
        if n in album.pictured and not _same(before.get(n), after.get(n))
    ]  # fmt: skip
    told = f"Frame {frame.frame.index} ({told_choices(frame.choices)}), nodes that differ"
    if not differ:
        return tag("p", f"{told}: none.", class_="note")
    shown = tag("td", album.frame(frame))
    first = [cell(album, frame, before.get(n), e.parent, "before") for n in differ]
    second = [cell(album, frame, after.get(n), e.child) for n in differ]
    off = [tag("td", _difference(album, frame, before.get(n), after.get(n))) for n in differ]
    rows = [
        tag("tr", tag("th", named(comparison, e.parent), scope="row"), shown, first),
        tag("tr", tag("th", named(comparison, e.child), scope="row"), shown, second),
        tag("tr", tag("th", "difference", scope="row"), tag("td"), off),
    ]
    made = tag(
        "table",
        head_of(album, frame, differ),
        tag("tbody", rows),
        class_="strip",
        style=f"--n:{len(differ) + 1}",
    )
    return tag("div", tag("p", f"{told}:", class_="note"), scroll(told, made))


def _same(before: NodeStory | None, after: NodeStory | None) -> bool:
    return before is not None and after is not None and before.merged == after.merged


def _difference(
    album: Album, frame: ChosenFrame, before: NodeStory | None, after: NodeStory | None
) -> Html:
    if before is None or after is None:
        return tag("small", "new" if before is None else "gone")
    if before.state != "ran" or after.state != "ran":
        return tag("small", f"{before.state} → {after.state}")
    told = f"difference of {after.node}"
    changed = difference_of(before.value, after.value)
    if changed is None:
        if isinstance(before.value, Image | Mask) or isinstance(after.value, Image | Mask):
            return tag("small", "not on equal grids")
        return album.over(frame, before, after, told)
    grid, off = changed
    n = int(np.count_nonzero(off))
    if not n:
        return tag("small", "equal")
    view = View.of(frame.frame.image)
    key = ("change", frame.position, before.merged, after.merged)
    layer = album.once(key, lambda: Html(view.grid(grid, change_uri(off))))
    most = float(np.nanmax(np.abs(off)))
    by = "" if isinstance(grid, Mask) else f", by up to {most:.3g}"
    shown = album.svg(frame, view, [layer], told)
    return join(shown, tag("small", f"{n} of {off.size} cells{by}"))


def difference_of(before: Any, after: Any) -> tuple[Image | Mask, NDArray[np.float64]] | None:
    """Return the finer of two grids and the later less the earlier on it; None if they don't fit.

    They fit where both are masks, or images of one quantity, over the same part of the pad, and
    the cells of one are whole parts of the other's.
    """
    images = isinstance(before, Image) and isinstance(after, Image)
    if images and before.quantity != after.quantity:
        return None
    if not (images or (isinstance(before, Mask) and isinstance(after, Mask))):
        return None
    if not np.allclose(before.extent_cm, after.extent_cm):
        return None
    rows, columns = max(before.rows, after.rows), max(before.columns, after.columns)
    if any(rows % g.rows or columns % g.columns for g in (before, after)):
        return None
    first, second = (
        np.repeat(np.repeat(g.values, rows // g.rows, axis=0), columns // g.columns, axis=1)
        for g in (before, after)
    )
    finer = after if after.shape == (rows, columns) else before
    return finer, second.astype(np.float64) - first.astype(np.float64)
