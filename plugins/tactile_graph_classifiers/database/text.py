"""Exports of object databases: YAML that people can read and programs can import."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from tactile_graph.errors import DataError, did_you_mean, shown
from tactile_graph.pipeline.document import quote_for_all
from tactile_graph.text_files import decoded
from tactile_graph_classifiers.database.instrument import Instrument
from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.database.rows import Lesson, Setting

FORMAT = "tactile-graph objects"
VERSION = 1
BEGINS_WITHIN = 10_000
"""Characters within which an export says that it is one."""
_LONG_NUMBER = re.compile(r"[0-9a-fA-F_:.]{1000}")
_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_Base: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


class _Dumper(_Base):  # type: ignore[misc]
    """PyYAML's fast dumper, whose texts every reader of YAML 1.1 and 1.2 takes for texts."""


quote_for_all(_Dumper)
_KEYS = {
    "format", "version", "about", "quantity", "pipeline", "instrument", "features", "objects",
}  # fmt: skip
_OBJECT_KEYS = {"name", "shape", "readings", "sources"}


def to_text(known: Known, about: str = "") -> str:
    """Return the YAML of known objects; floats keep every digit.

    Parameters
    ----------
    known : Known
    about : str
        A line for people.
    """
    data = {
        "format": FORMAT,
        "version": VERSION,
        **({"about": about} if about else {}),
        "quantity": known.quantity,
        "pipeline": known.pipeline,
        **({"instrument": known.instrument._asdict()} if known.instrument else {}),
        "features": list(known.features),
        "objects": [
            {
                "name": it.name,
                "shape": it.shape,
                "readings": it.readings.tolist(),
                "sources": list(it.sources),
            }
            for it in known.objects
        ],
    }
    return yaml.dump(
        data,
        Dumper=_Dumper,
        default_flow_style=None,
        sort_keys=False,
        allow_unicode=True,
        width=2**20,  # a reading a line
    )


def from_text(text: str, where: str) -> tuple[Setting, list[Lesson]]:
    """Return what an export holds.

    Parameters
    ----------
    text : str
    where : str
        The file, for errors.

    Raises
    ------
    DataError
        If it is no export of an object database, or of a newer version.
    """
    if FORMAT not in text[:BEGINS_WITHIN]:  # YAML of strangers may take minutes to be read
        raise DataError(where, f"is no export of an object database (no 'format: {FORMAT}')")
    if _LONG_NUMBER.search(text):
        raise DataError(where, "is no YAML that can be read: a number of over 1000 characters")
    try:
        data = yaml.load(text, Loader=_Loader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        at = f":{mark.line + 1}:{mark.column + 1}" if mark else ""
        raise DataError(f"{where}{at}", f"is no YAML: {getattr(error, 'problem', error)}") from None
    except Exception as error:  # a 13th month, brackets without end, a number that is none
        raise DataError(where, f"is no YAML that can be read: {error}") from None
    return from_data(data, where)


def from_data(data: Any, where: str) -> tuple[Setting, list[Lesson]]:
    """Return what an export, as plain data, holds.

    Parameters
    ----------
    data : mapping
    where : str

    Raises
    ------
    DataError
        As `from_text`.
    """
    if not isinstance(data, Mapping) or data.get("format") != FORMAT:
        raise DataError(where, f"is no export of an object database (no 'format: {FORMAT}')")
    if data.get("version") != VERSION:
        got = shown(data.get("version"))
        raise DataError(where, f"is an export of version {got}, version {VERSION} can be read")
    _only(data, _KEYS, where, "")
    features = data.get("features")
    if not isinstance(features, list) or not _texts(features) or not _all_differ(features):
        got = shown(features)
        raise DataError(where, f"features: must be a list of different names, got {got}")
    objects = data.get("objects")
    if not isinstance(objects, list):
        raise DataError(where, f"objects: must be a list, got {shown(objects)}")
    lessons = [_lesson(o, len(features), where, f"object {i}") for i, o in enumerate(objects, 1)]
    names = [lesson.name for lesson in lessons]
    for name in names:
        if names.count(name) > 1:
            raise DataError(where, f"two objects are named {name!r}")
    quantity, pipeline = (str(data.get(key, "")) for key in ("quantity", "pipeline"))
    instrument = _instrument(data["instrument"], where) if "instrument" in data else None
    return Setting(tuple(features), quantity, pipeline, instrument), lessons


def _instrument(data: Any, where: str) -> Instrument:
    """Return the grid and pitch of an export."""
    fields = Instrument._fields
    if isinstance(data, Mapping) and set(data) == set(fields):
        rows, columns, x, y = (data[key] for key in fields)
        whole = isinstance(rows, int) and isinstance(columns, int)
        if whole and all(_above_0(n) for n in (rows, columns, x, y)):
            return Instrument(rows, columns, float(x), float(y))
    raise DataError(
        where,
        f"instrument: must be whole numbers rows and columns, and numbers {fields[2]} and"
        f" {fields[3]}, all above 0, got {shown(data)}",
    )


def _above_0(value: Any) -> bool:
    good = isinstance(value, int | float) and not isinstance(value, bool)
    return good and 0.0 < value < 1e9


def _only(data: Mapping[str, Any], allowed: set[str], where: str, what: str) -> None:
    for key in data:
        if key not in allowed:
            hint = did_you_mean(str(key), allowed) or f"; allowed: {', '.join(sorted(allowed))}"
            raise DataError(where, f"{what}unknown key {shown(key)}{hint}")


def _texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(v, str) for v in value)


def _all_differ(names: list[Any]) -> bool:
    return 0 < len(names) == len(set(names))


def _lesson(data: Any, n_features: int, where: str, what: str) -> Lesson:
    if not isinstance(data, Mapping) or not isinstance(data.get("name"), str):
        raise DataError(where, f"{what}: must be a mapping with a name, got {shown(data)}")
    what = f"object {data['name']!r}: "
    _only(data, _OBJECT_KEYS, where, what)
    rows = data.get("readings")
    readings = _numbers(rows, n_features)
    if readings is None or not len(readings):
        raise DataError(
            where,
            f"{what}readings must be one or more rows of {n_features} finite numbers,"
            f" got {shown(rows)}",
        )
    sources: Sequence[str] = data.get("sources") or [""] * len(readings)
    if not _texts(sources) or len(sources) != len(readings):
        raise DataError(where, f"{what}sources must be a text for each of {len(readings)} readings")
    shape = data.get("shape", "")
    if not isinstance(shape, str):
        raise DataError(where, f"{what}shape must be a text, got {shown(shape)}")
    return Lesson(data["name"], shape, readings, sources)


def _numbers(rows: Any, n_features: int) -> Any:
    """Return the rows as an array, shape (n, F); None if they are anything else."""
    if not isinstance(rows, list):
        return None
    for row in rows:
        good = isinstance(row, list) and len(row) == n_features
        if not good or any(isinstance(v, bool) or not isinstance(v, int | float) for v in row):
            return None
    try:
        array = np.array(rows, dtype=np.float64).reshape(-1, n_features)
    except OverflowError:  # a whole number of more than 308 digits
        return None
    return array if np.isfinite(array).all() else None


def read_export(path: Path) -> tuple[Setting, list[Lesson]]:
    """Return what an export's file holds.

    Parameters
    ----------
    path : Path

    Raises
    ------
    DataError
        If it cannot be read or is no export.
    """
    try:
        return from_text(decoded(path.read_bytes()), str(path))
    except UnicodeDecodeError:
        raise DataError(str(path), "is no text file") from None
    except OSError as error:
        raise DataError(str(path), f"cannot be read: {error.strerror or error}") from None
