"""Refuse before the work to write over what a command reads, or two outputs into one file."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from tactile_graph.errors import UsageError
from tactile_graph.files import Name, is_plain
from tactile_graph.pipeline.named_files.named_files import is_kept, named_by_settings, paths_in

if TYPE_CHECKING:
    from tactile_graph.pipeline.graph import Graph

STDOUT = "-"
READ = "what the command reads"
FILES = ("FILE", "RECORDING")
"""Metavars of options that take files, whatever their type is."""


class _Input(NamedTuple):
    """A file or folder that is read, in words, and whether all that is in the folder is."""

    path: Path
    what: str
    with_all_in_it: bool = True


def check_targets(
    targets: Iterable[tuple[str, Name | None]],
    pipelines: Iterable[Graph] = (),
    read: Iterable[Name] = (),
) -> None:
    """Refuse an output that is one of the command's inputs, or another output, by whatever name.

    Inputs are the files and folders that the rest of the command line names, as they stand or on
    a side of ``=``; the pipelines' files, those of the pipelines that they use, and what their
    settings name; and what is told by ``read``.

    Parameters
    ----------
    targets : iterable of (str, path)
        Option or argument (``TARGET``), as the command line has it, and the file. None, ``-``,
        pipes and devices are passed over.
    pipelines : iterable of Graph, optional
        Those that the command runs or draws.
    read : iterable of path, optional
        Files that nothing else names: those of a list of recordings, say.

    Raises
    ------
    UsageError
    """
    files = [(option, str(name)) for option, name in targets if name not in (None, STDOUT)]
    files = [(option, name) for option, name in files if is_plain(name) or Path(name).is_dir()]
    for i, (option, name) in enumerate(files):
        for other, before in files[:i]:
            if _same(name, before):
                raise UsageError(f"{option} {name}: is the file of {other} too; name another file")
    graphs = [*pipelines]
    inputs = [*_of_command_line({option for option, _ in files}, {g.name for g in graphs})]
    inputs += [_Input(Path(name), READ) for name in read]
    for graph in graphs:
        inputs += [*_of_pipeline(graph), *_of_settings(graph)]
    for option, name in files:
        for one in inputs:
            _refuse(option, name, one)


def refuse_existing(targets: Iterable[tuple[str, Name | None]]) -> None:
    """Refuse to write over a file that is there: of files that people edit, and may have edited.

    Parameters
    ----------
    targets : iterable of (str, path)
        As of `check_targets`, of a command with an option ``--overwrite`` that was not given.

    Raises
    ------
    UsageError
    """
    for option, name in targets:
        if name not in (None, STDOUT) and is_plain(str(name)) and Path(str(name)).exists():
            raise UsageError(
                f"{option} {name}: is there already; name another file, or write over it with"
                " --overwrite"
            )


def _refuse(option: str, name: str, one: _Input) -> None:
    same = _same(name, one.path)
    if same or (one.with_all_in_it and _is_in(name, one.path)):
        part = "" if same else "a part of "
        by = "" if str(one.path) == name else f" ({one.path})"
        raise UsageError(
            f"{option} {name}: would overwrite {part}{one.what}{by}; name another file"
        )
    if one.what == READ and one.with_all_in_it and _would_be_of(name, one.path):
        raise UsageError(
            f"{option} {name}: would be a part of {one.what} ({one.path}); name a file elsewhere"
        )


def _of_command_line(outputs: set[str], names: set[str]) -> Iterator[_Input]:
    """Yield what the command line names, but for its outputs.

    A pipeline's name is none of a folder that is called the same. Of an option whose type is not a
    file's, words count behind a ``=``, where its metavar says so, and as YAML files.
    """
    context = click.get_current_context(silent=True)
    if context is None:
        return
    for param in context.command.params:
        words = {*param.opts, *param.secondary_opts, (param.name or "").upper()}
        if words & outputs:
            continue
        option = isinstance(param, click.Option)
        what = f"what {max(param.opts, key=len)} names" if option else READ
        metavar = param.metavar or ""
        files = (
            isinstance(param.type, click.Path | click.File) or metavar in FILES or "=" in metavar
        )
        for path in _sides(context.params.get(param.name or "")):
            taken = not option or files or path.suffix in (".yaml", ".yml")
            if taken and str(path) not in names:
                yield _Input(path, what)


def _sides(value: Any) -> Iterator[Path]:
    """Yield the files that words of an option or argument name: ``FILE=GRAMS``, ``KEY=FILE``."""
    for path in paths_in(value):
        word = str(path)
        sides = (word, word.partition("=")[2], word.rpartition("=")[0])
        yield from (p for p in map(Path, dict.fromkeys(filter(None, sides))) if is_kept(p))


def _of_pipeline(graph: Graph) -> Iterator[_Input]:
    """Yield the file of a pipeline, and those of the pipelines that it uses."""
    for file in dict.fromkeys([graph.file, *(node.mark.file for node in graph.nodes.values())]):
        if is_kept(Path(file)):
            yield _Input(Path(file), f"a file of pipeline {graph.name!r}")
    for node in graph.nodes.values():
        if node.inner is not None:
            yield from _of_pipeline(node.inner)


def _of_settings(graph: Graph) -> Iterator[_Input]:
    for path, by in named_by_settings(graph):
        # A folder that a setting names may be for anything, and what lies in it no input.
        yield _Input(path, f"what {by} names", with_all_in_it=False)


def _same(one: Name, other: Name) -> bool:
    """Return whether two names are of one file, which is there or is not yet."""
    try:
        return os.path.samefile(one, other)
    except (OSError, ValueError):
        return os.path.realpath(one) == os.path.realpath(other)


def _would_be_of(name: str, folder: Path) -> bool:
    """Return whether a file would be one more of a folder's, with the ending that most have.

    Others may lie beside its frames, as outputs of earlier runs do beside pictures.
    """
    path = Path(name)
    if not folder.is_dir() or path.resolve().parent != folder.resolve():
        return False
    endings = Counter(p.suffix.lower() for p in folder.iterdir() if p.is_file())
    return endings[path.suffix.lower()] == max(endings.values(), default=1)


def _is_in(name: str, folder: Path) -> bool:
    """Return whether a file is there, and lies in a folder."""
    path = Path(name)
    return folder.is_dir() and path.exists() and path.resolve().is_relative_to(folder.resolve())
