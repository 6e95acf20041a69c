"""Load the graph of a pipeline by name, file or text; report all that is wrong with it at once."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from textwrap import shorten
from typing import Any, NamedTuple

from tactile_graph.errors import PipelineError, TactileGraphError, UsageError, did_you_mean
from tactile_graph.files import looked_for, not_a_path
from tactile_graph.pipeline.declaration import declare
from tactile_graph.pipeline.document import Document, read_document, text_of_file
from tactile_graph.pipeline.files_read import FilesRead, Used
from tactile_graph.pipeline.graph import Graph
from tactile_graph.pipeline.resolution.resolve import SourceOverride, resolve
from tactile_graph.pipeline.resolution.scope import Overrides, Scope
from tactile_graph.plugins.registry import Registry, installed

MOST_LEVELS = 50
"""Of pipelines within each other."""


class Opened(NamedTuple):
    """What one load has opened so far.

    Parameters
    ----------
    within : tuple of (str, Path)
        The pipelines that are being loaded because one uses the other: name and file.
    loaded : dict of Path to Graph or Exception
        What came of those that were loaded as they stand: they may be used more than once.
    files : FilesRead
        Each is read once.
    """

    within: tuple[tuple[str, Path], ...]
    loaded: dict[Path, Graph | Exception]
    files: FilesRead


def load_graph(name: str | Path, registry: Registry | None = None) -> Graph:
    """Return the graph of the pipeline of that name or in that file; for the rest see `load`."""
    registry = registry or installed()
    path = find(name, registry)
    text = _text(path, waited_for=True)
    return _build(text, _shown(path), registry, {}, None, Opened((), {}, FilesRead.here()))


def parse_graph(text: str, file: str = "<text>", registry: Registry | None = None) -> Graph:
    """Return the graph that YAML text declares; ``file`` is the name its errors carry."""
    return parse_again(text, file, registry, {}, None, FilesRead.here())


def parse_again(
    text: str,
    file: str,
    registry: Registry | None,
    overrides: Overrides,
    source: SourceOverride,
    files: FilesRead,
) -> Graph:
    """Return the graph that YAML text declares, with other settings or another source.

    What it uses is as it was where ``files`` have it, and read where they have not.
    """
    opened = Opened((), {}, files)
    return _build(text, file, registry or installed(), overrides, source, opened)


def resolve_again(graph: Graph, overrides: Overrides, source: SourceOverride) -> Graph:
    """Return the graph resolved again from its texts, with other settings or another source."""
    return parse_again(graph.text, graph.file, graph.registry, overrides, source, graph.files)


def find(name: str | Path, registry: Registry, file: str = "") -> Path:
    """Return the file of a pipeline, as it is named in another file.

    Raises
    ------
    UsageError
        If there is none; says what is near.
    """
    if not isinstance(name, str | os.PathLike):
        raise UsageError(
            f"a pipeline's name or file is needed, got {type(name).__name__}; loads() takes a"
            " pipeline's YAML as text, and yaml.safe_dump() makes that of a dict"
        )
    text = str(name)
    if "\n" in text:
        raise UsageError(
            f"a pipeline's name or file is needed, got {len(text.splitlines())} lines of text,"
            f" {shorten(text, 40)!r}; loads() takes a pipeline's YAML as text"
        )
    if isinstance(name, Path) or text.endswith((".yaml", ".yml")) or "/" in text:
        path = Path(name)
        if is_file(path):
            return path
        if _is_folder(path):
            raise UsageError(f"{text!r} is a folder; name a file in it")
        if path.name == text and registry.has("pipelines", path.stem):
            hint = f"; there is a pipeline named {path.stem!r}"
        else:
            hint = not_a_path(text) or did_you_mean(path.name, _siblings(path))
        raise UsageError(f"no pipeline file {text!r}{hint}")
    if not registry.has("pipelines", text):
        if is_file(Path(text)):
            raise UsageError(
                f"{text!r} is a file, but a pipeline file ends in .yaml; recordings come after the"
                " pipeline's name"
            )
        if text and _is_folder(Path(text)):
            raise UsageError(f"{text!r} is a folder; name a file in it")
        if text == "-":
            raise UsageError("'-' is no pipeline's name; standard input is /dev/stdin")
        near = next((f for f in _siblings(Path(text)) if Path(f).stem == text), None)
        if near and not file:
            raise UsageError(f"no pipeline named {text!r}; did you mean the file {near!r}?")
        if Path(text).suffix and not file:
            raise UsageError(f"no file {text!r}, and {registry.unknown('pipelines', text)}")
    return registry.path("pipelines", text, file)


def beside(name: str, file: str | Path) -> Path | None:
    """Return the pipeline file of that name as it is seen from a file's folder; None for none."""
    path = Path(file).parent / name
    return path if name.endswith((".yaml", ".yml")) and is_file(path) else None


def is_file(path: Path) -> bool:
    """Return whether there is something to read: a file, a pipe, /dev/stdin."""
    try:
        if path.exists():
            return not path.is_dir()
        looked_for(path)
        return False
    except PermissionError:  # reading it says so
        return True
    except OSError:  # a name that no file can have
        return False


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except OSError:
        return False


def _siblings(path: Path) -> list[str]:
    try:
        return [p.name for p in path.parent.glob("*.y*ml")]
    except OSError:
        return []


def _text(path: Path, waited_for: bool = False) -> str:
    try:
        return text_of_file(path, waited_for=waited_for)
    except OSError as error:
        why = error.strerror or error
        raise UsageError(f"pipeline file {str(path)!r} cannot be read: {why}") from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise UsageError(
            f"pipeline file {str(path)!r} cannot be read: it is not UTF-8 text "
            f"(byte 0x{error.object[error.start]:02x} in line {line}); save it as UTF-8"
        ) from None


def _shown(path: Path) -> str:
    """Return the path as short as it can be said from here."""
    try:
        return str(path.relative_to(Path.cwd()))
    except (ValueError, OSError):  # elsewhere, or here is a folder that was deleted
        return str(path)


def _build(
    text: str,
    file: str,
    registry: Registry,
    overrides: Overrides,
    source: SourceOverride,
    opened: Opened,
) -> Graph:
    document = read_document(text, file)
    declaration = declare(document)
    if document.problems and not declaration.nodes:
        raise PipelineError(_ordered(document.problems))
    files = opened.files
    inside = opened._replace(within=(*opened.within, (declaration.name, files.target(file))))

    def load_inner(name: str, inner_overrides: Overrides) -> Graph:
        return _load_inner(name, file, registry, inner_overrides, inside)

    scope = Scope(declaration, registry, load_inner, overrides, files)
    if file not in files.parents:
        files.parents[file] = _parent(declaration.evolves, document, registry)
    declaration.evolves = files.parents[file]
    graph = resolve(scope, source, embedded=bool(opened.within))
    if document.problems:
        raise PipelineError(_ordered(document.problems))
    return graph


def _load_inner(
    name: str, file: str, registry: Registry, overrides: Overrides, opened: Opened
) -> Graph:
    """Return the graph that the pipeline in ``file`` uses by name."""
    names, targets = [n for n, _ in opened.within], [p for _, p in opened.within]
    files = opened.files
    used = files.used.get((file, name))
    path = Path(files.place(used.file)) if used else _find_used(name, file, registry, names)
    target = path.resolve()
    _refuse_circle(names, targets, target)
    if len(names) > MOST_LEVELS:
        raise UsageError(f"pipelines use each other more than {MOST_LEVELS} deep")
    if used is None:
        used = files.used[file, name] = Used(_shown(path), _text(path))
    if overrides:
        return _build(used.text, used.file, registry, overrides, None, opened)
    if target not in opened.loaded:
        try:
            opened.loaded[target] = _build(used.text, used.file, registry, {}, None, opened)
        except TactileGraphError as error:
            opened.loaded[target] = error
    came = opened.loaded[target]
    if isinstance(came, Exception):
        raise came
    return came


def _find_used(name: str, file: str, registry: Registry, within: list[str]) -> Path:
    """Return the pipeline file that ``file`` uses by name."""
    if "/" in name and not name.endswith((".yaml", ".yml")):
        raise UsageError(f"{name!r}: a pipeline file ends in .yaml")
    try:
        return find(beside(name, file) or name, registry, file)
    except UsageError:
        _refuse_circle(within, within, name)  # a pipeline's own name, of which there is no other
        raise


def _refuse_circle(names: list[str], opened: Sequence[object], again: object) -> None:
    if again in opened:
        i = opened.index(again)
        loop = " -> ".join((*names[i:], names[i]))
        raise UsageError(f"pipelines use each other in a circle: {loop}")


def _parent(name: str, document: Document, registry: Registry) -> str:
    """Return the name of what a file's pipeline evolves from, as it is understood elsewhere too."""
    if not name:
        return name
    if beside(name, document.file) is not None:
        return name
    try:
        return registry.spelled("pipelines", name, document.file)
    except UsageError as error:
        document.problem(f"'evolves': {error}", "evolves")
        return name


def evolves_in_circle(graph: Graph) -> str:
    """Return the names of pipelines that evolve from each other, ``a -> b -> a``; "" of none."""
    registry, name = graph.registry or installed(), graph.evolves
    file = Path(_shown(Path(graph.files.place(graph.file))))
    names, files = [graph.name], [file.resolve()]
    while name:
        try:
            file = beside(name, file) or find(name, registry, str(file))
            document = read_document(text_of_file(file), str(file))
        except (TactileGraphError, OSError, UnicodeDecodeError):  # told where that one is loaded
            return ""
        if file.resolve() in files:
            i = files.index(file.resolve())
            return " -> ".join((*names[i:], names[i]))
        declaration = declare(document)
        names.append(declaration.name)
        files.append(file.resolve())
        name = declaration.evolves
    return ""


def _ordered(problems: list[Any]) -> list[Any]:
    return sorted(
        problems, key=lambda p: (p.mark.file, p.mark.line, p.mark.column) if p.mark else ("", 0, 0)
    )
