"""A store as it lies on disc: which frames it holds, what vouches for them, and what is damaged."""

from __future__ import annotations

import json
import stat
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph.wires.stacks import ImageStack
from tactile_graph_sources.readers.words.truth import truth_from_json
from tactile_graph_sources.stores.journal import (
    Block,
    Columns,
    Journal,
    crc_of,
    read_journal,
    uncovered,
)
from tactile_graph_sources.stores.layout import (
    COLUMNS,
    JOURNAL,
    JOURNALED,
    METADATA,
    NOTES,
    PITCH_ASSUMED,
    Metadata,
    array_of,
    check_attributes,
    chunk_file,
    load_zarr,
    own_attributes,
    own_metadata,
    read_metadata,
    same_metadata,
    unfinished,
    written_rows,
)

LONGEST = 200
UNSURE = "nothing vouches for its grid and quantity any more: all its frames are doubtful"


class Lost(Exception):  # noqa: N818 -- what became of the frames
    """Frames that cannot be given, and which part of the store is to blame."""


class Piece(NamedTuple):
    """Frames that are read together; ``block`` is what the journal says of them, if it does."""

    low: int
    high: int
    block: Block | None

    @property
    def words(self) -> str:
        """Which frames they are."""
        if self.high - self.low == 1:
            return f"frame {self.low}"
        return f"frames {self.low} to {self.high - 1}"


class Session(NamedTuple):
    """Frames recorded in one go: the first of them, and when that came by the wall clock.

    ``started`` is ISO 8601 with the offset from UTC.
    """

    frame: int
    started: str


@dataclass(frozen=True)
class Stored:
    """A store, opened.

    Attributes
    ----------
    attributes : mapping
        Grid, quantity, and where the frames come from.
    metadata : mapping
        What each array is, by name.
    journaled : bool
        Whether a journal vouches for what is in it.
    sure : bool
        Whether the journal vouches for the attributes; what there is without one is as it is.
    troubles : tuple of str
        What is damaged of the journal and of the metadata.
    pieces : tuple of Piece
        All frames that count, in order.
    n_unnumbered : int
        How many came after them, of which nothing is left.
    """

    path: Path
    journal: Journal
    attributes: Mapping[str, Any]
    metadata: Mapping[str, Metadata]
    journaled: bool
    sure: bool
    troubles: tuple[str, ...]
    pieces: tuple[Piece, ...]
    n_unnumbered: int

    @property
    def n_frames(self) -> int:
        """How many frames it should hold."""
        return self.pieces[-1].high if self.pieces else 0

    @property
    def pitch_told(self) -> bool:
        """Whether somebody said the pitch."""
        return not self.attributes.get(PITCH_ASSUMED)

    @property
    def chunk(self) -> int:
        """Frames in a chunk of the values."""
        return chunk_of(self.path, self.metadata)

    @property
    def sessions(self) -> tuple[Session, ...]:
        """When it was recorded, as far as anybody knows; not when another file was converted."""
        first = self.attributes.get("started")
        known = isinstance(first, str) and "converted_from" not in self.attributes
        begun = [Session(0, str(first))] if known else []
        blocks = [p.block for p in self.pieces if p.block is not None]
        return *begun, *(Session(b.low, b.started) for b in blocks if b.started)

    def rows(self, name: str, low: int, high: int) -> Any:
        """Return rows of an array; raises Lost."""
        try:
            array = self._values if name == "values" else self._array(name, high)
            with np.errstate(invalid="ignore"):  # wrong metadata may make no number an integer
                rows = array[low:high]
        except Exception as error:  # a damaged chunk makes Zarr raise whatever its codec raises
            where = name if name == NOTES else self.chunk_file(name, low)
            raise Lost(f"{where} is damaged: {_short(error)}") from error
        return rows

    def chunk_file(self, name: str, row: int) -> str:
        """Return the file of the chunk that holds a row, as a path within the store."""
        array = self._values if name == "values" else self._array(name, row + 1)
        return chunk_file(array, name, row)

    @cached_property
    def _values(self) -> Any:
        return self._array("values", self.n_frames)

    def _array(self, name: str, n: int) -> Any:
        return array_of(self.path, name, self.metadata[name], n)

    def values(self, piece: Piece) -> NDArray[np.float64]:
        """Return a piece's values, (N, rows, columns).

        Raises
        ------
        Lost
            If they are not what was written, as far as anything tells.
        """
        if piece.block is not None and piece.block.lost:
            raise Lost(piece.block.lost)
        name = self.chunk_file("values", piece.low)
        try:
            there = stat.S_ISREG((self.path / name).stat().st_mode)
        except OSError:
            there = False
        if not there and (self.path / name).exists():
            raise Lost(f"{name} is no plain file")
        if not there and piece.block is None:  # Zarr gives NaN for it
            raise Lost(f"{name} is gone")
        values: NDArray[np.float64] = self.rows("values", piece.low, piece.high)
        if piece.block is not None and crc_of(values) != piece.block.crc:
            raise Lost(f"{name} is {'not what was written' if there else 'gone'}")
        return values

    def columns(self, piece: Piece) -> Columns:
        """Return all of a piece but its values, from the journal or else from the arrays."""
        if piece.block is None:
            return self.columns_of_arrays(piece.low, piece.high)
        try:
            return self.journal.columns(piece.block)
        except Exception as error:  # it was whole a moment ago
            raise Lost(f"journal: {_short(error)}") from error

    def columns_of_arrays(self, low: int, high: int) -> Columns:
        """Return what the arrays say of frames but the values; raises Lost."""
        if not np.array_equal(self.rows("number", low, high), np.arange(low, high)):
            raise Lost(f"{self.chunk_file('number', low)} does not number them")
        before = int(self.rows("notes_end", low - 1, low)[0]) if low else 0
        ends = [before, *self.rows("notes_end", low, high).tolist()]
        if ends != sorted(ends):
            raise Lost(f"{self.chunk_file('notes_end', low)} is not what was written")
        text = self.rows(NOTES, before, ends[-1]).tobytes() if ends[-1] > before else b""
        notes = [text[a - before : b - before] for a, b in pairwise(ends)]
        doubtful = "doubtful" in self.metadata
        return Columns(
            self.rows("time_s", low, high),
            self.rows("device_time_s", low, high),
            self.rows("gap", low, high),
            self.rows("doubtful", low, high) if doubtful else np.zeros(high - low, bool),
            tuple(notes),
        )

    def frames(self, piece: Piece, low: int = 0, high: int | None = None) -> list[Frame]:
        """Return a piece's frames; doubtful if the journal vouches not for them or the attributes.

        Parameters
        ----------
        piece : Piece
        low, high : int, optional
            Which of all frames, where not all of the piece's are wanted.

        Raises
        ------
        Lost
        """
        return self._frames(piece, (low, high), self.values(piece), self.columns(piece))

    def given(
        self, piece: Piece, low: int = 0, high: int | None = None
    ) -> Sequence[Frame | FrameStack]:
        """Return what `frames` does, as one stack where nothing is to be said of single ones."""
        values, columns = self.values(piece), self.columns(piece)
        if self._unsure(piece) or columns.say_more:
            return self._frames(piece, (low, high), values, columns)
        first, last = max(low, piece.low), min(piece.high if high is None else high, piece.high)
        part = slice(first - piece.low, last - piece.low)
        grid = (self._pair("pitch_cm"), self._pair("origin_cm"), str(self.attributes["quantity"]))
        times = None if np.isnan(columns.time_s).any() else columns.time_s[part]
        return [FrameStack(ImageStack(values[part], *grid), np.arange(first, last), times)]

    @property
    def _state_of(self) -> str | None:
        """Whose state steps go on with where no note says it: labels of a live page are remarks."""
        port = str(self.attributes.get("port", ""))
        return "" if "pipeline" in self.attributes and port.startswith("source ") else None

    def _unsure(self, piece: Piece) -> bool:
        return not self.sure or (self.journaled and piece.block is None)

    def _pair(self, name: str) -> tuple[float, float]:
        x, y = self.attributes[name]
        return float(x), float(y)

    def _frames(
        self,
        piece: Piece,
        span: tuple[int, int | None],
        values: NDArray[np.float64],
        columns: Columns,
    ) -> list[Frame]:
        low, high = span
        try:
            first, last = max(0, low - piece.low), (high or piece.high) - piece.low
            wanted = enumerate(values[first:last], first)
            frames = [self._frame(piece.low + i, v, columns, i) for i, v in wanted]
        except Exception as error:  # notes of an old store, which nothing vouches for
            raise Lost(f"the notes on them cannot be read: {_short(error)}") from error
        return [replace(f, doubtful=True) for f in frames] if self._unsure(piece) else frames

    def _frame(self, index: int, values: NDArray[np.float64], columns: Columns, i: int) -> Frame:
        note = json.loads(columns.notes[i] or b"{}")
        times = (float(columns.time_s[i]), float(columns.device_time_s[i]))
        time_s, device_time_s = (None if np.isnan(t) else t for t in times)
        return Frame.of(
            values,
            self._pair("pitch_cm"),
            self._pair("origin_cm"),
            str(self.attributes["quantity"]),
            index=index,
            time_s=time_s,
            truth=truth_from_json(note["truth"])[0] if "truth" in note else None,
            device_time_s=device_time_s,
            gap=bool(columns.gap[i]),
            doubtful=bool(columns.doubtful[i]),
            label=note.get("label", ""),
            own_number=note.get("own_number"),
            state_of=note.get("state_of", self._state_of),
        )


def open_stored(path: Path) -> Stored:
    """Return a store, opened.

    Raises
    ------
    DataError
        If it is no recording, or neither its journal nor Zarr tells what is in it.
    UsageError
        If Zarr is not installed.
    """
    load_zarr()
    journal = read_journal(path)
    attributes, metadata = _described(path, journal)
    # Or a version that was damaged would have a journal overlooked.
    journaled = int(attributes["version"]) >= JOURNALED or (path / JOURNAL).exists()
    troubles = list(_troubles(path, journal, metadata)) if journaled else []
    chunk = chunk_of(path, metadata)
    n, claimed, why = _numbered(path, metadata, journal.n_frames)
    # A writer that was killed leaves few frames without numbers, and a whole journal.
    whole = not journaled or (
        journal.head is not None and journal.whole and _counted(path, metadata, journal.n_frames)
    )
    unnumbered = claimed - n if why or not whole or claimed - n > unfinished(chunk, n) else 0
    if unnumbered:
        text = f"{unnumbered} frames from {n} on are lost: nothing numbers them"
        troubles.append(f"{text} ({why})" if why else text)
    pieces = [Piece(b.low, b.high, b) for b in journal.blocks]
    for low, high in uncovered(journal.blocks, n):
        edges = [low, *range((low // chunk + 1) * chunk, high, chunk), high]
        pieces += [Piece(a, b, None) for a, b in pairwise(edges)]
    return Stored(
        path.absolute(),  # what is in it is read when somebody may have gone to another folder
        replace(journal, path=journal.path.absolute()),
        attributes,
        metadata,
        journaled,
        not journaled or journal.attributes is not None,
        tuple(troubles),
        tuple(sorted(pieces)),
        unnumbered,
    )


def _described(path: Path, journal: Journal) -> tuple[Mapping[str, Any], Mapping[str, Metadata]]:
    """Return attributes and arrays' metadata: as the journal has them, or else Zarr."""
    attributes = journal.attributes
    if attributes is None:
        attributes = journal.head.attributes if journal.head else own_attributes(path)
    check_attributes(path, attributes)
    return attributes, journal.head.metadata if journal.head else own_metadata(path, attributes)


def chunk_of(path: Path, metadata: Mapping[str, Metadata]) -> int:
    """Return how many frames are in a chunk of the values."""
    return int(array_of(path, "values", metadata["values"], 0).chunks[0])


def _troubles(path: Path, journal: Journal, metadata: Mapping[str, Metadata]) -> list[str]:
    """Return what is damaged of the journal and of the metadata."""
    if not journal.there:
        return ["its journal is gone: what is in the arrays is given as doubtful"]
    found = [f"line {n} of its journal is damaged" for n in journal.damaged]
    attributes = journal.attributes or (journal.head.attributes if journal.head else {})
    own = (read_metadata(path, "") or {}).get("attributes")
    own = own if isinstance(own, dict) else {}
    if any(k not in own or own[k] != v for k, v in attributes.items()):
        found.append(f"{METADATA} is damaged")
    for name, told in metadata.items():
        if not same_metadata(path, name, told):
            found.append(f"{name}/{METADATA} is damaged")
    return found


def _numbered(path: Path, metadata: Mapping[str, Metadata], n: int) -> tuple[int, int, str]:
    """Return how many frames count, how many rows the arrays claim, and why no more are numbered.

    Frames behind the journal's last that are numbered were written just before it was cut short.
    """
    claimed = _claimed(path, metadata)
    if claimed <= n:
        return n, n, ""
    try:
        array = array_of(path, "number", metadata["number"], claimed)
        step = int(array.chunks[0])
        while n < claimed:  # not all at once: there may be more than there is memory for
            high = min(claimed, n + step - n % step)
            good = array[n:high] == np.arange(n, high)
            n = high if good.all() else n + int(np.argmin(good))
            if not good.all():
                break
    except Exception as error:  # a damaged chunk
        return n, claimed, f"number is damaged: {_short(error)}"
    return n, claimed, ""


def _counted(path: Path, metadata: Mapping[str, Metadata], n: int) -> bool:
    """Return whether the array of numbers still holds the last frame that the journal knows."""
    try:
        numbers = array_of(path, "number", metadata["number"], n)[max(0, n - 1) : n]
    except Exception:  # a damaged chunk
        return False
    whole = same_metadata(path, "number", metadata["number"])
    return whole and numbers.tolist() == list(range(max(0, n - 1), n))


def _claimed(path: Path, metadata: Mapping[str, Metadata]) -> int:
    """Return how many rows most arrays claim to have, as far as there are chunks for them."""
    told, held = [], 0
    for name in COLUMNS:
        if name not in metadata:
            continue
        n = written_rows(read_metadata(path, name))
        told += [] if n is None else [n]
        parts = [p.name for p in (path / name / "c").glob("*") if p.name.isdecimal()]
        size = int(array_of(path, name, metadata[name], 0).chunks[0])
        held = max(held, size * (1 + max((int(p) for p in parts), default=-1)))
    return min(sorted(told)[len(told) // 2], held) if told else 0


def _short(error: BaseException) -> str:
    text = " ".join(str(error).split()) or type(error).__name__
    if "checksum" in text:  # Zarr's words give both in bytes
        return "its checksum is wrong"
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
