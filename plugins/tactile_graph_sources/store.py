"""Recordings as Zarr stores, read back frame by frame; `write_store` writes them.

A store is a Zarr 3 group of arrays of one row a frame: ``values`` (N, rows, columns; NaN where a
cell is invalid), ``time_s``, ``device_time_s`` (NaN where there is none), ``gap``, ``doubtful``,
``notes_end`` and ``number``; each chunk carries a CRC-32C. ``notes`` holds JSON (label and truth),
of which a frame's ends at ``notes_end``. What holds for all frames are the group's attributes.
``number`` is written last of a chunk: rows it does not reach do not count, so a writer killed at
any moment leaves a store that opens.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from tactile_graph.errors import DataError, UsageError
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import QUANTITIES
from tactile_graph_sources.readers.truth import truth_from_json

FORMAT = "tactile-graph recording"
VERSION = 2
READ = (1, 2)
"""Version 1 had no ``doubtful`` and no checksums."""
ROWS = ("values", "time_s", "device_time_s", "gap", "doubtful", "notes_end", "number")


def load_zarr() -> ModuleType:
    """Return Zarr; it comes with an extra, and only stores need it."""
    try:
        import zarr
    except ImportError:
        raise UsageError(
            "Zarr stores need the 'zarr' extra: pip install 'tactile-graph[zarr]'"
        ) from None
    module: ModuleType = zarr
    return module


def is_store(path: str | Path) -> bool:
    """Return whether a path is a Zarr 3 group, as far as its files tell; imports no Zarr."""
    return (Path(path) / "zarr.json").is_file()


def columns_of(version: object) -> tuple[str, ...]:
    """Return the arrays of one row a frame that a store of a version has."""
    return tuple(n for n in ROWS if n != "doubtful") if version == 1 else ROWS


def opened(path: Path, mode: str) -> Any:
    """Return the group of a recording, checked; raises what `read_store` raises."""
    zarr = load_zarr()
    try:
        group = zarr.open_group(str(path), mode=mode)
        version = group.attrs.get("version")
        missing = [n for n in (*columns_of(version), "notes") if n not in group]
    except Exception as error:  # a damaged store makes Zarr raise a dozen kinds
        raise DataError(str(path), f"is no Zarr store that opens: {error}") from error
    if group.attrs.get("format") != FORMAT or missing:
        raise DataError(str(path), f"is a Zarr store, but not a recording ({FORMAT})")
    if version not in READ:
        allowed = " and ".join(map(str, READ))
        raise DataError(str(path), f"is a recording of version {version}, {allowed} can be read")
    if group.attrs.get("quantity") not in QUANTITIES:
        raise DataError(str(path), f"unknown quantity {group.attrs.get('quantity')!r}")
    return group


def n_whole(group: Any) -> int:
    """Return how many rows were written whole; raises what `read_store` raises."""
    try:
        number = group["number"][:]
    except Exception as error:  # a damaged chunk
        where = str(getattr(group.store_path.store, "root", group.name))
        raise DataError(where, f"its frame numbers cannot be read: {error}") from error
    good = number == np.arange(len(number))
    return len(number) if good.all() else int(np.argmin(good))


def read_store(path: str | Path, report: Report | None = None, start: int = 0) -> Iterator[Frame]:
    """Yield the frames of a store, a chunk at a time.

    Parameters
    ----------
    path : path
    report : Report, optional
        Told how many frames are coming.
    start : int
        First frame to give.

    Raises
    ------
    DataError
        If it is no recording, or nothing of it can be read.
    UsageError
        If Zarr is not installed.
    """
    group = opened(Path(path), "r")
    n = n_whole(group)
    if report is not None:
        report.expect(max(0, n - start))
    chunk = int(group["values"].chunks[0])
    ends = np.concatenate([[0], group["notes_end"][:n]])
    gap, damaged = False, 0
    for low in range(start, n, chunk):
        high = min(n, low + chunk)
        try:
            frames = _chunk(group, ends, low, high)
        except Exception as error:  # a damaged chunk makes Zarr raise whatever its codec raises
            _left_out(Path(path), report, low, high, str(error))
            gap, damaged = True, damaged + 1
            continue
        if not any(f.image.valid is None or f.image.valid.any() for f in frames):
            _doubt(Path(path), report, low, high)  # Zarr gives NaN for a chunk that is not there
        frames[0] = replace(frames[0], gap=gap or frames[0].gap)
        yield from frames
        gap = False
    if damaged == -(-(n - start) // chunk) > 0:
        raise DataError(str(path), "not a single frame of it can be read")


def _chunk(group: Any, ends: Any, low: int, high: int) -> list[Frame]:
    columns = columns_of(group.attrs.get("version"))
    rows = {n: group[n][low:high] for n in columns if n not in ("notes_end", "number")}
    notes = group["notes"][int(ends[low]) : int(ends[high])].tobytes()
    attributes = dict(group.attrs)
    frames = []
    for i in range(high - low):
        a, b = (int(e - ends[low]) for e in ends[low + i : low + i + 2])
        frames.append(_frame(rows, i, low + i, attributes, json.loads(notes[a:b] or "{}")))
    return frames


def _left_out(path: Path, report: Report | None, low: int, high: int, why: str) -> None:
    if report is not None:
        report.count("damaged records skipped", high - low)
        report.trouble(str(path), f"frames {low} to {high - 1} cannot be read: {why}")


def _doubt(path: Path, report: Report | None, low: int, high: int) -> None:
    if report is not None:
        text = f"frames {low} to {high - 1} hold no valid cell: is a part of the store missing?"
        report.trouble(str(path), text)


def _frame(
    rows: Mapping[str, Any], i: int, index: int, attributes: Mapping[str, Any], note: Any
) -> Frame:
    times = [float(rows[name][i]) for name in ("time_s", "device_time_s")]
    time_s, device_time_s = (None if np.isnan(t) else t for t in times)
    pitch, origin = attributes["pitch_cm"], attributes["origin_cm"]
    truth = truth_from_json(note["truth"])[0] if "truth" in note else None
    return Frame.of(
        rows["values"][i],
        (float(pitch[0]), float(pitch[1])),
        (float(origin[0]), float(origin[1])),
        str(attributes["quantity"]),
        index=index,
        time_s=time_s,
        truth=truth,
        device_time_s=device_time_s,
        gap=bool(rows["gap"][i]),
        doubtful="doubtful" in rows and bool(rows["doubtful"][i]),
        label=note.get("label", ""),
    )
