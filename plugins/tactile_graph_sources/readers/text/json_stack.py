"""JSON of frames: a list of matrices, an object a frame, one object around all, or a line each."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, one_of
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.tables.frame_shape import shape_of_cells
from tactile_graph_sources.readers.tables.layout import assumed_unit
from tactile_graph_sources.readers.tables.sensors import chosen, labels_of_lines
from tactile_graph_sources.readers.words.compact import stamps_s
from tactile_graph_sources.readers.words.moments import clock_s, colon_unit_s, zone_remedy
from tactile_graph_sources.readers.words.names import ROLES, SECONDS, named
from tactile_graph_sources.readers.words.preamble import PAIRS, Described, described_by
from tactile_graph_sources.readers.words.running_clock import RunningClock

FEW_LISTS, LONGEST_LIST = 200_000, 2_000_000
LINES_LOOKED_AT = 20
MOST_KEYS, MOST_DAMAGED = 1_000, 1_000
_SHAPES = ("shape", "size", "dims", "dimensions", "grid")
_ROS_PARTS = {"secs": "nsecs", "sec": "nanosec"}
"""How messages of ROS 1 and 2 spell the seconds of a stamp, and what comes on top."""
_BASE64 = re.compile(r"(?=.*[A-Za-z])[A-Za-z0-9+/]+={0,2}")
FEWEST_PACKED = 16
_NUMBERED = re.compile(r"(\D*)(\d{1,9})")
Cells = NDArray[np.float64]


class Entries(NamedTuple):
    """Frames as the file holds them, what it says of them, and the name of their times.

    ``gaps`` are the numbers of those before which some are lost.
    """

    values: list[Any]
    times: list[Any] | None
    time_name: str
    said: Described
    why: str
    gaps: frozenset[int] = frozenset()


class Damage(NamedTuple):
    """What could not be read: how many entries stand before it, where, what, and of how many frames
    it is."""

    n_before: int
    where: int | str
    what: str
    n_frames: int = 1


def recognises(head: Head) -> bool:
    """Return whether the file is JSON: an object, or a list that goes on over its first line."""
    text = head.raw.removeprefix(b"\xef\xbb\xbf").lstrip()
    if text.startswith(b"{"):
        return b'"' in text[:200]
    if not text.startswith(b"["):
        return _holds_objects(head.first(LINES_LOOKED_AT))
    first = next((x.strip() for x in head.lines if x.strip()), "")
    if not head.whole:
        return first.startswith(("[[", "[{")) or not first.endswith("]")
    one = first if first.startswith(("[[[", "[{")) and len(head.first(2)) == 1 else ""
    whole = _parsed("\n".join(head.lines))
    return whole is not None or _is_nested(first) or (", " in one and is_cut_off(one))


def is_cut_off(text: str) -> bool:
    """Return whether brackets are opened and not closed at the end of a text."""
    return text.count("[") > text.count("]") or text.count("{") > text.count("}")


def _holds_objects(lines: list[str]) -> bool:
    """Return whether most lines are an object each, as where a program's words stand between."""
    n = sum(1 for x in lines if x.startswith('{"') and x.rstrip().endswith("}"))
    return 2 * n > len(lines) and isinstance(_parsed(next(x for x in lines if x[0] == "{")), dict)


def _is_nested(line: str) -> bool:
    """Return whether a line is a list of lists of numbers, as JSON writes it."""
    found = _parsed(line) if line.startswith("[[") else None
    return found is not None and (a := _array(found)) is not None and a.ndim == 2


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each matrix, or each list of as many numbers as the others have.

    Raises
    ------
    DataError
        If the file is no JSON, holds no frames, or does not say their shape.
    """
    reading.refuse_settings("time_unit")
    damage: list[Damage] = []
    content = _content(reading, damage)
    yield from frames_of(
        reading, entries_of(str(reading.path), content, reading.told.sensor), damage
    )


def frames_of(reading: Reading, entries: Entries, damage: Sequence[Damage] = ()) -> Iterator[Frame]:
    """Yield the frames of what was found; raises what `read` raises.

    Parameters
    ----------
    reading : Reading
    entries : Entries
    damage : sequence of Damage
        What could not be read and therefore is not among the entries.
    """
    where = str(reading.path)
    left = list(reversed(damage))
    arrays = [_array(v) for v in entries.values]
    shapes = Counter(a.shape for a in arrays if a is not None and a.ndim in (1, 2) and a.size)
    if not shapes:
        raise DataError(where, f"it holds no frames of numbers ({entries.why})")
    usual = shapes.most_common(1)[0][0]
    good = [a for a in arrays if a is not None and a.shape == usual]
    shape = usual if len(usual) == 2 else _shape(reading, np.stack(good), entries.said)
    reading.told.agree(where, *shape)
    reading.recognised(entries.why, entries.said.notes)
    reading.report.expect(len(arrays))
    entries = entries if reading.told.of_columns.time_unit else _without_stamps(entries)
    clocks, factor = _clocks_s(reading, entries), _time_factor(reading, entries)
    for k, array in enumerate(arrays):
        while left and left[-1].n_before <= k:
            _, place, what, n_frames = left.pop()
            reading.damaged(place, what, n_frames=n_frames)
        if array is None or array.shape != usual:
            got = "no numbers" if array is None else f"shape {array.shape}"
            reading.damaged(f"frame {k}", f"{got}, not {usual}")
            continue
        matrix = array if array.ndim == 2 else reading.told.laid_out(array, *shape)
        yield reading.frame(
            matrix,
            pitch_cm=entries.said.pitch_cm,
            origin_cm=entries.said.origin_cm,
            quantity=entries.said.quantity,
            factor=entries.said.factor,
            time_s=_time(entries, k, factor, clocks),
            gap=k in entries.gaps,
        )
    for _, place, what, n_frames in reversed(left):
        reading.damaged(place, what, n_frames=n_frames)


def _content(reading: Reading, damage: list[Damage]) -> Any:
    where = str(reading.path)
    try:
        text = reading.path.read_text(encoding=reading.head.encoding)
    except ValueError as error:
        raise DataError(where, f"its text is damaged: {error}") from error
    _check_size(where, text)
    whole = _parsed(text)
    return _by_lines(reading, text, damage) if whole is None else whole


def _check_size(where: str, text: str) -> None:
    """Refuse a text whose lists would take far more memory, or hold more, than frames do."""
    n_lists, n_commas = text.count("[") + text.count("{"), text.count(",")
    if n_lists > FEW_LISTS + n_commas * 2 // 3:
        raise DataError(
            where,
            f"its JSON has {n_lists} lists and objects and {n_commas} commas; allowed are "
            f"{FEW_LISTS}, and two more for every three commas",
        )
    if n_commas > LONGEST_LIST * max(n_lists, 1):
        told = f"its JSON has {n_commas} commas and {n_lists} lists; allowed are {LONGEST_LIST}"
        raise DataError(where, f"{told} a list")


def _by_lines(reading: Reading, text: str, damage: list[Damage]) -> list[Any]:
    """Return what each line holds; lines that hold no object and no list are damaged."""
    lines: list[Any] = []
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip():
            entry = _parsed(line)
            if isinstance(entry, dict | list):
                lines.append(entry)
                continue
            what = "no JSON" if entry is None else "no object and no list"
            # Where one sensor of several is asked for, nobody knows whose the line was.
            damage.append(Damage(len(lines), number, what, 0 if reading.told.sensor else 1))
            if len(damage) > MOST_DAMAGED + len(lines):
                break
    if not lines or len(damage) > MOST_DAMAGED + len(lines):
        told = "it begins as JSON does, and is none, as a whole or by lines"
        if is_cut_off(text):
            told += (
                "; brackets are not closed, as where it is cut off: save it again, or close them"
            )
        raise DataError(str(reading.path), told)
    return lines


def _parsed(text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return None


def _array(entry: object) -> Cells | None:
    try:
        return np.array(entry, dtype=np.float64)
    except (ValueError, TypeError, OverflowError):
        return None


def entries_of(where: str, content: Any, sensor: str | None = None) -> Entries:
    """Return the frames in what was parsed, wherever they lie in it.

    Parameters
    ----------
    where : str
    content
        What JSON holds.
    sensor : str, optional
        The sensor that is asked for, or none by an empty text, where each frame says whose it is;
        None where nobody asks.

    Raises
    ------
    DataError
        If there are none, several lists could be them, or they are of several sensors.
    """
    if isinstance(content, dict):
        return _of_object(where, content, sensor)
    if not isinstance(content, list) or not content:
        raise DataError(where, "its JSON is neither a list of frames nor an object around one")
    if not isinstance(content[0], dict):
        nested = isinstance(content[0], list) and content[0] and isinstance(content[0][0], list)
        if not isinstance(content[0], list):
            return Entries([content], None, "", Described(), "a list of numbers")
        what = "a list of matrices" if nested else "a list of lists of numbers"
        if not nested and _is_matrix(content):
            content = [content]
        return Entries(content, None, "", Described(), what)
    if len(content[0]) > MOST_KEYS:
        raise DataError(where, f"its JSON has {len(content[0])} keys; allowed are {MOST_KEYS}")
    objects = [_plain(e) if isinstance(e, dict) else {} for e in content]
    objects = objects if sensor is None else _of_one_sensor(where, objects, sensor)
    first = objects[0]
    lists = [
        k
        for k, v in first.items()
        if isinstance(v, list) and not (_is_of_objects(v) or _is_pair(k, v))
    ]
    text = next((k for k, v in first.items() if isinstance(v, str) and _is_packed(v)), "")
    if text and not lists:
        raise DataError(
            where,
            f"its JSON holds the cells of a frame packed as text ({text!r}: base64); write them as "
            "numbers, in Python, with the type and the shape of its values: numpy.frombuffer("
            "base64.b64decode(text), '<u2').reshape(ROWS, COLUMNS).tolist()",
        )
    if not lists and {"row", "column"} <= named(tuple(first)).roles.keys():
        raise DataError(
            where,
            "its JSON holds an object for each cell; save it as a table, in Python: "
            f"pandas.read_json('{Path(where).name}').to_csv('out.csv', index=False)",
        )
    key = _only(where, lists)
    time = next((k for k in first if _is_time(k)), "")
    times = [e.get(time) for e in objects] if time else None
    said = _said(first)
    return Entries([e.get(key) for e in objects], times, time, said, f"an object a frame, {key!r}")


def _of_one_sensor(where: str, objects: list[dict[str, Any]], sensor: str) -> list[dict[str, Any]]:
    """Return the frames of the one sensor that is asked for, where they say whose they are."""
    for key, first in objects[0].items():
        if isinstance(first, list):
            continue
        said = [str(e.get(key)) for e in objects]
        labels = labels_of_lines(key.rpartition(".")[2], said)
        if labels and not sensor:
            told = f"its frames are those of several sensors, as {key!r} says: {one_of(labels)}"
            raise SeveralSensorsError(where, f"{told}; name one with sensor", labels)
        if labels:
            try:
                mine = chosen(labels, sensor)
            except ValueError as error:
                raise DataError(where, str(error)) from None
            return [e for e, whose in zip(objects, said, strict=True) if whose == mine]
    return objects


def _plain(entry: dict[str, Any]) -> dict[str, Any]:
    """Return an object with its cells in one list, and its shape, if it has one, as numbers."""
    return _with_cells(_with_shape(_with_rows(_of_ros(_flattened(_flattened(entry))))))


def _is_packed(text: str) -> bool:
    """Return whether a text is bytes as base64 writes them."""
    return len(text) >= FEWEST_PACKED and len(text) % 4 == 0 and bool(_BASE64.fullmatch(text))


def _is_of_objects(entry: list[Any]) -> bool:
    return bool(entry) and isinstance(entry[0], dict)


def _of_ros(entry: dict[str, Any]) -> dict[str, Any]:
    """Return a message of ROS with its stamp in seconds, and its array's dimensions as a shape."""
    found = dict(entry)
    for key, value in entry.items():
        stem, _, name = key.rpartition(".")
        if name in _ROS_PARTS and isinstance(value, int):
            part = entry.get(f"{stem}.{_ROS_PARTS[name]}", 0)
            if isinstance(part, int) and stem:
                del found[key]
                found[f"{stem}.time_s"] = value + 1e-9 * part
        if name == "dim" and isinstance(value, list) and len(value) == 2 and _is_of_objects(value):
            found["shape"] = [d.get("size") for d in value if isinstance(d, dict)]
    return found


def _with_shape(entry: dict[str, Any]) -> dict[str, Any]:
    """Return an object whose list of two that says the shape is ``rows`` and ``columns``."""
    for key, pair in entry.items():
        said = key.rpartition(".")[2].lower() in _SHAPES and isinstance(pair, list)
        if said and len(pair) == 2 and all(isinstance(n, int) and n > 0 for n in pair):
            rest = {k: v for k, v in entry.items() if k != key}
            return {**rest, "rows": pair[0], "columns": pair[1]}
    return entry


def _with_cells(entry: dict[str, Any]) -> dict[str, Any]:
    """Return an object whose numbers by the names of cells, ``r0c0``, ``r0c1``, …, are a matrix."""
    if any(isinstance(v, list) for v in entry.values()):
        return entry
    keys = [k for k, v in entry.items() if v is None or type(v) in (int, float)]
    places = (found := named([k.rpartition(".")[2] for k in keys])).places
    if not places:
        return entry
    matrix = np.full((max(p.row for p in places) + 1, max(p.column for p in places) + 1), np.nan)
    if matrix.size > 2 * len(places):
        return entry
    names = [keys[k] for k in found.cells]
    for name, (row, column) in zip(names, places, strict=True):
        value = entry[name]
        matrix[row, column] = np.nan if value is None else value
    rest = {k: v for k, v in entry.items() if k not in names}
    return {**rest, f"{names[0]} to {names[-1]}": matrix.tolist()}


def _flattened(entry: dict[str, Any]) -> dict[str, Any]:
    """Return an object with what objects within it hold beside its own, their names in front."""
    flat: dict[str, Any] = {}
    for key, value in entry.items():
        inner = value if isinstance(value, dict) else {}
        flat |= {f"{key}.{k}": v for k, v in inner.items()} if inner else {key: value}
    return flat


def _with_rows(entry: dict[str, Any]) -> dict[str, Any]:
    """Return an object in which lists that are numbered and alike are one: ``r0``, ``r1``, …."""
    found = {
        k: m for k, v in entry.items() if isinstance(v, list) and (m := _NUMBERED.fullmatch(k))
    }
    stems = {m[1].lower() for m in found.values()}
    shapes = {a.shape if (a := _array(entry[k])) is not None else None for k in found}
    if len(found) < 2 or len(stems) > 1 or None in shapes or len(shapes) > 1:
        return entry
    stem = stems.pop()
    if stem and ROLES.get(stem.strip("_- ")) not in ("row", "frame"):
        return entry
    names = sorted(found, key=lambda k: int(found[k][2]))
    rest = {k: v for k, v in entry.items() if k not in found}
    return {**rest, f"{names[0]} to {names[-1]}": [entry[k] for k in names]}


def _of_object(where: str, content: dict[str, Any], sensor: str | None) -> Entries:
    if len(content) > MOST_KEYS:
        raise DataError(where, f"its JSON has {len(content)} keys; allowed are {MOST_KEYS}")
    content = _plain(content)
    lists = {k: v for k, v in content.items() if isinstance(v, list) and v and not _is_pair(k, v)}
    time = next((k for k in lists if _is_time(k)), "")
    times = lists.pop(time, None)
    deep = {k: v for k, v in lists.items() if isinstance(v[0], list | dict)}
    key = _only(where, deep or lists)
    inner = entries_of(where, lists[key], sensor)
    said = _said(content)
    if said == Described():
        unit, told = said.strange_unit or inner.said.strange_unit, (*said.told, *inner.said.told)
        said = replace(inner.said, strange_unit=unit, told=told)
    if inner.times is None and times is not None and len(times) == len(inner.values):
        return inner._replace(times=times, time_name=time, said=said, why=f"{key!r}: {inner.why}")
    return inner._replace(said=said, why=f"{key!r}: {inner.why}")


def _is_matrix(rows: list[Any]) -> bool:
    """Return whether lists of numbers are the rows of one matrix: as many as each holds."""
    return len(rows) > 1 and all(isinstance(r, list) and len(r) == len(rows) for r in rows)


def _only(where: str, keys: Any) -> str:
    names = list(keys)
    if len(names) == 1:
        return str(names[0])
    if names:
        told = f"several lists could be the frames ({one_of(names)}); keep one"
        raise DataError(where, f"its JSON holds {told}")
    raise DataError(
        where,
        "its JSON holds no list that could be a frame; save a list of rows for each, such as "
        '{"time": 0.05, "values": [[1, 2], [3, 4]]}, or where pandas wrote it, in Python: '
        f"pandas.read_json('{Path(where).name}').to_csv('out.csv', index=False)",
    )


def _is_time(key: str) -> bool:
    key = key.rpartition(".")[2]
    return "time" in named((key, "")).roles or ROLES.get(key.lower()) == "time"


def _said(content: dict[str, Any]) -> Described:
    if {"width", "height"} <= content.keys():
        content = {**content, "columns": content["width"], "rows": content["height"]}
    return described_by(
        {
            k.rpartition(".")[2]: v
            for k, v in content.items()
            if isinstance(v, str | int | float) or _is_pair(k, v)
        }
    )


def _is_pair(key: str, value: Any) -> bool:
    """Return whether a list is of two lengths, along x and y, as files of ours have them."""
    pair = isinstance(value, list) and len(value) == 2 and key.rpartition(".")[2] in PAIRS
    return pair and all(type(v) in (int, float) for v in value)


def _shape(reading: Reading, cells: Cells, said: Described) -> tuple[int, int]:
    found = shape_of_cells(cells, reading.told.with_said(said.rows, said.columns))
    if found.shape is None:
        raise DataError(str(reading.path), found.trouble)
    for what in found.assumed:
        reading.assume(what)
    return found.shape


def _without_stamps(entries: Entries) -> Entries:
    """Return entries with seconds for times that are dates written as one number."""
    numbers = [_number(t) if isinstance(t, str) else t for t in entries.times or ()]
    known = [float(t) for t in numbers if isinstance(t, int | float) and abs(t) < 1e300]
    found = stamps_s(np.array(known))
    if found is None:
        return entries
    at: dict[Any, float] = dict(zip(known, (found - found[0]).tolist(), strict=True))
    return entries._replace(times=[at.get(t) for t in numbers], time_name="time_s")


def _time_factor(reading: Reading, entries: Entries) -> float:
    if not entries.times:
        return 1.0
    unit = reading.told.of_columns.time_unit
    texts = [t for t in entries.times if isinstance(t, str) and t.strip() and _number(t) is None]
    if texts and unit:
        told = f"{entries.time_name!r} holds {texts[0][:30]!r}, a text; leave out time_unit"
        raise DataError(str(reading.path), told)
    if odd := next((t for t in texts if clock_s(t) is None), ""):
        remedy = f" ({told})" if (told := zone_remedy(odd)) else ""
        reading.assume(f"times left out, as {odd[:30]!r} is no time that is known{remedy}")
    if unit:
        return SECONDS[unit]
    said = named((entries.time_name.rpartition(".")[2], ""))
    if said.time_factor is not None:
        return said.time_factor
    numbers = [_number(t) if isinstance(t, str) else t for t in entries.times]
    times = [t for t in numbers if isinstance(t, int | float) and abs(t) < 1e300]
    if texts and not times:
        return 1.0
    factor, note = assumed_unit(np.array(times, dtype=np.float64), said.time_unit)
    reading.assume(note)
    return factor


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _clocks_s(reading: Reading, entries: Entries) -> list[float | None]:
    """Return the times that are texts in seconds from the first on; None where there is none."""
    texts = [t if isinstance(t, str) and _number(t) is None else "" for t in entries.times or ()]
    clock = RunningClock(str(reading.path), reading.assume, "", colon_unit_s(texts))
    found = [clock.read(text) for text in texts]
    first = next((at for at in found if at is not None), 0.0)
    return [None if at is None else round(at - first, 6) for at in found]


def _time(entries: Entries, k: int, factor: float, clocks: Sequence[float | None]) -> float | None:
    if not entries.times:
        return None if entries.said.frame_s is None else k * entries.said.frame_s
    time = entries.times[k]
    if isinstance(time, str) and (number := _number(time)) is not None:
        time = number
    if isinstance(time, str):
        return clocks[k]
    if isinstance(time, bool) or not isinstance(time, int | float):
        return None
    time_s = float(time) * factor if abs(time) < 1e300 else np.inf
    return time_s if np.isfinite(time_s) else None


FORMAT = RecordingFormat("JSON of frames", recognises, read)
