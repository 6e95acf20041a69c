"""``look_into``: one recording read through once, recognised and measured."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tactile_graph.errors import DataError, TactileGraphError
from tactile_graph.steps import Report
from tactile_graph.wires import Frame
from tactile_graph_sources.inspection.measure import Measured, measure
from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.words.names import ColumnsTold
from tactile_graph_sources.readers.words.told import Told
from tactile_graph_sources.recording import opened
from tactile_graph_sources.stores.layout import is_store
from tactile_graph_sources.stores.stored import Session, open_stored

MOST_FRAMES = 2000
MOST_CELLS = 20_000_000
MOST_SENSORS = 4
"""Labels up to which each is measured for itself; more of them name what was done, not sensors."""
_COLUMNS = ("frame_column", "time_column", "value_column", "cells", "time_unit", "time_format")


@dataclass(frozen=True)
class Sensor:
    """The frames of one sensor and what they are like.

    ``frames`` are those measured, the first ``MOST_FRAMES``; ``n_frames`` counts all.
    """

    label: str
    n_frames: int
    frames: tuple[Frame, ...]
    measured: Measured


@dataclass(frozen=True)
class Looked:
    """What a recording was recognised as, and what is in it.

    Parameters
    ----------
    path : Path
    format, why : str
        What it was recognised as, and by what.
    n_frames : int
    sensors : tuple of Sensor
    assumed : tuple of str
        What nobody said and is taken to be so.
    counts : dict
        Damaged records, frames of garbage and whatever else was counted.
    troubles : tuple of (str, str)
        Place and what was wrong there.
    chosen : str
        The sensor that was read of several.
    sessions : tuple of Session
        When it was recorded, as far as it says so.
    """

    path: Path
    format: str
    why: str
    n_frames: int
    sensors: tuple[Sensor, ...]
    assumed: tuple[str, ...]
    counts: dict[str, int]
    troubles: tuple[tuple[str, str], ...]
    chosen: str = ""
    sessions: tuple[Session, ...] = ()

    @property
    def pitch_assumed(self) -> bool:
        """Whether nobody said the pitch."""
        return any("pitch" in a for a in self.assumed)


def look_into_all(path: Path, settings: Mapping[str, Any]) -> dict[str, Looked | TactileGraphError]:
    """Return what a recording is and holds; where it holds several sensors, each by its name.

    A recording of one sensor has the name ``""``. A sensor that cannot be read has its error.

    Raises
    ------
    TactileGraphError
        As `recording`, but for several sensors of which none is asked for.
    """
    try:
        return {"": look_into(path, settings)}
    except SeveralSensorsError as several:
        names = several.sensors
    found: dict[str, Looked | TactileGraphError] = {}
    for name in names:
        try:
            found[name] = replace(look_into(path, {**settings, "sensor": name}), chosen=name)
        except TactileGraphError as error:
            found[name] = error
    return found


def look_into(path: Path, settings: Mapping[str, Any]) -> Looked:
    """Return what a recording is and holds.

    Parameters
    ----------
    path : Path
    settings : mapping
        As for the source `recording`.

    Raises
    ------
    DataError
        As `recording`.
    """
    report = Report()
    columns = ColumnsTold(*(settings.get(name, "") for name in _COLUMNS))
    others = {k: v for k, v in settings.items() if k not in _COLUMNS}
    invert_from = others.pop("invert_from", None)
    recording = opened(path, Told.of(columns, **others), report).turned_round(invert_from)
    kept: dict[tuple[str, tuple[int, int]], list[Frame]] = {}
    counted: Counter[tuple[str, tuple[int, int]]] = Counter()
    n = 0
    for frame in recording.frames:
        key = (frame.label, frame.image.shape)
        counted[key] += 1
        n += 1
        if counted[key] <= min(MOST_FRAMES, MOST_CELLS // frame.image.values.size + 1):
            kept.setdefault(key, []).append(frame)
    if len(kept) > MOST_SENSORS:
        kept, counted = _by_shape(kept), _counted_by_shape(counted)
    sensors = tuple(
        Sensor(key[0], counted[key], tuple(frames), measure(frames)) for key, frames in kept.items()
    )
    assumed, counts = _told_apart(report.counts)
    return Looked(
        path,
        recording.format,
        recording.why(),
        n,
        sensors,
        assumed,
        counts,
        tuple(report.troubles),
        sessions=_sessions(path),
    )


def _sessions(path: Path) -> tuple[Session, ...]:
    if not is_store(path):
        return ()
    try:
        return open_stored(path).sessions
    except DataError:  # another's Zarr arrays
        return ()


def _by_shape(
    kept: dict[tuple[str, tuple[int, int]], list[Frame]],
) -> dict[tuple[str, tuple[int, int]], list[Frame]]:
    merged: dict[tuple[str, tuple[int, int]], list[Frame]] = {}
    for (_, shape), frames in kept.items():
        merged.setdefault(("", shape), []).extend(frames)
    most = {key: sorted(f, key=lambda one: one.index)[:MOST_FRAMES] for key, f in merged.items()}
    return dict(list(most.items())[:MOST_SENSORS])


def _counted_by_shape(
    counted: Counter[tuple[str, tuple[int, int]]],
) -> Counter[tuple[str, tuple[int, int]]]:
    merged: Counter[tuple[str, tuple[int, int]]] = Counter()
    for (_, shape), n in counted.items():
        merged["", shape] += n
    return merged


def _told_apart(counts: Mapping[str, int]) -> tuple[tuple[str, ...], dict[str, int]]:
    """Return what is assumed, and what was counted, of a report's counters."""
    assumed, counted = [], {}
    for what, n in counts.items():
        if what.startswith("recordings read as") or what == "troubles":
            continue
        if what.startswith("recordings w"):  # "with …" and "whose …": one for each file
            assumed.append(what.removeprefix("recordings with ").removeprefix("recordings "))
        else:
            counted[what] = n
    return tuple(assumed), counted
