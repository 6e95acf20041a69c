"""The pipeline that is worked on: its file, what is set on the page, and the YAML of both."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from tactile_graph import Pipeline, load
from tactile_graph.errors import PipelineError, TactileGraphError, UsageError, shown, text_of
from tactile_graph.foreign_text import visible
from tactile_graph_live.server.messages import Fault
from tactile_graph_live.server.watching import Contents
from tactile_graph_live.server.yaml_settings import Settings, text_with

MOST_FAULTS = 50
LONGEST_FAULT = 2000
LONGEST_NAME = 100


@dataclass(frozen=True)
class Draft:
    """A pipeline and how it came to be: text, what the command line said, what the page set.

    Parameters
    ----------
    pipeline : Pipeline
    base : str
        The file's text.
    given : mapping
        What the command line set, node -> setting -> value.
    set_here : mapping
        What was set on the page.
    source_files : mapping
        The files that the source names, but for recordings, and what stands in them.
    """

    pipeline: Pipeline
    base: str
    given: Settings = field(default_factory=dict)
    set_here: Settings = field(default_factory=dict)
    source_files: Contents = field(default_factory=dict)

    @classmethod
    def of(cls, pipeline: Pipeline) -> Draft:
        """Return the draft of a pipeline as a command line opened it.

        Raises
        ------
        UsageError
            If the file is spelled so that the settings given there cannot be written into it.
        """
        return cls(pipeline, pipeline.text, pipeline.overrides)._spelled()

    @cached_property
    def text(self) -> str:
        """The YAML of the pipeline as it runs, but for what the command line says of its source.

        Raises
        ------
        UsageError
            If the file is spelled so that its settings cannot be written into it; no draft is
            given out that has no text.
        """
        return text_with(self.base, _merged(self.given, self.set_here))

    def read_again(self) -> Draft:
        """Return the draft of the file as it is now; the file wins over what the page set.

        Raises
        ------
        TactileGraphError
            If it is wrong.
        """
        fresh = load(Path(self.pipeline.file))
        return Draft(self._resolved(fresh, self.given), fresh.text, self.given)._spelled()

    def with_value(self, node: str, setting: str, value: Any) -> Draft:
        """Return the draft with a setting changed on the page.

        Raises
        ------
        TactileGraphError
            If that is not allowed, or names a file outside the folders of the pipeline and of the
            program: what is wrong with a file is told by lines of it.
        """
        folders = [Path(self.pipeline.file).resolve().parent, Path.cwd()]
        if value != self.given.get(node, {}).get(setting):
            for text in texts_in(value):
                if leads_out(text, folders):
                    raise UsageError(
                        f"{node}.{setting}: {shown(text)} leads out of {folders[-1]}; on the page "
                        "only files in there can be named: others go into the pipeline's file"
                    )
        here = _merged(self.set_here, {node: {setting: value}})
        return self._set(here)

    def without_values(self, node: str = "", setting: str = "") -> Draft:
        """Return the draft as file and command line have it, in one setting or, if "", in all."""
        if not node:
            return self._set({})
        here = {n: {s: v for s, v in values.items() if (n, s) != (node, setting)}
                for n, values in self.set_here.items()}  # fmt: skip
        return self._set(here)

    @cached_property
    def file_text(self) -> str:
        """The YAML without what was set on the page."""
        return text_with(self.base, self.given)

    def _set(self, here: Settings) -> Draft:
        pipeline = self._resolved(self.pipeline, _merged(self.given, here))
        return replace(self, pipeline=pipeline, set_here=here)._spelled()

    def _spelled(self) -> Draft:
        """Return the draft, whose YAML is made now: it is too late once the pipeline runs."""
        _ = self.text, self.file_text
        return self

    def _resolved(self, pipeline: Pipeline, settings: Settings) -> Pipeline:
        """Return a pipeline with these settings alone, and the command line's source."""
        flat = {f"{n}.{s}": v for n, values in settings.items() for s, v in values.items()}
        source = self.pipeline.source_override
        if not (flat or source or pipeline.overrides):
            return pipeline
        return replace(pipeline, overrides={}).with_settings(flat, source)

    def same_source(self, other: Draft) -> bool:
        """Return whether two drafts take their frames from the same source, its files the same."""
        ours, theirs = self.pipeline.source, other.pipeline.source
        if ours is None or theirs is None:
            return ours is theirs
        return (ours.name, repr(ours.settings), self.source_files) == (
            theirs.name, repr(theirs.settings), other.source_files
        )  # fmt: skip


def _merged(first: Settings, second: Settings) -> dict[str, dict[str, Any]]:
    merged = {node: dict(values) for node, values in first.items()}
    for node, values in second.items():
        merged.setdefault(node, {}).update(values)
    return merged


def texts_in(value: Any) -> Iterator[str]:
    """Yield the texts of a setting's value, those of its items too."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from texts_in(item)
    elif isinstance(value, list | tuple):
        for item in value:
            yield from texts_in(item)


def leads_out(text: str, folders: Sequence[Path]) -> bool:
    """Return whether a text, as the path of a file from each folder, lies in none of them."""
    try:
        path = Path(text).expanduser()
        found = [(folder / path).resolve() for folder in folders]
    except (OSError, ValueError, RuntimeError):  # too long, or of no user: no file anybody has
        return False
    return not all(any(p.is_relative_to(folder) for folder in folders) for p in found)


def faults(error: BaseException, file: str) -> tuple[Fault, ...]:
    """Return what is wrong, each with its place if that is in the file."""
    if isinstance(error, PipelineError):
        found = []
        for problem in error.problems[:MOST_FAULTS]:
            mark, text = problem.mark, visible(problem.message)[:LONGEST_FAULT]
            if mark is None or mark.file != file:
                found.append(Fault(0, 0, f"{mark}: {text}" if mark else text))
            else:
                found.append(Fault(mark.line, mark.column, text))
        return tuple(found)
    text = str(error) if isinstance(error, TactileGraphError) else _raw(error)
    return (Fault(0, 0, visible(text)[:LONGEST_FAULT]),)


def _raw(error: BaseException) -> str:
    return f"{type(error).__name__}: {text_of(error)}".removesuffix(": ")


def save(folder: Path, name: str, text: str, file: str) -> Path:
    """Write a pipeline into a folder; a file that is there stays.

    Parameters
    ----------
    folder : Path
    name : str
    text : str
    file : str
        Where the pipeline was read: what it names beside that is named from the folder.

    Raises
    ------
    UsageError
        If the name is no plain name of a file, one of it is there, it cannot be written, or the
        pipeline would be wrong there.
    """
    from tactile_graph.files import write_whole
    from tactile_graph.inspect import moved

    stem = name.removesuffix(".yml").removesuffix(".yaml")
    if len(stem) > LONGEST_NAME:
        raise UsageError(
            f"'{visible(name)[:20]}…': a name is of letters, digits, '-', '_' and '.', "
            f"{LONGEST_NAME} at most, got {len(stem)}"
        )
    if not stem or not all(c.isascii() and (c.isalnum() or c in "-_.") for c in stem) or (
        stem.startswith((".", "-"))
    ):  # fmt: skip
        raise UsageError(
            f"{visible(name)!r}: a name is of letters, digits, '-', '_' and '.', without a folder"
        )
    path = folder / f"{stem}.yaml"
    if path.exists() or path.is_symlink():
        raise UsageError(f"{path.name} is there already; choose another name")
    write_whole(path, moved(text, file, path))
    return path
