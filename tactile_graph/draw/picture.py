"""Draw one value of a node onto axes in cm: heat map, mask, points, outline, list or number."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.columns import Column, place, view
from tactile_graph.engine.outcome import Done, Failed, Skipped
from tactile_graph.engine.rows import scalars
from tactile_graph.wires import Frame, Image, Mask, Points, TrueObject

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage
    from matplotlib.patheffects import AbstractPathEffect

FOUND, TRUE = "#d81b60", "#00838f"
"""Colours of what was found and of what is true; apart for the colour-blind and in grey."""
DASHES = (4.0, 2.5)
MOST_NUMBERS = 20
HEAT, MASK_ON, MASK_OFF = "viridis", "#37474f", "#eceff1"
SKIPPED, FAILED = "#f3f3f3", "#fde7e7"
Edge = tuple[tuple[float, float], tuple[float, float]]


class Pen:
    """Draws values into one axes; over the frame's image where a value has no cells of its own.

    Parameters
    ----------
    axes : matplotlib Axes
    frame : Frame
    column : Column
        Its range and the frame's own range are the fixed colour ranges.
    beneath : Column
        The frame's column.
    """

    def __init__(self, axes: Axes, frame: Frame, column: Column, beneath: Column) -> None:
        self.axes = axes
        self.frame = frame
        self.column = column
        self.beneath = beneath
        self.drawn: set[str] = set()
        self.heat: AxesImage | None = None
        self._notes: list[str] = []

    def draw(self, value: Any) -> None:
        """Draw a node's outcome, and why there is none where it has none."""
        if isinstance(value, Skipped | Failed):
            self._say(value)
            return
        self._value(value, alone=True)
        self._outside()
        if self._notes:
            self._note("\n".join(self._notes[:8]))

    def truth(self, objects: Sequence[TrueObject]) -> None:
        """Draw the outlines of what truly lay there, dashed."""
        for thing in objects:
            xy = _closed(thing.shape.outline_cm())
            self.axes.plot(
                xy[:, 0], xy[:, 1], color=TRUE, lw=1.4, dashes=DASHES, zorder=5,
                path_effects=_halo(1.4),
            )  # fmt: skip
            self.drawn.add("true")

    # -- kinds of values ---------------------------------------------------------------------

    def _value(self, value: Any, alone: bool) -> None:
        if isinstance(value, Frame):
            self._image(value.image)
        elif isinstance(value, Image):
            self._image(value)
        elif isinstance(value, Mask):
            if alone:
                self._mask(value)
            else:
                self._rim(value)
        elif isinstance(value, Points):
            self._points(value)
        elif hasattr(value, "outline_cm"):
            self._outline(value)
        elif hasattr(value, "_fields"):
            self._fields(value)
        elif isinstance(value, list | tuple):
            self._items(value)
        else:
            self._other(value)

    def _image(self, image: Image) -> None:
        shown = (
            image.values if image.valid is None else np.ma.array(image.values, mask=~image.valid)
        )
        self.heat = self.axes.imshow(
            shown, HEAT, vmin=self.column.low, vmax=self.column.high,
            extent=image.extent_cm, interpolation="nearest", zorder=1,
        )  # fmt: skip

    def _mask(self, mask: Mask) -> None:
        from matplotlib.colors import ListedColormap

        self.axes.imshow(
            mask.values, ListedColormap([MASK_OFF, MASK_ON]), vmin=0, vmax=1,
            extent=mask.extent_cm, interpolation="nearest", zorder=1,
        )  # fmt: skip

    def _rim(self, mask: Mask) -> None:
        from matplotlib.collections import LineCollection

        self._ground()
        self.axes.add_collection(
            LineCollection(cell_edges(mask), colors=FOUND, linewidths=1.5, zorder=4),
            autolim=False,
        )
        self.drawn.add("found")

    def _points(self, points: Points) -> None:
        self._ground()
        size = 3.5 if points.count <= 200 else 2.0
        x, y = points.xy_cm[:, 0], points.xy_cm[:, 1]
        self.axes.plot(x, y, "o", color=FOUND, ms=size, mec="white", mew=0.3, zorder=4)
        self.drawn.add("found")

    def _outline(self, value: Any) -> None:
        self._ground()
        xy = _closed(np.asarray(value.outline_cm(), dtype=np.float64).reshape(-1, 2))
        self.axes.plot(xy[:, 0], xy[:, 1], color=FOUND, lw=1.7, zorder=4, path_effects=_halo(1.7))
        self._centre(value)
        self.drawn.add("found")

    def _centre(self, value: Any) -> bool:
        """Mark the place a record names, if it names one."""
        at = place(value)
        if at is None:
            return False
        self._ground()
        self.axes.plot(*([c] for c in at), "+", color=FOUND, ms=6, mew=1.3, zorder=4)
        self.drawn.add("found")
        return True

    def _fields(self, value: Any) -> None:
        marked = self._centre(value)
        for name, field in zip(value._fields, value, strict=True):
            told = marked and name in ("x_cm", "y_cm")
            if told or field is None or isinstance(field, Skipped | Failed | Done):
                continue
            if isinstance(field, bool | int | float | str | np.generic):
                self._notes.append(f"{name} {_printed(field)}")
            else:
                self._value(field, alone=isinstance(field, Mask) and self._blank)

    def _items(self, items: Sequence[Any]) -> None:
        if not items:
            self._notes.append("none")
        if items and all(isinstance(i, bool | int | float | str | np.generic) for i in items):
            self._notes += [_printed(i) for i in items]
            return
        for number, item in enumerate(items, 1):
            self._value(item, alone=False)
            if 1 < len(items) <= MOST_NUMBERS:
                self._number(item, number)

    def _number(self, item: Any, number: int) -> None:
        at = _middle(item)
        if at is not None:
            self.axes.annotate(
                str(getattr(item, "number", number)), at, ha="center", va="center",
                fontsize=7, color="white", zorder=6, annotation_clip=True,
                bbox={"boxstyle": "round,pad=0.15", "fc": FOUND, "ec": "none"},
            )  # fmt: skip

    def _other(self, value: Any) -> None:
        for kind in (Mask, Points, Image):
            seen = view(value, kind)
            if seen is not None:
                self._value(seen, alone=False)
                return
        self._centre(value)
        printed = scalars(self.column.name, value) or {"": _printed(value)}
        last = {k.rpartition(".")[2] if "." in k else "": v for k, v in printed.items()}
        self._notes += [f"{k} {_printed(v)}".strip() for k, v in last.items()]

    # -- what lies beneath, and words --------------------------------------------------------

    @property
    def _blank(self) -> bool:
        return not self.axes.images

    def _ground(self) -> None:
        """Lay the frame's image beneath in pale grey, once."""
        if self._blank:
            from matplotlib.colors import PowerNorm

            image, low = self.frame.image, self.beneath.low
            # Pale, so that lines stand out; rooted, so that light touches still show.
            norm = PowerNorm(0.5, low, low + 4.5 * (self.beneath.high - low))
            self.axes.imshow(
                image.filled(low), "Greys", norm=norm,
                extent=image.extent_cm, interpolation="nearest", zorder=0,
            )  # fmt: skip

    def _outside(self) -> None:
        """Say so where all that was found lies off the pad, rather than show nothing."""
        lines = [np.asarray(line.get_xydata()) for line in self.axes.lines]
        points = np.concatenate([p for p in lines if p.size] or [np.empty((0, 2))])
        if not len(points) or "found" not in self.drawn:
            return
        (x0, x1), (y1, y0) = self.axes.get_xlim(), self.axes.get_ylim()
        x, y = points[:, 0], points[:, 1]
        if not ((x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)).any():
            self._notes.append("outside the picture")

    def _note(self, text: str) -> None:
        small = self._blank and not self.drawn
        made = self.axes.text(
            0.5 if small else 0.03, 0.5 if small else 0.97, text, transform=self.axes.transAxes,
            ha="center" if small else "left", va="center" if small else "top",
            fontsize=9 if small else 7, zorder=7, parse_math=False,
        )  # fmt: skip
        if not small:
            made.set_bbox({"boxstyle": "round,pad=0.2", "fc": "white", "ec": "none", "alpha": 0.6})

    def _say(self, outcome: Skipped | Failed) -> None:
        failed = isinstance(outcome, Failed)
        self.axes.set_facecolor(FAILED if failed else SKIPPED)
        word = "failed" if failed else "skipped"
        at = outcome.origin if outcome.origin not in ("", self.column.name) else ""
        where = f" at {at}" if at else ""
        lines = wrap(f"{word}{where}", 24) + wrap(outcome.reason, 28)
        lines = lines if len(lines) <= 9 else [*lines[:8], lines[8][:26] + " …"]
        self.axes.text(
            0.5, 0.5, "\n".join(lines), transform=self.axes.transAxes, ha="center", va="center",
            fontsize=6.5, color="#8e2323" if failed else "#555555", parse_math=False,
        )  # fmt: skip


def cell_edges(mask: Mask) -> list[Edge]:
    """Return the edges between cells that are on and cells that are not, in cm."""
    padded = np.pad(mask.values, 1)
    (x0, y0), (dx, dy) = mask.origin_cm, mask.pitch_cm
    rows, columns = np.nonzero(padded[:, 1:] != padded[:, :-1])
    upright = [
        ((x0 + c * dx, y0 + (r - 1) * dy), (x0 + c * dx, y0 + r * dy))
        for r, c in zip(rows.tolist(), columns.tolist(), strict=True)
    ]
    rows, columns = np.nonzero(padded[1:] != padded[:-1])
    level = [
        ((x0 + (c - 1) * dx, y0 + r * dy), (x0 + c * dx, y0 + r * dy))
        for r, c in zip(rows.tolist(), columns.tolist(), strict=True)
    ]
    return upright + level


def _halo(width: float) -> list[AbstractPathEffect]:
    """Return a white edge around a line, which keeps it legible over any cell."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=width + 1.3, foreground="white")]


def _closed(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.vstack([xy, xy[:1]])


def _middle(item: Any) -> tuple[float, float] | None:
    """Return where an item's number belongs."""
    at = place(item)
    if at is not None:
        return at
    mask = item if isinstance(item, Mask) else view(item, Mask)
    if mask is not None and mask.values.any():
        rows, columns = np.nonzero(mask.values)
        return float(mask.x_cm[columns].mean()), float(mask.y_cm[rows].mean())
    image = item if isinstance(item, Image) else view(item, Image)
    if image is not None:
        return float(image.x_cm.mean()), float(image.y_cm.mean())
    return None


def _printed(value: Any) -> str:
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    if isinstance(value, float | np.floating):
        return f"{value:.4g}"
    text = str(value)
    return text if len(text) <= 28 else text[:27] + "…"
