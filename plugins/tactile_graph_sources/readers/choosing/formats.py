"""Which of the formats on offer a recording is of, by its content alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

from tactile_graph.errors import DataError, PluginError, text_of
from tactile_graph.foreign_text import tell
from tactile_graph_sources.readers.choosing.others import remedy_for, remedy_without_header
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.words.told import Told

OFFERS = "recording_formats"


def formats(of_folders: bool = False) -> list[RecordingFormat]:
    """Return the formats of files, or of folders, in the order in which they are asked."""
    found = [f for _, f in _offered() if f.of_folders == of_folders]
    return sorted(found, key=lambda f: f.plain)  # stable: as they were offered


def known() -> str:
    """Return the names of all formats of files, for messages."""
    return ", ".join(f.name for f in formats())


def format_of(head: Head) -> RecordingFormat:
    """Return the format of a file.

    Raises
    ------
    DataError
        If the file is of no known format.
    PluginError
        If it is of none, and one of a plugin broke when it was asked.
    """
    found = _first(formats(), head)
    if found is None:
        told = f"{remedy_without_header(head)}formats that are read: {known()}"
        raise DataError(str(head.path), f"no recording: {head.found()}; {remedy_for(head) or told}")
    return found


def format_of_folder(path: Path, told: Told) -> RecordingFormat | None:
    """Return the format of a folder; None if it is of none. Raises as `format_of`."""
    return _first(formats(of_folders=True), Head(path, b"", told))


def _first(asked: Sequence[RecordingFormat], head: Head) -> RecordingFormat | None:
    """Return the first format that recognises a recording, and tell of those that broke."""
    broken = []
    for one in asked:
        try:
            if not _recognised(one, head):
                continue
        except PluginError as error:
            broken.append(error)
            continue
        for trouble in broken:
            _tell_once(f"{trouble}; the other formats were asked")
        return one
    if broken:
        raise broken[0]
    return None


def _recognised(found: RecordingFormat, head: Head) -> bool:
    try:
        return found.recognises(head)
    except (OSError, DataError):
        raise
    except Exception as error:  # a plugin's code may raise anything
        owner = next(owner for owner, offered in _offered() if offered is found)
        told = f"{type(error).__name__}: {text_of(error)}"
        raise PluginError(
            f"recording format {found.name!r} of {owner} cannot tell whether {head.path} is one: "
            f"{told}"
        ) from error


@cache
def _tell_once(text: str) -> None:
    tell(text)


def _offered() -> Iterator[tuple[str, RecordingFormat]]:
    """Yield every format that loads, and the plugin that offers it."""
    from tactile_graph.plugins.registry import installed

    registry = installed()
    for name in registry.offered(OFFERS):
        try:
            loaded = registry.load(OFFERS, name)
        except PluginError as error:
            _tell_once(f"{error}; the other formats are asked")
            continue
        yield registry.offer(OFFERS, name).plugin.label, loaded
