"""The files and folders that settings name, of a pipeline and of those within it."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Iterator, Mapping, Set
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from tactile_graph.files import sha256_of

if TYPE_CHECKING:
    from tactile_graph.pipeline.graph import Graph

JOURNALS = "*.journal"
"""Of a folder that vouches for itself: they hold the checksums of all else that is in it."""


class Named(NamedTuple):
    """A file or folder, and what names it."""

    path: Path
    by: str


def named_by_settings(graph: Graph) -> Iterator[Named]:
    """Yield the files and folders that settings of a graph's source and nodes name."""
    if graph.source is not None:
        yield from _named(graph.source.settings, "the source")
    for node in graph.nodes.values():
        yield from _named(node.settings, f"node {node.name!r}")
        if node.inner is not None:
            yield from named_by_settings(node.inner)


def paths_in(value: Any) -> Iterator[Path]:
    """Yield every text of a value, of lists, sets, mappings and records in it too, as a path."""
    kind = type(value)
    if isinstance(value, Mapping):
        value = list(value.values())
    elif dataclasses.is_dataclass(kind):
        value = [getattr(value, f.name, None) for f in dataclasses.fields(kind)]
    elif hasattr(kind, "model_fields"):  # of pydantic
        value = [*vars(value).values(), getattr(value, "__pydantic_extra__", None)]
    elif isinstance(value, Set):
        value = sorted(value, key=str)
    if isinstance(value, list | tuple):
        for part in value:
            yield from paths_in(part)
    elif isinstance(value, str | Path) and str(value).strip():
        yield Path(value)


def is_there(path: Path) -> bool:
    """Return whether there is such a file, folder or device."""
    try:
        return path.exists()
    except (OSError, ValueError):  # a text that no file can be called
        return False


def is_kept(path: Path) -> bool:
    """Return whether there is such a file or folder: no device, no pipe."""
    return is_there(path) and (path.is_file() or path.is_dir())


def content_of(path: Path, which: str = "*") -> str:
    """Return a digest of what stands in a file, or in the files of a folder of that pattern.

    Raises
    ------
    OSError
        If one cannot be read.
    """
    files = [path]
    if path.is_dir():
        files = sorted(path.glob(JOURNALS)) or sorted(p for p in path.rglob(which) if p.is_file())
    whole = hashlib.sha256()
    for file in files:
        of_file = bytes.fromhex(sha256_of(file))
        whole.update(f"{file.relative_to(path)}\n".encode() + of_file)
    return whole.hexdigest()


def _named(settings: Mapping[str, Any], whose: str) -> Iterator[Named]:
    for name, value in settings.items():
        for path in filter(is_kept, paths_in(value)):
            yield Named(path, f"setting {name!r} of {whose}")
