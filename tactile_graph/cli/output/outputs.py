"""What a run writes for programs: in which form, refused before the work where it cannot be."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.errors import PluginError, TactileGraphError, UsageError, did_you_mean
from tactile_graph.exporter import Export, Exporter, Writer, close_early, write_block
from tactile_graph.files import is_plain
from tactile_graph.plugins.foreign_code import stdout_again
from tactile_graph.plugins.registry import CORE, installed

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.api.result import Result
    from tactile_graph.engine.blocks.block import Block
    from tactile_graph.engine.tables.table import Table

OFFERS = "exporters"
USUAL = ".jsonl"
FOLDER = ".dataset"
LONGEST_NAME = 255
SCREEN = "a table on the screen"


@dataclass(frozen=True)
class Output:
    """What ``-o``, ``--format``, ``--full`` and ``--long`` ask for.

    Parameters
    ----------
    name : str
        A file, or ``-`` for stdout.
    exporter : Exporter
    full, long : bool
    ending : str
        That files of the exporter have; of one whose ending is another's its qualified name.
    """

    name: str
    exporter: Exporter
    full: bool
    long: bool
    ending: str = USUAL

    @classmethod
    def of(cls, name: str | None, form: str | None, full: bool, long: bool) -> Output | None:
        """Return it, or None where nothing is to be written.

        Raises
        ------
        UsageError
            If the form is not told, or what is asked for has no place in it.
        """
        name = name or ("-" if form else None)
        if name is None:
            for option, told in (("--long", long), ("--full", full)):
                if told:
                    raise UsageError(_no_place(option, SCREEN))
            return None
        ending = _ending(name, form)
        exporter: Exporter = installed().load(OFFERS, ending)
        if long and exporter.holds != "numbers":
            raise UsageError(_no_place("--long", exporter.called, exporter.holds))
        if full and exporter.holds != "records":
            raise UsageError(_no_place("--full", exporter.called, exporter.holds))
        return cls(name.rstrip(f"/{os.sep}") or name, exporter, full, long, ending)

    def check(self) -> None:
        """Refuse what could not be written in the end, before the work."""
        self._check_length(self.name)  # nobody can look for a file of a name that is longer
        with self._named("check"):
            self.exporter.check(self.name)
        if self.name != "-" and is_plain(self.name):
            from tactile_graph.cli.output.older import unfinished_by

            self._check_length(unfinished_by(self.name) or self.name)

    def _check_length(self, name: str) -> None:
        from tactile_graph.provenance import sidecar

        note = sidecar(name).name
        if name != "-" and is_plain(name) and len(os.fsencode(note)) > LONGEST_NAME:
            told = f"the name is too long: of {note}, beside it, file systems take no more than"
            raise UsageError(f"-o {self.name}: {told} {LONGEST_NAME} bytes")

    def writer(self, pipeline: Pipeline, asked: tuple[str, ...]) -> tuple[Writer, Table | None]:
        """Return who writes it, and the table it is, if it is one."""
        table = None
        if self.exporter.holds == "numbers":
            from tactile_graph.engine.tables.table import make_table

            table = make_table(pipeline, asked, self.long)
        export = Export(self.name, pipeline, asked, self.full, table)
        with self._named("opened"):
            writer = self.exporter.opened(export)
        ours = self.name != "-" or installed().offer(OFFERS, self.ending).plugin.name == CORE
        named = _Named(writer, self._named) if ours else _OnStdout(writer, self._on_stdout)
        return named, table

    @contextmanager
    def _on_stdout(self, what: str) -> Iterator[None]:
        """Name the exporter in errors, and have stdout be what it took it for when it began."""
        with self._named(what), stdout_again():
            yield

    @contextmanager
    def _named(self, what: str) -> Iterator[None]:
        """Name the exporter, its plugin and the file in errors that are none of ours."""
        try:
            yield
        except (TactileGraphError, click.ClickException, BrokenPipeError, MemoryError):
            raise
        except Exception as error:  # a plugin's own code may raise anything
            from tactile_graph.engine.outcomes.notices import breaks

            who = (
                f"exporter {self.ending!r} of {installed().offer(OFFERS, self.ending).plugin.label}"
            )
            raise PluginError(f"-o {self.name}: {who}: {breaks(what, error)}") from error


class _Named:
    """An exporter's writer, whose errors name it."""

    def __init__(
        self, writer: Writer, named: Callable[[str], AbstractContextManager[None]]
    ) -> None:
        self._writer = writer
        self._write = writer.write
        self._named = named

    def __getattr__(self, name: str) -> Any:
        return getattr(self._writer, name)  # broken and keeps, where it has them

    def write(self, result: Result) -> None:
        """Take in a frame."""
        try:  # a context would cost a frame as much as a tenth of its line of CSV
            self._write(result)
        except Exception as error:
            with self._named("write"):
                raise error

    def write_block(self, block: Block[Result]) -> None:
        """Take in several frames."""
        with self._named("write"):
            write_block(self._writer, block)

    def close(self) -> None:
        """Write what is left."""
        with self._named("close"):
            self._writer.close()

    def close_early(self) -> None:
        """Write what is left of a run that ended early."""
        with self._named("close"):
            close_early(self._writer)


class _OnStdout(_Named):
    """A writer that took stdout for itself."""

    def write(self, result: Result) -> None:
        """Take in a frame."""
        with self._named("write"):
            self._writer.write(result)


def forms() -> list[str]:
    """Return what ``--format`` takes: the endings of files, without their dots."""
    return [form_of(ending) for ending in _endings()]


def form_of(ending: str) -> str:
    """Return what ``--format`` takes for an exporter by its name: ``csv``, ``mine.csv``."""
    return ending.removeprefix(".")


def _endings() -> list[str]:
    return installed().offered(OFFERS)


def _no_place(option: str, what: str, holds: str = "numbers") -> str:
    if option == "--long":
        why = {
            "a table on the screen": "has a row a frame",
            "JSON lines": "they hold every list already",
        }.get(what, f"holds {holds}")
        return f"--long: {what}: {why}; give -o FILE.csv or -o FILE.parquet"
    why = "holds images" if holds == "images" else "holds single numbers only"
    return f"--full: {what.removesuffix(' on the screen')} {why}; give -o FILE.jsonl or -o -"


def _ending(name: str, form: str | None) -> str:
    """Return the ending that files of the form have, by what is told or by the file's name."""
    if form is not None:
        ending = next((e for e in (f".{form}", form) if installed().has(OFFERS, e)), None)
        if ending is None:
            near = did_you_mean(form, forms())
            missing = installed().missing_plugins()
            raise UsageError(f"--format {form}: is none of {', '.join(forms())}{near}{missing}")
        return ending
    if name.endswith(("/", os.sep)):
        return FOLDER
    if name == "-":
        return USUAL
    path = Path(name)
    known = [e for e in _endings() if e.startswith(".")]
    fitting = [e for e in known if path.name.lower().endswith(e) and len(path.name) > len(e)]
    if fitting:
        return max(fitting, key=len)
    if Path(name).is_dir():
        raise UsageError(
            f"-o {name}: is a folder; name a file in it, or end it in / for a data set of Parquet"
        )
    near = did_you_mean(path.suffix.lower(), known) if path.suffix else ""
    missing = installed().missing_plugins()
    raise UsageError(
        f"-o {name}: its name must end in {', '.join(known)}, or give --format{near}{missing}"
    )
