"""A film of a run: a picture a frame, the readings as colours and what was found drawn over them.

Colours mean the same in all pictures, which takes the last frame to know. So what is to be drawn
goes to a file without a name while frames come, and is painted from there, one picture at a time.
"""

from __future__ import annotations

import os
import pickle
import tempfile
import weakref
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from tactile_graph.draw.colours import FOUND, TRUE
from tactile_graph.draw.display import (
    Heat,
    Note,
    Outline,
    Record,
    display_list,
    drawn_of,
    printed,
    truth_list,
)
from tactile_graph.draw.film_files import RATE_HZ, FilmFile, Gif, Mp4, Picture
from tactile_graph.draw.paint_strip import DASHES, Pen
from tactile_graph.draw.strip import make_visible
from tactile_graph.draw.strip_columns import Column
from tactile_graph.engine.outcomes.outcome import NO_VALUE, outcome_word
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.files import said, uninterrupted
from tactile_graph.part_files import part_of, put_in_place, remove
from tactile_graph.wires import Frame

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_PICTURES = 1500
LONGEST_S = 1.0
UNTIMED_S = 0.1
"""How long a picture is shown where frames have no times."""
MOST_NOTES, LONGEST_NOTE = 4, 60
_LONG_IN, _SHORT_IN, _DPI = 4.2, 1.2, 100
_LEFT_IN, _RIGHT_IN, _TOP_IN, _BOTTOM_IN = 0.6, 1.0, 0.75, 0.95


@dataclass(frozen=True)
class _Scene:
    """What one picture shows, and until when it did."""

    frame: Frame
    records: tuple[Record, ...]
    notes: tuple[str, ...]
    truth: tuple[Record, ...]


class Film:
    """A film under way: add results, then write it.

    Parameters
    ----------
    name : str
        What stands above every picture.
    asked : sequence of str
        The outputs that are drawn.

    Attributes
    ----------
    n : int
        Pictures so far.
    full : bool
        Whether frames were left out for want of room: a film has `MOST_PICTURES` at most.
    shortened : bool
        Whether a pause was longer than `LONGEST_S`, and is shown as that.
    n_painted : int
        Pictures that are painted.
    written : bool
        Whether there is a film of these.
    """

    def __init__(self, name: str, asked: Sequence[str]) -> None:
        self.n = 0
        self.n_painted = 0
        self.full = self.shortened = self.written = False
        self._name = name
        self._asked = tuple(asked)
        self._spool: BinaryIO = tempfile.TemporaryFile()  # noqa: SIM115 -- lives as long as this
        weakref.finalize(self, self._spool.close)
        self._low, self._high = 0.0, -np.inf
        self._quantity = ""
        self._true = False
        self._last_s: float | None = None
        self._times: list[float | None] = []

    def add(self, result: Outcomes) -> None:
        """Take in a frame, unless it comes sooner after the last than films show pictures."""
        frame = result.frame
        soon = None not in (frame.time_s, self._last_s) and (
            0.0 <= (frame.time_s or 0.0) - (self._last_s or 0.0) < 0.999 / RATE_HZ
        )
        if soon or self.n >= MOST_PICTURES:
            self.full = self.full or not soon
            return
        self._last_s = frame.time_s
        image = frame.image
        known = image.values if image.valid is None else image.values[image.valid]
        if known.size:
            self._low = min(self._low, float(known.min()))
            self._high = max(self._high, float(known.max()))
        self._quantity = image.quantity
        self._times.append(frame.time_s)
        self._true |= bool(frame.truth)
        pickle.dump(self._scene(result), self._spool)
        self.n += 1

    def _scene(self, result: Outcomes) -> _Scene:
        drawn: list[Record] = []
        notes = []
        for name in self._asked:
            outcome = result.outcome(name)
            if outcome.__class__ in NO_VALUE:
                notes.append(_cut(f"{name} {outcome_word(outcome)}"))
                continue
            with drawn_of(name):
                records = display_list([outcome])
            for record in records:
                if isinstance(record, Note):
                    notes.append(_cut(f"{name} {record.name} {printed(record.value, 30)}"))
                elif not isinstance(record, Heat):
                    drawn.append(_plain(record))
        truth = [_plain(r) for r in truth_list(result.frame.truth or ())]
        frame = replace(result.frame, truth=None)
        return _Scene(frame, tuple(drawn), tuple(notes[:MOST_NOTES]), tuple(truth))

    def write(
        self, path: str | os.PathLike[str], progress: Callable[[int, int], None] | None = None
    ) -> None:
        """Paint the pictures, one at least, and write them as ``.gif`` or ``.mp4``, whole or not.

        A first Ctrl-C, or a signal that ends programs, ends the film with the picture in hand, and
        is raised when the film is there; a second one leaves nothing.

        Parameters
        ----------
        path : path
        progress : callable, optional
            Told after each picture how many of how many are painted.

        Raises
        ------
        UsageError
            If it cannot be written.
        """
        painter = _Painter(self._name, self._column(), self._true)
        made = Mp4 if Path(path).suffix.lower() == ".mp4" else Gif
        self._spool.seek(0)
        with uninterrupted(once=True) as waiting:
            with _part(Path(path)) as part, ExitStack() as end:
                film: FilmFile | None = None
                for i, shown_s in enumerate(self._seconds(), 1):
                    picture = painter.picture(pickle.load(self._spool))
                    if film is None:
                        film = end.enter_context(made(part, picture.shape[:2]))
                    film.add(picture, shown_s)
                    self.n_painted = i
                    if progress is not None:
                        progress(i, self.n)
                    if waiting:
                        break
                end.close()  # before it gets its name
            self.written = True

    def _column(self) -> Column:
        high = self._high if self._high > self._low else self._low + 1.0
        return Column("frame", "", self._low, high, self._quantity)

    def _seconds(self) -> list[float]:
        """Return how long each picture is shown; the last as long as the one before."""
        found = []
        for a, b in zip(self._times, self._times[1:], strict=False):
            gap = UNTIMED_S if a is None or b is None or b <= a else b - a
            self.shortened |= gap > LONGEST_S
            found.append(min(gap, LONGEST_S))
        return [*found, found[-1] if found else UNTIMED_S]

    @property
    def timed(self) -> bool:
        """Whether all pictures have times."""
        return None not in self._times


def _cut(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= LONGEST_NOTE else text[: LONGEST_NOTE - 1] + "…"


def _plain(record: Record) -> Record:
    """Return a record that another process could read: without what a plugin made of a circle."""
    return replace(record, circle=None) if isinstance(record, Outline) else record


@contextmanager
def _part(path: Path) -> Iterator[Path]:
    """Give a name beside the file, which gets its own at the end; nothing is left otherwise."""
    target = Path(os.path.realpath(path))
    part = part_of(target)
    with said(path):
        try:
            yield part
            with part.open("rb+") as file:
                os.fsync(file.fileno())  # some discs tell only now that they are full
            put_in_place(part, target, path)
        finally:
            remove(part)


# -- the pictures --------------------------------------------------------------------------------


class _Painter:
    """Paints one scene after the other into one figure."""

    def __init__(self, name: str, column: Column, true: bool) -> None:
        self._name = name
        self._true = true
        self._column = column
        self._figure: Figure | None = None
        self._axes: Any = None

    def picture(self, scene: _Scene) -> Picture:
        """Return a scene as an RGB picture of even size, the same for all."""
        if self._figure is None:
            self._begin(scene.frame)
        assert self._figure is not None
        axes = self._axes
        for artist in (*axes.images, *axes.lines, *axes.collections, *axes.texts):
            artist.remove()
        pen = Pen(axes, scene.frame, self._column, self._column)
        pen.paint([Heat(scene.frame.image), *scene.records])
        pen.paint(r for r in scene.truth if isinstance(r, Outline))
        axes.set(xlim=self._x, ylim=self._y)
        if not self._barred:
            self._bar(pen.heat)
        self._title.set_text(_when(scene.frame))
        self._notes.set_text("\n".join(scene.notes))
        make_visible(self._figure)
        canvas: Any = self._figure.canvas
        canvas.draw()
        shown = np.asarray(canvas.buffer_rgba())[..., :3]
        return np.ascontiguousarray(shown[: shown.shape[0] // 2 * 2, : shown.shape[1] // 2 * 2])

    def _begin(self, frame: Frame) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        left, right, bottom, top = frame.image.extent_cm
        self._x, self._y = (left, right), (bottom, top)
        wide, high = right - left, bottom - top
        per_cm = _LONG_IN / max(wide, high)
        size = max(wide * per_cm, _SHORT_IN), max(high * per_cm, _SHORT_IN)
        width, height = size[0] + _LEFT_IN + _RIGHT_IN, size[1] + _TOP_IN + _BOTTOM_IN
        self._figure = figure = Figure((width, height), dpi=_DPI, facecolor="white")
        FigureCanvasAgg(figure)
        place = (_LEFT_IN / width, _BOTTOM_IN / height, size[0] / width, size[1] / height)
        self._axes = axes = figure.add_axes(place)
        axes.set(xlabel="x in cm", ylabel="y in cm")
        axes.tick_params(labelsize=8)
        self._bar_place = (
            (_LEFT_IN + size[0] + 0.15) / width, place[1], 0.12 / width, place[3],
        )  # fmt: skip
        self._barred = False
        above = 1 - 0.12 / height
        words: dict[str, Any] = {"va": "top", "parse_math": False}
        figure.text(0.12 / width, above, self._name, fontsize=11, fontweight="bold", **words)
        self._title = figure.text(
            0.12 / width, 1 - 0.42 / height, "", fontsize=9, color="#444444", **words
        )
        self._notes = figure.text(0.12 / width, 0.06 / height, "", fontsize=7, va="bottom",
                                  parse_math=False)  # fmt: skip
        self._legend(figure)

    def _legend(self, figure: Figure) -> None:
        from matplotlib.lines import Line2D

        handles = [Line2D([], [], color=FOUND, lw=1.7, label="found")]
        if self._true:
            handles.append(Line2D([], [], color=TRUE, lw=1.4, dashes=DASHES, label="true"))
        figure.legend(handles=handles, loc="upper right", fontsize=8, frameon=False,
                      borderaxespad=0.2, handlelength=2.4)  # fmt: skip

    def _bar(self, heat: Any) -> None:
        assert self._figure is not None
        bar = self._figure.colorbar(heat, cax=self._figure.add_axes(self._bar_place))
        bar.ax.tick_params(labelsize=8)
        bar.set_label(self._column.scale, fontsize=8)
        self._barred = True


def _when(frame: Frame) -> str:
    time = "" if frame.time_s is None else f", {frame.time_s:.2f} s"
    return f"frame {frame.index}{time}" + (f", {frame.label}" if frame.label else "")
