"""Draw a node's value as SVG, in pixels of a picture of the pad."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.columns import place, view
from tactile_graph.draw.picture import cell_edges
from tactile_graph.inspect import Done, Failed, Skipped, scalars
from tactile_graph.wires import Circle, Image, Mask, Points
from tactile_graph_compare.report.grid_png import (
    HEAT,
    PALE,
    TWO_WAYS,
    YES_NO,
    data_uri,
    levels,
)
from tactile_graph_compare.report.markup import Html, tag

SIDE = 200.0
MOST_NOTES = 4
_PLAIN = (bool, int, float, str, np.generic)


@dataclass(frozen=True)
class View:
    """Where centimetres of the pad lie in a picture, whose longer side is `SIDE`."""

    left_cm: float
    top_cm: float
    per_cm: float
    width: float
    height: float

    @classmethod
    def of(cls, image: Image) -> View:
        """Return the view of all that an image covers."""
        left, right, bottom, top = image.extent_cm
        wide, high = max(right - left, 1e-9), max(bottom - top, 1e-9)
        per_cm = SIDE / max(wide, high)
        return cls(left, top, per_cm, wide * per_cm, high * per_cm)

    def at(self, xy_cm: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return places in pixels, shape (n, 2), without those that are nowhere."""
        xy = np.asarray(xy_cm, dtype=np.float64).reshape(-1, 2) - (self.left_cm, self.top_cm)
        return np.clip(xy[np.isfinite(xy).all(axis=1)] * self.per_cm, -1e5, 1e5)

    def grid(self, grid: Image | Mask, uri: str) -> Html:
        """Return a grid's PNG where it lies."""
        left, right, bottom, top = grid.extent_cm
        (x0, y0), (x1, y1) = self.at(np.array([[left, top], [right, bottom]])).tolist()
        return tag("image", x=x0, y=y0, width=x1 - x0, height=y1 - y0, href=uri,
                   preserveAspectRatio="none")  # fmt: skip


class Drawing:
    """What is drawn of one value: grids beneath, lines over them, words below.

    Parameters
    ----------
    view : View
    low, high : float
        Range of the heat map.
    """

    def __init__(self, view: View, low: float = 0.0, high: float = 1.0) -> None:
        self.view = view
        self.range = (low, high)
        self.grids: list[Html] = []
        self.lines: list[Html] = []
        self.notes: list[str] = []

    def draw(self, value: Any, alone: bool = True) -> None:
        """Add a value, whatever its kind; what has no place on the pad becomes a note."""
        if isinstance(value, Image):
            self.grids.append(self.view.grid(value, heat_uri(value, *self.range)))
        elif isinstance(value, Mask):
            self._mask(value, alone)
        elif isinstance(value, Points):
            self._points(value.xy_cm)
        elif hasattr(value, "outline_cm"):
            self._outline(value)
        elif hasattr(value, "_fields"):
            self._fields(value)
        elif isinstance(value, list | tuple):
            self._items(value)
        else:
            self._other(value)

    # -- kinds of values ---------------------------------------------------------------------

    def _mask(self, mask: Mask, alone: bool) -> None:
        if alone and not self.grids:
            self.grids.append(self.view.grid(mask, mask_uri(mask)))
            return
        ends = self.view.at(np.array(cell_edges(mask), dtype=np.float64).reshape(-1, 2))
        pairs = ends.reshape(-1, 4).tolist()
        self._path("".join(f"M{a:.0f} {b:.0f}L{c:.0f} {d:.0f}" for a, b, c, d in pairs))

    def _points(self, xy_cm: NDArray[np.float64]) -> None:
        dots = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in self.view.at(xy_cm).tolist())
        self._path(dots, "dots")

    def _outline(self, value: Any) -> None:
        if isinstance(value, Circle):
            middle = self.view.at(np.array([value.x_cm, value.y_cm]))
            radius = value.radius_cm * self.view.per_cm
            if len(middle) and np.isfinite(radius):
                x, y = middle[0].tolist()
                for kind in ("rim", "ink"):
                    self.lines.append(
                        tag("circle", cx=x, cy=y, r=float(min(abs(radius), 1e5)), class_=kind)
                    )
        else:
            self._path(_closed(self.view.at(value.outline_cm())))
        self._cross(value)

    def _cross(self, value: Any) -> bool:
        where = place(value)
        for x, y in [] if where is None else self.view.at(np.array(where)).tolist():
            self._path(f"M{x - 6:.1f} {y:.1f}h12M{x:.1f} {y - 6:.1f}v12")
        return where is not None

    def _fields(self, value: Any) -> None:
        marked = self._cross(value)
        for name, field in zip(value._fields, value, strict=True):
            told = marked and name in ("x_cm", "y_cm")
            if told or field is None or isinstance(field, Skipped | Failed | Done):
                continue
            if isinstance(field, _PLAIN):
                self.notes.append(f"{name} {printed(field)}")
            else:
                self.draw(field, alone=not self.grids)

    def _items(self, items: Any) -> None:
        if not items:
            self.notes.append("none")
        for item in items:
            if isinstance(item, _PLAIN):
                self.notes.append(printed(item))
            else:
                self.draw(item, alone=False)

    def _other(self, value: Any) -> None:
        for kind in (Mask, Points, Image):
            seen = view(value, kind)
            if seen is not None:
                self.draw(seen, alone=False)
                return
        self._cross(value)
        found = scalars("", value) or {"": value}
        self.notes += [f"{k.lstrip('.')} {printed(v)}".strip() for k, v in found.items()]

    def _path(self, path: str, kind: str = "") -> None:
        if path:
            for under in ("rim", "ink"):
                self.lines.append(tag("path", d=path, class_=f"{under} {kind}".strip()))


def _closed(xy: NDArray[np.float64]) -> str:
    told = "L".join(f"{x:.1f} {y:.1f}" for x, y in xy.tolist())
    return f"M{told}Z" if told else ""


def printed(value: Any) -> str:
    """Return a bare value, short."""
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    if isinstance(value, float | np.floating):
        return f"{value:.4g}"
    told = str(value)
    return told if len(told) <= 60 else told[:59] + "…"


# -- grids ---------------------------------------------------------------------------------------


def heat_uri(image: Image, low: float, high: float) -> str:
    """Return an image in colours from ``low`` to ``high``."""
    return data_uri(levels(image.values, low, high, image.valid), HEAT)


def pale_uri(image: Image) -> str:
    """Return an image in pale grey, to lie beneath lines; light touches still show."""
    values = np.sqrt(np.maximum(image.filled(0.0), 0.0))
    high = float(values.max()) if values.size else 1.0
    return data_uri(levels(values, 0.0, high, image.valid), PALE)


def mask_uri(mask: Mask) -> str:
    """Return a mask in dark and light."""
    return data_uri(mask.values.astype(np.uint8), YES_NO)


def change_uri(values: NDArray[np.float64]) -> str:
    """Return differences: blue where less, orange where more, pale where the same."""
    finite = values[np.isfinite(values)]
    most = float(np.abs(finite).max()) if finite.size else 0.0
    return data_uri(levels(values, -(most or 1.0), most or 1.0), TWO_WAYS)
