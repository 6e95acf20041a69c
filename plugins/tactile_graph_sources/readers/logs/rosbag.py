"""Folders of ROS 2's bags that hold MCAP logs: one recording, split in as many as there are."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import Any

import yaml

from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import SAMPLE, Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.sequence.by_number import in_order
from tactile_graph_sources.readers.sequence.numbered import of_files

METADATA, _ENDING, _ABOUT = "metadata.yaml", ".mcap", "rosbag2_bagfile_information"


def logs_in(folder: Path) -> list[str]:
    """Return the names of a bag's logs, as its metadata order them; none where it is no bag.

    Those that the metadata do not name come last, by their numbers.
    """
    if not (folder / METADATA).is_file():
        return []
    about = _metadata(folder / METADATA)
    if about is None:
        return []
    there = in_order(p.name for p in folder.glob(f"*{_ENDING}") if p.is_file())
    listed = about.get("relative_file_paths")
    paths = listed if isinstance(listed, list) else []
    names = [PurePosixPath(p).name for p in paths if isinstance(p, str)]
    return sorted(there, key=lambda n: names.index(n) if n in names else len(names))


def _metadata(path: Path) -> dict[str, Any] | None:
    """Return what the metadata say of a bag; None where they are of something else."""
    try:
        with path.open("rb") as file:
            found = yaml.safe_load(file.read(SAMPLE))
    except (yaml.YAMLError, UnicodeDecodeError, RecursionError, OSError):
        return None
    about = found.get(_ABOUT) if isinstance(found, dict) else None
    return about if isinstance(about, dict) else None


def recognises(head: Head) -> bool:
    """Return whether the folder is a bag with MCAP logs in it."""
    return bool(logs_in(head.path))


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the frames of each log; raises what MCAP's reader raises."""
    names = logs_in(reading.path)
    logs = names[0] if len(names) == 1 else f"{len(names)} logs, in the order of its metadata"
    reading.recognised(f"{METADATA} of a bag of ROS 2, {logs}")
    yield from of_files(reading, names)


FOLDER = RecordingFormat("ROS 2 bag of MCAP logs", recognises, read, of_folders=True)
