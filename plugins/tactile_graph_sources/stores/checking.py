"""What is wrong with a store, every byte of it looked at; `repairing` mends what can be."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.files import said
from tactile_graph.plugins.file_check import Checked, FileCheck
from tactile_graph_sources.stores.journal import Columns
from tactile_graph_sources.stores.layout import (
    METADATA,
    NOTES,
    is_store,
    read_metadata,
    unfinished,
    written_rows,
)
from tactile_graph_sources.stores.repairing import (
    adopt,
    rewrite_columns,
    rewrite_journal,
    rewrite_metadata,
)
from tactile_graph_sources.stores.sole_writer import SoleWriter
from tactile_graph_sources.stores.stored import UNSURE, Lost, Stored, open_stored

MOST_ROUNDS = 4
Mend = Callable[[Stored], object]


class Finding(NamedTuple):
    """One thing wrong with a store, and what mends it, if anything does.

    Of what is only ``left`` by a writer that was cut short no frame suffers.
    """

    text: str
    mend: Mend | None = None
    left: bool = False


def check(path: Path, repair: bool = False) -> Checked:
    """Return what is in a store and wrong with it, mended before if asked for.

    Raises
    ------
    DataError
        If it is no recording, or neither its journal nor Zarr tells what is in it.
    UsageError
        If Zarr is not installed, or a part cannot be written.
    """
    found = list(_findings(path))
    seen: dict[str, None] = {}
    for _ in range(MOST_ROUNDS if repair else 0):  # what is mended may show what else is wrong
        if not any(f.mend for f in found):
            break
        seen |= dict.fromkeys(f.text for f in found if f.mend)
        _repair(path, found)
        found = list(_findings(path))
    still = {f.text for f in found}
    return Checked(
        _about(open_stored(path)),
        tuple(f.text for f in found if not f.left),
        tuple(t for t in seen if t not in still),
        tuple(f.text for f in found if f.left),
    )


STORES = FileCheck(is_store, check)


def _repair(path: Path, found: list[Finding]) -> None:
    sole = SoleWriter(path)
    sole.take()
    try:
        with said(path):
            for mend in (rewrite_journal, adopt, rewrite_columns, rewrite_metadata, _sweep):
                if any(f.mend is mend for f in found):
                    mend(open_stored(path))
    except Lost as why:
        raise DataError(str(path), f"cannot be mended: {why}") from why
    finally:
        sole.release()


def _about(stored: Stored) -> str:
    n = stored.n_frames
    rows, columns = stored.metadata["values"]["shape"][1:]
    grid = f"{rows} x {columns} cells, {stored.attributes['quantity']}"
    return f"{n} frame{'s' if n != 1 else ''} of {grid}, version {stored.attributes['version']}"


# -- what is wrong ---------------------------------------------------------------------------


def _findings(path: Path) -> Iterator[Finding]:
    stored = open_stored(path)
    yield from _of_parts(stored)
    lost: list[Finding] = []
    for piece in stored.pieces:
        try:
            stored.frames(piece)
        except Lost as why:
            mend = adopt if stored.journaled and piece.block is None else None
            lost.append(Finding(f"{piece.words}: lost: {why}", mend))
        else:
            if stored.journaled and piece.block is None:
                yield Finding(f"{piece.words}: the journal does not vouch for them", adopt)
    if stored.journaled:
        yield from _of_columns(stored)
        yield from _of_rows(stored)
    yield from lost
    left = _leftovers(path)
    if left:
        n = len(left)
        yield Finding(
            f"{n} file{'s' if n != 1 else ''} that a writer left unfinished", _sweep, True
        )


def _of_parts(stored: Stored) -> Iterator[Finding]:
    """Yield what is damaged of journal and metadata."""
    for trouble in stored.troubles:
        of_metadata = stored.journal.head is not None and METADATA in trouble
        yield Finding(trouble, rewrite_metadata if of_metadata else rewrite_journal)
    if stored.journal.cut_at is not None:
        text = "the last line of its journal was not finished"
        yield Finding(text, rewrite_journal, left=not stored.troubles)
    if not stored.sure:
        yield Finding(UNSURE)


def _of_columns(stored: Stored) -> Iterator[Finding]:
    """Yield the arrays, but for the values, that say other things than the journal does."""
    wrong: dict[str, None] = {}
    for piece in stored.pieces:
        if piece.block is None or piece.block.lost:
            continue
        told = stored.columns(piece)
        for name in (*Columns._fields[:4], NOTES):
            try:
                same = _same(stored, name, told, piece.low, piece.high)
            except Lost as why:
                wrong[str(why)] = None
            else:
                if not same:
                    wrong[f"{name}: other than the journal has it"] = None
    for text in wrong:
        yield Finding(text, rewrite_columns)


def _same(stored: Stored, name: str, told: Columns, low: int, high: int) -> bool:
    if name == NOTES:
        return stored.columns_of_arrays(low, high).notes == told.notes
    equal_nan = name.endswith("_s")
    return np.array_equal(stored.rows(name, low, high), getattr(told, name), equal_nan=equal_nan)


def _of_rows(stored: Stored) -> Iterator[Finding]:
    """Yield the arrays of which Zarr's metadata tell other lengths than there are frames.

    A writer that is cut short has begun at most so much more.
    """
    most = unfinished(stored.chunk, stored.n_frames)
    for name in stored.metadata:
        n = written_rows(read_metadata(stored.path, name))
        if name != NOTES and n is not None and n != stored.n_frames:
            text = f"{name}/{METADATA} tells of {n} frames, there are {stored.n_frames}"
            left = stored.n_frames < n <= stored.n_frames + most
            yield Finding(text, rewrite_metadata, left)


def _leftovers(path: Path) -> list[Path]:
    """Return the files that Zarr had begun when a writer was killed."""
    return sorted(path.rglob("*.partial"))


def _sweep(stored: Stored) -> None:
    for part in _leftovers(stored.path):
        part.unlink(missing_ok=True)
