"""Recordings as Zarr stores, read back frame by frame; `write_store` writes them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from tactile_graph.errors import DataError
from tactile_graph.foreign_text import pasted
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph_sources.stores.stored import UNSURE, Lost, Stored, open_stored


def read_store(path: str | Path, report: Report | None = None, start: int = 0) -> Iterator[Frame]:
    """Yield the frames of a store, a block at a time.

    Parameters
    ----------
    path : path
    report : Report, optional
        Told how many frames are coming, and what is damaged: lost frames are counted, named, and
        the one after them follows a gap.
    start : int
        First frame to give.

    Raises
    ------
    DataError
        If it is no recording, or nothing of it can be read.
    UsageError
        If Zarr is not installed.
    """
    yield from frames_of(open_stored(Path(path)), Path(path), report, start)


def frames_of(
    stored: Stored,
    path: Path,
    report: Report | None,
    start: int = 0,
    in_stacks: bool = False,
) -> Iterator[Any]:
    """Yield what `read_store` does of a store that is opened.

    Parameters
    ----------
    stored : Stored
    path, report, start
        As of `read_store`.
    in_stacks : bool
        Yield many at once where nothing is to be said of single frames.

    Raises
    ------
    DataError
        If nothing of it can be read.
    """
    if report is not None:
        report.expect(max(0, stored.n_frames - start))
        _tell_damage(stored, report)
    gap, n_given, n_lost = False, 0, 0
    for piece in stored.pieces:
        if piece.high <= start:
            continue
        try:
            given = stored.given if in_stacks and not gap else stored.frames
            frames = [*given(piece, start)]
        except Lost as why:
            n_lost += piece.high - piece.low
            gap = True
            if report is not None:
                report.count("damaged records skipped", piece.high - piece.low)
                report.trouble(str(path), f"{piece.words}: lost: {why}")
            continue
        first = frames[0]
        if gap and isinstance(first, Frame):
            frames[0] = replace(first, gap=True)
        gap = False
        n_given += len(frames)
        yield from frames
    if n_lost and not n_given:
        raise DataError(str(path), "not a single frame of it can be read")


def _tell_damage(stored: Stored, report: Report) -> None:
    for trouble in stored.troubles:
        report.trouble(str(stored.path), trouble)
    if stored.troubles:
        command = f"tactile-graph check --repair {pasted(str(stored.path))}"
        report.trouble(str(stored.path), f"'{command}' may mend it")
    if not stored.sure:
        report.trouble(str(stored.path), UNSURE)
