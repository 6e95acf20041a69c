"""Paint a display list as SVG, in pixels of a picture of the pad."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.display import (
    Area,
    Cells,
    Cross,
    Dots,
    Heat,
    Label,
    Note,
    Outline,
    Record,
    Rim,
    printed,
)
from tactile_graph.draw.grid_png import heat_uri, mask_uri
from tactile_graph.wires import Circle, Image, Mask

SIDE = 200.0
FARTHEST = 1e5
LONGEST_NOTE = 60


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
        return np.clip(xy[np.isfinite(xy).all(axis=1)] * self.per_cm, -FARTHEST, FARTHEST)

    def grid(self, grid: Image | Mask, uri: str) -> str:
        """Return the element of a grid's PNG where it lies."""
        left, right, bottom, top = grid.extent_cm
        (x0, y0), (x1, y1) = self.at(np.array([[left, top], [right, bottom]])).tolist()
        return (
            f'<image x="{_px(x0)}" y="{_px(y0)}" width="{_px(x1 - x0)}" height="{_px(y1 - y0)}" '
            f'href="{uri}" preserveAspectRatio="none"/>'
        )


class SvgPicture:
    """What a display list shows: grids beneath, lines over them, words below.

    The lines carry the classes ``rim`` (a light edge) and ``ink``, dots ``dots`` and words
    ``word`` as well, and areas ``area``: the page that shows them gives them their colours, as
    what was found or what is true.

    Parameters
    ----------
    view : View
    records : sequence of Record
    low, high : float
        Range of the heat maps.

    Attributes
    ----------
    grids, lines : list of str
        SVG elements.
    notes : list of str
        Words, not escaped.
    """

    def __init__(
        self, view: View, records: Sequence[Record], low: float = 0.0, high: float = 1.0
    ) -> None:
        self.view = view
        self.grids: list[str] = []
        self.lines: list[str] = []
        self.notes: list[str] = []
        for record in records:
            if isinstance(record, Heat):
                self.grids.append(view.grid(record.image, heat_uri(record.image, low, high)))
            elif isinstance(record, Cells):
                self.grids.append(view.grid(record.mask, mask_uri(record.mask)))
            elif isinstance(record, Note):
                told = printed(record.value, LONGEST_NOTE)
                self.notes.append(f"{record.name} {told}".strip())
            else:
                self._line(record)

    def _line(self, record: Record) -> None:
        if isinstance(record, Rim):
            ends = self.view.at(record.edges_cm).reshape(-1, 4).tolist()
            self._path("".join(f"M{a:.0f} {b:.0f}L{c:.0f} {d:.0f}" for a, b, c, d in ends))
        elif isinstance(record, Dots):
            at = self.view.at(record.xy_cm).tolist()
            self._path("".join(f"M{x:.1f} {y:.1f}h0" for x, y in at), ("rim dots", "ink dots"))
        elif isinstance(record, Outline) and record.circle is not None:
            self._circle(record.circle)
        elif isinstance(record, Outline):
            self._path(_through(self.view.at(record.xy_cm), record.closed))
        elif isinstance(record, Area):
            self._path(_through(self.view.at(record.xy_cm), closed=True), ("area",))
        elif isinstance(record, Label):
            for x, y in self.view.at(np.array([record.x_cm, record.y_cm])).tolist():
                self._word(x, y, record.text)
        elif isinstance(record, Cross):
            for x, y in self.view.at(np.array([record.x_cm, record.y_cm])).tolist():
                self._path(f"M{x - 6:.1f} {y:.1f}h12M{x:.1f} {y - 6:.1f}v12")

    def _circle(self, circle: Circle) -> None:
        radius = circle.radius_cm * self.view.per_cm
        middle = self.view.at(np.array([circle.x_cm, circle.y_cm])).tolist()
        for x, y in middle if np.isfinite(radius) else []:
            r = float(min(abs(radius), FARTHEST))
            for under in ("rim", "ink"):
                self.lines.append(
                    f'<circle cx="{_px(x)}" cy="{_px(y)}" r="{_px(r)}" class="{under}"></circle>'
                )

    def _path(self, path: str, classes: tuple[str, ...] = ("rim", "ink")) -> None:
        for name in classes if path else ():
            self.lines.append(f'<path d="{path}" class="{name}"></path>')

    def _word(self, x: float, y: float, text: str) -> None:
        for under in ("rim", "ink"):
            self.lines.append(
                f'<text x="{_px(x)}" y="{_px(y)}" class="{under} word">{escape(text)}</text>'
            )


def _through(xy: NDArray[np.float64], closed: bool) -> str:
    told = "L".join(f"{x:.1f} {y:.1f}" for x, y in xy.tolist())
    return f"M{told}{'Z' if closed else ''}" if told else ""


def _px(value: float) -> str:
    """Return a length in pixels, short."""
    told = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if told == "-0" else told
