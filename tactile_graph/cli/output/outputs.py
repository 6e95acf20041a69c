"""What a run writes for programs: in which form, refused before the work where it cannot be."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph.files import check_target

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.api.result import Result
    from tactile_graph.engine.table import Table

SUFFIXES = {
    ".jsonl": "jsonl", ".ndjson": "jsonl", ".csv": "csv", ".parquet": "parquet",
    ".h5": "hdf5", ".hdf5": "hdf5", ".zarr": "zarr",
}  # fmt: skip
FORMATS = tuple(dict.fromkeys(SUFFIXES.values()))
TABLES = ("csv", "parquet")
STACKS = ("hdf5", "zarr")
_CALLED = {"csv": "CSV", "parquet": "Parquet", "hdf5": "HDF5", "zarr": "a Zarr store"}


class Writer(Protocol):
    """Takes results while they come."""

    broken: bool
    """Whether something could not be written."""

    def write(self, result: Result) -> None:
        """Take in a frame."""

    def close(self) -> None:
        """Write what is left."""


@dataclass(frozen=True)
class Output:
    """What ``-o``, ``--format``, ``--full`` and ``--long`` ask for.

    Parameters
    ----------
    name : str
        A file, or ``-`` for stdout.
    form : str
        One of `FORMATS`.
    full, long : bool
    """

    name: str
    form: str
    full: bool
    long: bool

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
                    raise UsageError(_no_place(option, "a table on the screen"))
            return None
        output = cls(name, form or _by_name(name), full, long)
        if long and output.form not in TABLES:
            what = "JSON lines" if output.form == "jsonl" else _CALLED[output.form]
            raise UsageError(_no_place("--long", what))
        if full and output.form != "jsonl":
            raise UsageError(_no_place("--full", _CALLED[output.form]))
        return output

    def check(self) -> None:
        """Refuse what could not be written in the end, before the work."""
        if self.form == "parquet":
            from tactile_graph.cli.output.parquet import pyarrow

            pyarrow()
        if self.form == "zarr" and self.name != "-":
            from tactile_graph.cli.output.node_images import check_store

            check_store("-o", self.name)
        elif self.name != "-":
            check_target("-o", self.name)

    def writer(self, pipeline: Pipeline, asked: tuple[str, ...]) -> tuple[Writer, Table | None]:
        """Return who writes it, and the table it is, if it is one."""
        if self.form == "jsonl":
            from tactile_graph.cli.output.writers import JsonLines, LineFile

            return LineFile(self.name, JsonLines(self.full)), None
        if self.form in STACKS:
            from tactile_graph.cli.output.node_images import ImageStore, check_nodes

            check_nodes(pipeline, asked)
            return ImageStore(self.name, self.form, pipeline, asked), None
        from tactile_graph.engine.table import make_table

        table = make_table(pipeline, asked, self.long)
        made: Any
        if self.form == "csv":
            from tactile_graph.cli.output.writers import Csv, LineFile

            made = LineFile(self.name, Csv(table))
        else:
            from tactile_graph.cli.output.parquet import ParquetFile

            made = ParquetFile(self.name, table)
        return made, table


def _no_place(option: str, what: str) -> str:
    if option == "--long":
        why = {
            "a table on the screen": "has a row a frame",
            "JSON lines": "they hold every list already",
        }.get(what, "holds images")
        return f"--long: {what}: {why}; give -o FILE.csv or -o FILE.parquet"
    why = "holds images" if what in (_CALLED[f] for f in STACKS) else "holds single numbers only"
    return f"--full: {what.removesuffix(' on the screen')} {why}; give -o FILE.jsonl or -o -"


def _by_name(name: str) -> str:
    suffix = Path(name).suffix.lower()
    if name != "-" and suffix not in SUFFIXES:
        if Path(name).is_dir():
            raise UsageError(f"-o {name}: is a folder; name a file in it")
        near = did_you_mean(suffix, SUFFIXES) if suffix else ""
        raise UsageError(
            f"-o {name}: its name must end in {', '.join(SUFFIXES)}, or give --format{near}"
        )
    return SUFFIXES.get(suffix, "jsonl")
