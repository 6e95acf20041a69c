"""A Parquet data set: a folder with a part for each recording, found by its name as Hive does it.

    results/_manifest.json
    results/recording=left%20foot.npz/part-0.parquet

A part gets its name when it is whole, and stands in the manifest right after. A recording that is
run again replaces what was there of it; the others stay.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tactile_graph.api.result import Result
from tactile_graph.cli.output.parquet import ParquetFile, pyarrow
from tactile_graph.engine.tables.columns import Column
from tactile_graph.engine.tables.table import Table
from tactile_graph.errors import UsageError, one_of
from tactile_graph.exporter import Export, Exporter, Writer
from tactile_graph.files import check_target, said, uninterrupted, write_whole
from tactile_graph.foreign_text import visible
from tactile_graph.locks import Lock
from tactile_graph.pipeline.graph import Graph
from tactile_graph.plugins.registry import installed
from tactile_graph.wires import Frame

MANIFEST = "_manifest.json"
KIND = "tactile-graph data set"
VERSION = 1
KEY = "recording"
NONE = "__HIVE_DEFAULT_PARTITION__"
LONGEST_NAME = 180
"""Bytes of a folder's name; file systems take 255, with the key before it."""
IDLE_FRAMES = 1000
"""Frames of others after which a recording is taken to be over; else it has another part."""
_PLAIN = re.compile(rb"[A-Za-z0-9_.\-]")


@dataclass
class _Recording:
    """What is written of a recording so far."""

    folder: str
    files: list[dict[str, Any]] = field(default_factory=list)
    frames: int = 0
    part: ParquetFile | None = None
    part_rows: int = 0
    last_frame: int = 0


class DataSet:
    """A data set under way.

    Parameters
    ----------
    export : Export

    Raises
    ------
    UsageError
        If the folder holds results of another pipeline, or another run is writing into it.
    """

    def __init__(self, export: Export) -> None:
        assert export.table is not None  # it holds numbers
        self.broken = False
        """Whether rows could not be written; recordings that were whole before stay."""
        self.stays = ""
        """What is to be said of older rows that stay."""
        self._root = Path(export.name)
        self._table: Table = export.table
        self._names = Names(export.pipeline)
        self._made_by = _made_by(export)
        self._written: dict[str, _Recording] = {}
        self._n = 0
        before = manifest_of(self._root)
        if before is not None and before["made_by"] != self._made_by:
            raise UsageError(
                f"-o {export.name}: holds results of {before['pipeline']!r}, as it was then: "
                "another pipeline, other settings or outputs; name another folder, or remove it"
            )
        self._manifest: dict[str, Any] = before or {
            "kind": KIND,
            "version": VERSION,
            "pipeline": export.pipeline.name,
            "made_by": self._made_by,
            "columns": [c.key for c in self._table.columns],
            "recordings": {},
        }
        self._lock = Lock(self._root / ".lock")

    def write(self, result: Result) -> None:
        """Take in a frame's rows, into the part of its recording."""
        self._begin()
        self._n += 1
        recording = self._of(self._names.of(result.frame))
        recording.last_frame = self._n
        if recording.part is None:
            recording.part = self._new_part(recording)
        try:
            recording.part.write(result)
        except BaseException:
            self.broken = recording.part.broken
            raise
        recording.frames += 1
        if self._n % IDLE_FRAMES == 0:
            for name, other in self._written.items():
                if self._n - other.last_frame >= IDLE_FRAMES:
                    self._finish(name, other)

    def close(self) -> None:
        """Give all parts their names."""
        self._begin()
        try:
            for name, recording in self._written.items():
                if recording.part is None or not recording.part.broken:
                    self._finish(name, recording)
            self._write_manifest()
        finally:
            self._lock.release()

    def close_early(self) -> None:
        """Give all parts their names, but where older rows are of more frames.

        Whether a recording that came to its end goes on later is not known, but how long it was is.
        """
        kept = []
        for name, recording in list(self._written.items()):
            more = name in self._entries and self._entries[name]["frames"] > recording.frames
            if recording.part is not None and not recording.files and more:
                recording.part.discard()
                del self._written[name]
                kept.append(name)
        if kept:
            self.stays = f"of what was under way, {one_of(kept)}, the older rows stay"
        self.close()

    def _begin(self) -> None:
        if self._lock.held:
            return
        with said(self._root):
            if not self._lock.take():
                raise UsageError(f"-o {self._root}: another run is writing into it")
            # Of a run that was killed.
            for lost in (f"{KEY}=*/.part-*.part", f".{MANIFEST}.*.part"):
                for left in self._root.glob(lost):
                    left.unlink()

    def _of(self, name: str) -> _Recording:
        found = self._written.get(name)
        if found is None:
            taken = {entry["folder"].casefold(): known for known, entry in self._entries.items()}
            taken |= {r.folder.casefold(): known for known, r in self._written.items()}
            found = self._written[name] = _Recording(folder_of(name, taken))
        return found

    @property
    def _entries(self) -> dict[str, Any]:
        entries: dict[str, Any] = self._manifest["recordings"]
        return entries

    def _new_part(self, recording: _Recording) -> ParquetFile:
        folder = self._root / recording.folder
        with said(folder):
            folder.mkdir(parents=True, exist_ok=True)
        name = folder / f"part-{len(recording.files)}.parquet"
        return ParquetFile(str(name), self._table)

    def _finish(self, name: str, recording: _Recording) -> None:
        """Give a recording's part its name, and note it in the manifest."""
        part = recording.part
        if part is None:
            return
        path = Path(part.output)
        with uninterrupted(), said(path):
            if not recording.files:  # what an earlier run made of this recording
                for old in path.parent.glob("part-*.parquet"):
                    old.unlink()
            part.close()
            recording.part = None
            recording.files.append({"name": path.name, "bytes": path.stat().st_size})
            self._entries[name] = {
                "folder": recording.folder,
                "frames": recording.frames,
                "files": recording.files,
            }
            self._write_manifest()

    def _write_manifest(self) -> None:
        text = json.dumps(self._manifest, indent=1, ensure_ascii=False)
        write_whole(self._root / MANIFEST, visible(text) + "\n")


class Names:
    """Tells which recording a frame is of.

    Parameters
    ----------
    pipeline : Graph
        On the source whose frames are asked for.
    """

    def __init__(self, pipeline: Graph) -> None:
        self._only = ""
        source = pipeline.source
        if source is None:
            return
        found = installed()
        self._only = source.name
        if found.has("readers", source.name):
            path = source.given.get(str(found.offer("readers", source.name).target))
            paths: Sequence[Any] = path if isinstance(path, list | tuple) else [path]
            self._only = Path(str(paths[0])).name if len(paths) == 1 else ""

    def of(self, frame: Frame) -> str:
        """Return the recording's name; with the sensor's behind it where it has several."""
        return f"{self._only} {frame.label}".strip() or "frames"


def folder_of(name: str, taken: dict[str, str] | None = None) -> str:
    """Return the folder of a recording: its name as addresses on the web spell it.

    Parameters
    ----------
    name : str
        Of any characters and length. One that is too long for a file system is cut, with a digest
        of the whole behind it.
    taken : dict of str to str, optional
        Recordings by their folders without regard of case, which some file systems have none of:
        of two that differ by it alone the second has a digest too.
    """
    units = [
        chr(b) if _PLAIN.match(bytes([b])) else f"%{b:02X}"
        for b in name.encode("utf-8", "surrogatepass")
    ]
    digest = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:12]
    spelled = "".join(units)
    if len(spelled) > LONGEST_NAME:
        spelled = _cut(units) + f"~{digest}"
    # Bare numbers would come back as numbers, 007 as 7, and Hive's own word for none as none.
    folder = f"{KEY}={spelled}{'~' if _is_number(name) or name == NONE else ''}"
    other = (taken or {}).get(folder.casefold(), name)
    return folder if other == name else f"{folder}~{digest}"


def _is_number(name: str) -> bool:
    try:
        float(name)
    except ValueError:
        return False
    return True


def _cut(units: Sequence[str]) -> str:
    """Return as many units as fit, no letter of several bytes broken."""
    kept: list[str] = []
    size = 0
    for unit in units:
        size += len(unit)
        if size > LONGEST_NAME:
            break
        kept.append(unit)
    while kept and len(kept[-1]) > 1 and 0x80 <= int(kept[-1][1:], 16) < 0xC0:
        kept.pop()
    if kept and len(kept[-1]) > 1 and int(kept[-1][1:], 16) >= 0xC0:
        kept.pop()
    return "".join(kept)


def manifest_of(folder: Path) -> dict[str, Any] | None:
    """Return the manifest of a folder that is a data set; None of any other."""
    try:
        data = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return data if isinstance(data, dict) and data.get("kind") == KIND else None


def _made_by(export: Export) -> str:
    """Return a digest of what decides what rows mean: nodes, outputs, columns; not the source."""
    assert export.table is not None
    resolved = export.pipeline.resolved()
    told = [resolved["nodes"], resolved["outputs"], export.asked]
    columns = [[c.key, _unit_told(c)] for c in export.table.columns]
    return hashlib.sha256(json.dumps([told, columns], default=str).encode()).hexdigest()


def _unit_told(column: Column) -> str:
    """Return a column's unit, of errors in long tables as their name has it: sets hang on it."""
    long = column.error and not column.key.startswith(f"{column.output}.")
    return column.key.rpartition("_")[2] if long else column.unit


def _check(name: str) -> None:
    """Refuse a folder that could not be written in the end, or is no data set, before the work."""
    pyarrow()
    if name == "-":
        raise UsageError("-o -: a data set is a folder; give its name")
    folder = Path(name)
    if not folder.is_dir():
        check_target("-o", folder)
        if folder.exists():
            raise UsageError(f"-o {name}: is a file, and a data set is a folder; name another")
    elif manifest_of(folder) is None and any(p.name != ".lock" for p in folder.iterdir()):
        raise UsageError(f"-o {name}: is a folder with something else in it; name another")


def _opened(export: Export) -> Writer:
    return DataSet(export)


DATA_SET = Exporter("a data set", "numbers", _opened, _check)
