"""A pipeline's text for another folder, where the files that it names are found as well."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import yaml

from tactile_graph.errors import TactileGraphError, UsageError
from tactile_graph.files import named_from_folder
from tactile_graph.pipeline.load import beside, is_file, parse_graph
from tactile_graph.pipeline.yaml_numbers import on_one_line
from tactile_graph.plugins.registry import Registry

_PROPERTIES = re.compile(r"(?:[&!]\S*\s+)*")
"""What may stand before a value: an anchor, a tag."""


def moved(text: str, file: str | Path, target: str | Path, registry: Registry | None = None) -> str:
    """Return a pipeline's text as it must read in another file; all else stays, comments too.

    The files that ``use`` and ``evolves`` name are named from the target's folder.

    Parameters
    ----------
    text : str
        A pipeline file without faults.
    file : path
        Where it was read.
    target : path
        Where it will lie; nothing has to be there.
    registry : Registry, optional

    Raises
    ------
    UsageError
        If the pipeline would be wrong there.
    """
    changes = {}
    for node in _names(yaml.compose(text, Loader=yaml.SafeLoader)):
        name = named_from(node.value, file, target)
        if name != node.value:
            changes[node.start_mark.index] = (node.end_mark.index, name)
    for start in sorted(changes, reverse=True):
        end, name = changes[start]
        old = text[start:end]
        end -= len(old) - len(old.rstrip())  # a block's mark stands where the next thing begins
        before = _PROPERTIES.match(old)
        assert before is not None
        text = text[: start + before.end()] + on_one_line(name) + text[end:]
    try:
        parse_graph(text, str(target), registry)
    except TactileGraphError as error:
        raise UsageError(f"not written, for in that folder it would be wrong: {error}") from None
    return text


def named_from(name: str, file: str | Path, target: str | Path) -> str:
    """Return how another file has to name the pipeline file that ``file`` names.

    A name stays that is none of a file, or that means the same file in both.

    Parameters
    ----------
    name : str
        As it stands in ``file``.
    file, target : path
    """
    found, there = beside(name, file), beside(name, target)
    if found is None and there is not None and is_file(Path(name)):
        found = Path(name)  # read from the current folder, but not where it is moved to
    if found is None or (there is not None and there.samefile(found)):
        return name
    folder = os.path.realpath(Path(target).parent)
    return Path(named_from_folder(found, folder)).as_posix()


def _names(root: yaml.Node | None) -> Iterator[yaml.ScalarNode]:
    """Yield the nodes of a document at which it names other pipelines."""
    for key, value in _entries(root):
        if key == "evolves" and isinstance(value, yaml.ScalarNode):
            yield value
        elif key == "nodes":
            for _, node in _entries(value):
                yield from (
                    v for k, v in _entries(node) if k == "use" and isinstance(v, yaml.ScalarNode)
                )


def _entries(mapping: yaml.Node | None) -> Iterator[tuple[str, yaml.Node]]:
    if isinstance(mapping, yaml.MappingNode):
        yield from ((str(key.value), value) for key, value in mapping.value)
