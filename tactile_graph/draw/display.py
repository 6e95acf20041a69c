"""The display list: what drawing a value shows on the pad, made once, painted in several ways.

`display_list` is the one place that knows the kinds of values. What comes out are plain records
in cm from the pad's top left corner, x right, y down; `paint_strip` puts them into matplotlib
axes, `paint_svg` into SVG.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tactile_graph.engine.outcomes.outcome import Done, Failed, Skipped, outcome_word, raised_at
from tactile_graph.engine.tables.rows import scalars
from tactile_graph.errors import PluginError, shown, text_of
from tactile_graph.wires import Circle, Frame, Image, Mask, Points, TrueObject

Role = Literal["found", "true"]
MOST_NUMBERED = 20
"""Items of a list that are numbered, at most."""
_SCALAR = (bool, int, float, str, np.generic)


@dataclass(frozen=True)
class Heat:
    """An image, its values as colours."""

    image: Image


@dataclass(frozen=True)
class Cells:
    """A mask, its cells dark where they are on."""

    mask: Mask


@dataclass(frozen=True)
class Rim:
    """The edges between the cells of a mask that are on and all others.

    ``edges_cm`` has the shape (edges, 2 ends, 2).
    """

    edges_cm: NDArray[np.float64]
    role: Role = "found"


@dataclass(frozen=True)
class Dots:
    """Points; ``xy_cm`` has the shape (points, 2)."""

    xy_cm: NDArray[np.float64]
    role: Role = "found"


@dataclass(frozen=True)
class Outline:
    """A line through ``xy_cm``, shape (corners, 2), closed unless told: the first not repeated.

    Where it is a circle, ``circle`` is it, for who can draw one exactly.
    """

    xy_cm: NDArray[np.float64]
    circle: Circle | None = None
    role: Role = "found"
    closed: bool = True

    @property
    def drawn_cm(self) -> NDArray[np.float64]:
        """The corners a pen goes to; of a closed line the first again in the end."""
        return np.vstack([self.xy_cm, self.xy_cm[:1]]) if self.closed else self.xy_cm


@dataclass(frozen=True)
class Cross:
    """A mark at a place."""

    x_cm: float
    y_cm: float
    role: Role = "found"


@dataclass(frozen=True)
class Number:
    """The number of a list's item, where it lies."""

    x_cm: float
    y_cm: float
    text: str


@dataclass(frozen=True)
class Note:
    """A value without a place on the pad; ``name`` is its field's, ``a.b`` where nested."""

    name: str
    value: Any


@dataclass(frozen=True)
class Area:
    """What a closed line encloses, filled so that what lies beneath still shows.

    ``xy_cm`` has the shape (corners, 2).
    """

    xy_cm: NDArray[np.float64]
    role: Role = "found"


@dataclass(frozen=True)
class Label:
    """A word at a place, its middle there."""

    x_cm: float
    y_cm: float
    text: str
    role: Role = "found"


Record = Heat | Cells | Rim | Dots | Outline | Area | Cross | Label | Number | Note
Drawn = Rim | Dots | Outline | Area | Cross | Label | Note
"""What a value may draw of itself."""


def display_list(value: Any, role: Role = "found") -> list[Record]:
    """Return what drawing a value shows, in the order of drawing; empty for an outcome without one.

    Parameters
    ----------
    value : object
        A record of the wires, a plugin's own with a ``drawing()`` (records of this module), an
        ``outline_cm()`` (open where its ``outline_closed`` is false), a view (``provides``) or a
        place (``x_cm``, ``y_cm``); lists and NamedTuples of these; numbers and texts.
    role : str
        Whether it was found or is true.

    Raises
    ------
    PluginError
        If what a value draws of itself is no such record.
    """
    listing = _Listing(role)
    listing.add(value, alone=True)
    return listing.records


def truth_list(objects: Iterable[TrueObject]) -> list[Record]:
    """Return what drawing the true objects of a frame shows: lines, which lie over all the rest."""
    records = (record for thing in objects for record in display_list(thing.shape, "true"))
    return [record for record in records if not isinstance(record, Area | Label)]


def is_picture(value: Any) -> bool:
    """Return whether a value has a place on the pad, as against a bare number."""
    return any(not isinstance(r, Note) for r in display_list(value))


def images_in(value: Any) -> list[Image]:
    """Return the images that drawing a value shows as heat maps."""
    return [r.image for r in display_list(value) if isinstance(r, Heat)]


class _Listing:
    def __init__(self, role: Role) -> None:
        self.role: Role = role
        self.records: list[Record] = []

    def add(self, value: Any, alone: bool) -> None:
        """Add a value of any kind; a mask that does not stand alone shows as its rim."""
        if isinstance(value, Frame):
            self.records.append(Heat(value.image))
        elif isinstance(value, Image):
            self.records.append(Heat(value))
        elif isinstance(value, Mask):
            self.records.append(Cells(value) if alone else Rim(cell_edges(value), self.role))
        elif isinstance(value, Points):
            self.records.append(Dots(value.xy_cm, self.role))
        elif draws_itself(value):
            self._drawing(value)
        elif hasattr(value, "outline_cm"):
            self._outline(value)
        elif hasattr(value, "_fields"):
            self._fields(value)
        elif isinstance(value, list | tuple):
            self._items(value)
        else:
            self._other(value, alone)

    def _drawing(self, value: Any) -> None:
        for record in _asked(value, "drawing", lambda: [*value.drawing()]):
            if not isinstance(record, Drawn):
                who = f"{type(value).__name__}.drawing()"
                raise PluginError(f"{who} must give records to draw, got {shown(record)}")
            if not isinstance(record, Note):
                record = replace(record, role=self.role)
            self.records.append(record)

    def _outline(self, value: Any) -> None:
        with np.errstate(invalid="ignore"):  # of a shape that is nowhere
            xy_cm = _corners(value, _asked(value, "outline_cm", value.outline_cm))
        circle = value if isinstance(value, Circle) else None
        closed = bool(getattr(value, "outline_closed", True))
        self.records.append(Outline(xy_cm, circle, self.role, closed))
        self._cross(value)

    def _cross(self, value: Any) -> bool:
        """Mark the place a record names, if it names one."""
        at = place(value)
        if at is not None:
            self.records.append(Cross(*at, self.role))
        return at is not None

    def _fields(self, value: Any) -> None:
        marked = self._cross(value)
        for name, field in zip(value._fields, value, strict=True):
            told = marked and name in ("x_cm", "y_cm")
            if told or field is None or isinstance(field, Skipped | Failed | Done):
                continue
            if isinstance(field, _SCALAR):
                self.records.append(Note(name, field))
            else:
                self.add(field, alone=all(isinstance(r, Note) for r in self.records))

    def _items(self, items: Sequence[Any]) -> None:
        if not items:
            self.records.append(Note("", "none"))
        for number, item in enumerate(items, 1):
            if isinstance(item, Skipped | Failed):
                self.records.append(Note(f"{number}", outcome_word(item)))
                continue
            self.add(item, alone=False)
            numbered = 1 < len(items) <= MOST_NUMBERED and not draws_itself(item)
            at = _middle(item) if numbered else None
            if at is not None:
                self.records.append(Number(*at, str(getattr(item, "number", number))))

    def _other(self, value: Any, alone: bool) -> None:
        for kind in (Mask, Points, Image):
            seen = view(value, kind)
            if seen is not None:
                self.add(seen, alone=False)
                return
        if self._cross(value) and not alone:
            return  # where it is says enough of one of several
        found = scalars("", value) or {"": value}
        self.records += [Note(name.lstrip("."), v) for name, v in found.items()]


def _asked(value: Any, method: str, ask: Callable[[], Any]) -> Any:
    """Return what a record's own method gives to draw."""
    try:
        return ask()
    except Exception as error:  # a plugin's own code may raise anything
        told = f"{type(error).__name__}: {text_of(error)}"
        raise PluginError(
            f"{type(value).__name__}.{method}() breaks: {told} ({raised_at(error)})"
        ) from error


def _corners(value: Any, told: Any) -> NDArray[np.float64]:
    """Return the corners of an outline, (corners, 2), from what a record says they are."""
    try:
        xy_cm = np.asarray(told, dtype=np.float64)
        if xy_cm.ndim < 2 or xy_cm.shape[-1] == 2:
            return xy_cm.reshape(-1, 2)
        got = f"an array of shape {xy_cm.shape}"
    except (TypeError, ValueError):
        got = shown(told)
    who = f"{type(value).__name__}.outline_cm()"
    raise PluginError(f"{who} must give corners, an array of shape (corners, 2), got {got}")


@contextmanager
def drawn_of(name: str) -> Iterator[None]:
    """Name the node in what is wrong with how its value draws itself."""
    try:
        yield
    except PluginError as error:
        raise PluginError(f"node {name!r}: {error}") from error


def draws_itself(value: Any) -> bool:
    """Return whether a value says by ``drawing()`` what it looks like."""
    return callable(getattr(type(value), "drawing", None))


def place(value: Any) -> tuple[float, float] | None:
    """Return the place on the pad that a record names as ``x_cm`` and ``y_cm``, or None."""
    x, y = getattr(value, "x_cm", None), getattr(value, "y_cm", None)
    numbers = isinstance(x, int | float) and isinstance(y, int | float)
    return (float(x), float(y)) if numbers else None  # type: ignore[arg-type]


def view(value: Any, kind: type) -> Any:
    """Return a record's own view as ``kind`` (``provides``), or None."""
    name = getattr(value, "provides", {}).get(kind)
    return getattr(value, name) if name else None


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


def cell_edges(mask: Mask) -> NDArray[np.float64]:
    """Return the edges between cells that are on and cells that are not, (edges, 2 ends, 2)."""
    padded = np.pad(mask.values, 1)
    rows, columns = np.nonzero(padded[:, 1:] != padded[:, :-1])
    upright = np.stack([np.stack([columns, rows - 1], 1), np.stack([columns, rows], 1)], 1)
    rows, columns = np.nonzero(padded[1:] != padded[:-1])
    level = np.stack([np.stack([columns - 1, rows], 1), np.stack([columns, rows], 1)], 1)
    corners = np.concatenate([upright, level])
    return np.asarray(np.array(mask.origin_cm) + corners * np.array(mask.pitch_cm))


def printed(value: Any, longest: int) -> str:
    """Return a bare value, short."""
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    if isinstance(value, float | np.floating):
        return f"{value:.4g}"
    text = str(value)
    return text if len(text) <= longest else text[: longest - 1] + "…"
