"""Paint a display list onto matplotlib axes in cm, and say why there is nothing to paint."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from tactile_graph.draw.colours import FAILED, FOUND, MASK_OFF, MASK_ON, SKIPPED, TRUE
from tactile_graph.draw.display import (
    Area,
    Cells,
    Cross,
    Dots,
    Heat,
    Label,
    Note,
    Number,
    Outline,
    Record,
    Rim,
    display_list,
    printed,
    truth_list,
)
from tactile_graph.draw.strip_columns import Column
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.wires import Frame, Image, Mask, TrueObject

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage
    from matplotlib.patheffects import AbstractPathEffect

DASHES = (4.0, 2.5)
HEAT = "viridis"
FILLED = 0.3
"""How much of an area's colour covers what lies beneath."""
MOST_NOTES, MOST_ALIKE = 8, 2
"""Lines of notes, and objects beyond which their notes would cover them, and none knows whose."""
LONGEST_NOTE = 28
LINE_IN, LETTERS_AN_INCH = 0.125, 15.0
"""Of notes: the height of a line, and how many letters surely stand side by side."""


class Pen:
    """Paints values into one axes; over the frame's image where a value has no cells of its own.

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

    def draw(self, value: Any) -> None:
        """Paint a node's outcome, and why there is none where it has none."""
        if isinstance(value, Skipped | Failed):
            self._say(value)
            return
        records = display_list(value)
        self.paint(records)
        notes = [self._told(r) for r in told_once(records)]
        if self._lies_outside():
            notes.append("outside the picture")
        if notes:
            self._note("\n".join(self._fitting(notes[:MOST_NOTES])))

    def truth(self, objects: Sequence[TrueObject]) -> None:
        """Paint the outlines of what truly lay there, dashed."""
        self.paint(r for r in truth_list(objects) if isinstance(r, Outline))

    # -- the records of a display list ---------------------------------------------------------

    def paint(self, records: Iterable[Record]) -> None:
        """Paint records over one another, in their order."""
        for record in records:
            if isinstance(record, Heat):
                self._heat(record.image)
            elif isinstance(record, Cells):
                self._cells(record.mask)
            elif isinstance(record, Number):
                self._word(record.x_cm, record.y_cm, record.text, FOUND)
            elif not isinstance(record, Note):
                self._ground()
                self._line(record)
                self.drawn.add(record.role)

    def _line(self, record: Rim | Dots | Outline | Area | Cross | Label) -> None:
        if isinstance(record, Rim):
            self._rim(record)
        elif isinstance(record, Dots):
            size = 3.5 if len(record.xy_cm) <= 200 else 2.0
            x, y = record.xy_cm[:, 0], record.xy_cm[:, 1]
            self.axes.plot(x, y, "o", color=FOUND, ms=size, mec="white", mew=0.3, zorder=4)
        elif isinstance(record, Outline):
            self._outline(record)
        elif isinstance(record, Area):
            x, y = record.xy_cm[:, 0], record.xy_cm[:, 1]
            self.axes.fill(x, y, color=_colour(record), alpha=FILLED, lw=0, zorder=3)
        elif isinstance(record, Label):
            self._word(record.x_cm, record.y_cm, record.text, _colour(record))
        else:
            at = [record.x_cm], [record.y_cm]
            self.axes.plot(*at, "+", color=FOUND, ms=6, mew=1.3, zorder=4)

    def _heat(self, image: Image) -> None:
        shown = (
            image.values if image.valid is None else np.ma.array(image.values, mask=~image.valid)
        )
        self.heat = self.axes.imshow(
            shown, HEAT, vmin=self.column.low, vmax=self.column.high,
            extent=image.extent_cm, interpolation="nearest", zorder=1,
        )  # fmt: skip

    def _cells(self, mask: Mask) -> None:
        from matplotlib.colors import ListedColormap

        self.axes.imshow(
            mask.values, ListedColormap([MASK_OFF, MASK_ON]), vmin=0, vmax=1,
            extent=mask.extent_cm, interpolation="nearest", zorder=1,
        )  # fmt: skip

    def _rim(self, rim: Rim) -> None:
        from matplotlib.collections import LineCollection

        edges = LineCollection(list(rim.edges_cm), colors=FOUND, linewidths=1.5, zorder=4)
        self.axes.add_collection(edges, autolim=False)

    def _outline(self, outline: Outline) -> None:
        xy = outline.drawn_cm
        if outline.role == "true":
            self.axes.plot(
                xy[:, 0], xy[:, 1], color=TRUE, lw=1.4, dashes=DASHES, zorder=5,
                path_effects=_halo(1.4),
            )  # fmt: skip
        else:
            self.axes.plot(
                xy[:, 0], xy[:, 1], color=FOUND, lw=1.7, zorder=4, path_effects=_halo(1.7)
            )

    def _word(self, x_cm: float, y_cm: float, text: str, colour: str) -> None:
        self.axes.annotate(
            text, (x_cm, y_cm), ha="center", va="center", fontsize=7, color="white", zorder=6,
            annotation_clip=True, parse_math=False,
            bbox={"boxstyle": "round,pad=0.15", "fc": colour, "ec": "none"},
        )  # fmt: skip

    def _told(self, note: Note) -> str:
        """Return a note as it is written; a column of a field needs no more than its last name."""
        name = note.name.rpartition(".")[2]
        return f"{name} {printed(note.value, LONGEST_NOTE)}".strip()

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

    def _lies_outside(self) -> bool:
        """Return whether all that was found lies off the pad: it is said, not shown as nothing."""
        lines = [np.asarray(line.get_xydata()) for line in self.axes.lines]
        points = np.concatenate([p for p in lines if p.size] or [np.empty((0, 2))])
        if not len(points) or "found" not in self.drawn:
            return False
        (x0, x1), (y1, y0) = self.axes.get_xlim(), self.axes.get_ylim()
        x, y = points[:, 0], points[:, 1]
        return not ((x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)).any()

    def _fitting(self, notes: list[str]) -> list[str]:
        """Return notes as lines that a picture has room for: side by side in a low, wide one."""
        box, dpi = self.axes.bbox, self.axes.figure.dpi
        most = max(int(box.height / dpi / LINE_IN), 1)
        if len(notes) <= most:
            return notes
        kept_whole = "  ".join(note.replace(" ", "\xa0") for note in notes)
        lines = wrap(kept_whole, max(int(box.width / dpi * LETTERS_AN_INCH), 10))
        lines = lines if len(lines) <= most else [*lines[: most - 1], f"{lines[most - 1]} …"]
        return [line.replace("\xa0", " ") for line in lines]

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


def told_once(records: Iterable[Record]) -> list[Note]:
    """Return the notes but for those that each of more than a few objects has."""
    notes = [r for r in records if isinstance(r, Note)]
    times = Counter(note.name for note in notes)
    return [note for note in notes if times[note.name] <= MOST_ALIKE]


def _colour(record: Area | Label) -> str:
    return TRUE if record.role == "true" else FOUND


def _halo(width: float) -> list[AbstractPathEffect]:
    """Return a white edge around a line, which keeps it legible over any cell."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=width + 1.3, foreground="white")]
