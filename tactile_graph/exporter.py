"""What a plugin offers that writes what runs come to: `Exporter`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, BinaryIO, Literal, NamedTuple, Protocol

from tactile_graph.files import check_target

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.api.result import Result
    from tactile_graph.engine.blocks.block import Block
    from tactile_graph.engine.tables.table import Table


class Writer(Protocol):
    """Takes results while they come.

    A writer may have ``close_early``, called in place of ``close`` where a run ended early, so that
    an older, whole file stays. It may say in ``lies_at``, a str, under which other name what it
    writes lies meanwhile, or then, and in ``stays``, a str, what of the older one stays.
    """

    broken: bool
    """Whether something could not be written; a writer without it leaves nothing out."""

    def write(self, result: Result) -> None:
        """Take in a frame; raises `UsageError` if it cannot be written."""

    def close(self) -> None:
        """Write what is left."""


def write_block(writer: Writer, block: Block[Result]) -> None:
    """Have several frames written: at once by a writer that has a method ``write_block``.

    Raises
    ------
    UsageError
        As of `Writer.write`.
    """
    at_once = getattr(writer, "write_block", None)
    if at_once is not None:
        at_once(block)
        return
    for result in block:
        writer.write(result)


def close_early(writer: Writer) -> None:
    """Close the writer of a run that ended early, by its method ``close_early`` if it has one.

    Raises
    ------
    UsageError
        If what is left cannot be written.
    """
    getattr(writer, "close_early", writer.close)()


class Export(NamedTuple):
    """What is to be written.

    Attributes
    ----------
    name : str
        A file's path, or ``-`` for stdout.
    pipeline : Pipeline
    asked : tuple of str
        Outputs or nodes, in order.
    full : bool
        Whether every field and array of records is, where the form has a place for them.
    table : Table, optional
        The columns, with their units, and what makes rows of results, where the form holds numbers.
    """

    name: str
    pipeline: Pipeline
    asked: tuple[str, ...]
    full: bool = False
    table: Table | None = None


def check_plain(name: str) -> None:
    """Refuse a file that could not be written in the end; stdout always can."""
    if name != "-":
        check_target("-o", name)


Holds = Literal["records", "numbers", "images"]


class Exporter(NamedTuple):
    """How ``run`` writes files of one form.

    Attributes
    ----------
    called : str
        As people call such a file: ``"CSV"``.
    holds : str
        ``"records"``, whole or by their summary; single ``"numbers"``, a row a frame or object; or
        the ``"images"`` of nodes.
    opened : callable
        Returns who takes the results.
    check : callable
        Refuses a name, or that something is not installed, before the work; raises `UsageError`.
    joined : callable, optional
        ``joined(parts, file)`` writes one file of those that several workers wrote, each of some
        frames, in order. None where such files cannot be joined: one process then writes them.
    """

    called: str
    holds: Holds
    opened: Callable[[Export], Writer]
    check: Callable[[str], None] = check_plain
    joined: Callable[[Iterator[bytes], BinaryIO], None] | None = None
