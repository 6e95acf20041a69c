"""Mend what can be mended of a store: each part from the one that still vouches for it."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tactile_graph.files import write_whole
from tactile_graph_sources.stores import journal
from tactile_graph_sources.stores.journal import Columns, Journal
from tactile_graph_sources.stores.layout import (
    COLUMNS,
    JOURNAL,
    METADATA,
    NOTES,
    array_of,
    metadata_file,
    read_metadata,
    with_rows,
)
from tactile_graph_sources.stores.stored import Lost, Session, Stored, open_stored


def cut(told: Journal) -> None:
    """Take away a last line that was not finished."""
    if told.cut_at is not None:
        os.truncate(told.path, told.cut_at)


def adopt(stored: Stored) -> Stored:
    """Return a store whose journal also holds the frames that only the arrays told of.

    They stay doubtful; of those that are lost it says so.
    """
    lines = _lines_of_arrays(stored)
    for line in lines:
        journal.append(stored.path, line)
    return open_stored(stored.path) if lines else stored


def _lines_of_arrays(stored: Stored) -> list[bytes]:
    """Return a journal's lines for the frames of which it has none."""
    lines = []
    for piece in stored.pieces:
        if piece.block is not None:
            continue
        try:
            values, columns = stored.values(piece), stored.columns(piece)
        except Lost as why:
            lines.append(journal.lost_line(piece.low, piece.high, str(why)))
        else:
            unsure = columns._replace(doubtful=np.ones(len(values), bool))
            vouched = stored.attributes if stored.sure else None
            lines.append(journal.block_line(piece.low, values, unsure, vouched))
    n = stored.n_frames
    if stored.n_unnumbered:
        lines.append(journal.lost_line(n, n + stored.n_unnumbered, "nothing numbers them"))
    return lines


def rewrite_journal(stored: Stored) -> None:
    """Write the journal anew: its good lines, and what the arrays tell of the frames between."""
    head = journal.head_line(journal.Head(stored.attributes, stored.metadata, stored.sure))
    kept = b"".join(_line_at(stored.journal, p.block.place) for p in stored.pieces if p.block)
    write_whole(stored.path / JOURNAL, head + kept + b"".join(_lines_of_arrays(stored)))


def _line_at(told: Journal, place: int) -> bytes:
    with told.path.open("rb") as file:
        file.seek(place)
        return file.readline()


def rewrite_metadata(stored: Stored) -> None:
    """Write anew what Zarr needs to know of the group and of each array."""
    own = read_metadata(stored.path, "")
    group = own if own is not None and own.get("node_type") == "group" else {}
    told = group.get("attributes")
    attributes = {
        **(told if isinstance(told, dict) else {}),
        **stored.attributes,
        **_told_of(stored.sessions),
    }
    plain = {"zarr_format": 3, "node_type": "group"}
    _write_json(stored.path, "", {**group, **plain, "attributes": attributes})
    for name, data in stored.metadata.items():
        n = notes_end(stored) if name == NOTES else stored.n_frames
        _write_json(stored.path, name, with_rows(data, n))


def tell_sessions(path: Path, sessions: Sequence[Session]) -> None:
    """Write when each session began among the group's attributes, for those who read with Zarr."""
    own = read_metadata(path, "")
    if own is not None and isinstance(own.get("attributes"), dict):
        _write_json(path, "", {**own, "attributes": {**own["attributes"], **_told_of(sessions)}})


def _told_of(sessions: Sequence[Session]) -> dict[str, Any]:
    """Return the attribute of sessions; none for a single one, of which ``started`` tells."""
    later = any(one.frame for one in sessions)
    return {"sessions": [one._asdict() for one in sessions]} if later else {}


def _write_json(path: Path, name: str, data: object) -> None:
    file = metadata_file(path, name)
    file.parent.mkdir(exist_ok=True)
    write_whole(file, json.dumps(data, indent=2))


def notes_end(stored: Stored) -> int:
    """Return where in the array the notes of all frames end; raises Lost."""
    n = stored.n_frames
    return int(stored.rows("notes_end", n - 1, n)[0]) if n else 0


def rewrite_columns(stored: Stored) -> None:
    """Write anew all arrays but the values from the journal, which knows all frames by now."""
    end, at, texts = 0, 0, []
    rows = {n: np.full(stored.n_frames, f, d) for n, (d, f) in COLUMNS.items() if n != "values"}
    for piece in stored.pieces:
        rows["notes_end"][at : piece.low] = end
        at = piece.high
        span = slice(piece.low, piece.high)
        if piece.block is None or piece.block.lost:
            continue
        columns = stored.columns(piece)
        for name, column in zip(Columns._fields[:4], columns[:4], strict=True):
            rows[name][span] = column
        rows["notes_end"][span] = end + np.cumsum([len(n) for n in columns.notes])
        rows["number"][span] = np.arange(piece.low, piece.high)
        texts.append(b"".join(columns.notes))
        end += len(texts[-1])
    notes = np.frombuffer(b"".join(texts), np.uint8)
    for name, column in {**rows, NOTES: notes}.items():
        for part in sorted((stored.path / name).rglob("*")):
            if part.is_file() and part.name != METADATA:
                part.unlink()
        array = array_of(stored.path, name, stored.metadata[name], len(column), "r+")
        array[:] = column
