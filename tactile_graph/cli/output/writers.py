"""Write results as they come, as JSON lines or CSV; lines are whole."""

from __future__ import annotations

import json
import math
import os
import stat
import sys
from collections.abc import Iterable, Iterator
from contextlib import nullcontext, suppress
from pathlib import Path
from typing import Any, BinaryIO, NoReturn, Protocol

from tactile_graph.api.result import Result
from tactile_graph.cli.interrupt import reader_awaited
from tactile_graph.cli.output.column_texts import csv_lines, number_texts
from tactile_graph.cli.output.older import stays, unfinished_by
from tactile_graph.cli.output.one_run import held_alone, opened_alone
from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.outcomes.notices import untold
from tactile_graph.engine.outcomes.outcome import NO_VALUE
from tactile_graph.engine.tables.block_columns import parts_of, plain_fields
from tactile_graph.engine.tables.rows import as_data, without_nan
from tactile_graph.engine.tables.table import Table
from tactile_graph.engine.tables.truth import errors_against, nearest
from tactile_graph.errors import UsageError
from tactile_graph.exporter import Export, Exporter, Writer
from tactile_graph.files import is_plain, said
from tactile_graph.foreign_text import csv_line, visible
from tactile_graph.part_files import put_over
from tactile_graph.provenance import sidecar
from tactile_graph.wires.stacks import Column, Stack


class Lines(Protocol):
    """A format of one line a frame."""

    def head(self) -> str:
        """Return what stands before the first frame."""

    def line(self, result: Result) -> str:
        """Return a frame's line, its end included."""

    def of_block(self, block: Block[Result]) -> str:
        """Return the lines of several frames, as `line` gives each."""


class JsonLines:
    """One JSON object a frame: outputs, errors where the truth is known, the truth.

    Parameters
    ----------
    full : bool
        Whether records give every field and every array, or their summary.
    """

    def __init__(self, full: bool = False) -> None:
        self.full = full

    def head(self) -> str:
        """Return nothing: every line is a frame."""
        return ""

    def line(self, result: Result) -> str:
        """Return a frame's line."""
        row = without_nan(json_row(result, self.full))
        return visible(json.dumps(row, ensure_ascii=False, allow_nan=False)) + "\n"

    def of_block(self, block: Block[Result]) -> str:
        """Return the lines of several frames: of one text with gaps, where outputs are numbers."""
        lines = [""] * len(block)
        names = list(block.plan.asked)
        frames = block.frames
        heads = _json_heads(frames.index.tolist(), frames.times_s)
        left = frames.says_more.copy()
        for part in parts_of(block, names):
            texts = [_json_outputs(part.outcomes[name]) for name in names]
            told = [text for text in texts if text is not None]
            if len(told) < len(texts):
                continue
            keys = [json.dumps(name, ensure_ascii=False) for name in names]
            form = ", ".join(f"{key.replace('%', '%%')}: %s" for key in keys)
            for row, outputs in zip(part.rows.tolist(), zip(*told, strict=True), strict=True):
                lines[row] = f'{heads[row]}"outputs": {{{form % outputs}}}}}'
        for row, line in enumerate(lines):
            if left[row] or not line:
                lines[row] = self.line(block[row])[:-1]
        return visible("\n".join([*lines, ""]))


def json_row(result: Result, full: bool) -> dict[str, Any]:
    """Return a result as plain data, records in full or by their summary."""
    frame = result.frame
    row: dict[str, Any] = {"frame": frame.index}
    if frame.label:
        row["label"] = frame.label
    if frame.time_s is not None:
        row["time_s"] = frame.time_s
    if frame.device_time_s is not None:
        row["device_time_s"] = frame.device_time_s
    if frame.gap:
        row["gap"] = True
    if frame.doubtful:
        row["doubtful"] = True
    if decisions := result.decisions:
        row["deadline"] = list(decisions)
    outcomes = {name: result.outcome(name) for name in result.plan.asked}
    row["outputs"] = {name: _told(name, outcome, full) for name, outcome in outcomes.items()}
    if frame.truth is None:
        return row
    errors = {}
    for name, outcome in outcomes.items():
        true = nearest(outcome, frame.truth) if outcome.__class__ not in NO_VALUE else None
        if true is not None:
            errors[name] = errors_against(outcome, true)
    row["errors"] = errors
    row["truth"] = [{"kind": type(t.shape).__name__, **as_data(t, full)} for t in frame.truth]
    return row


def _told(name: str, outcome: Any, full: bool) -> Any:
    """Return an output's outcome as plain data."""
    try:
        return as_data(outcome, full)
    except Exception as error:  # a plugin's own code may raise anything
        raise untold(name, "line of JSON", error) from error


def _json_heads(numbers: list[int], times_s: list[float | None]) -> list[str]:
    """Return how the line of each frame begins."""
    return [
        f'{{"frame": {n}, ' if t is None else f'{{"frame": {n}, "time_s": {_json_number(t)}, '
        for n, t in zip(numbers, times_s, strict=True)
    ]


def _json_outputs(outcomes: Stack | list[Any]) -> list[str] | None:
    """Return each frame's outcome as JSON; None where no array knows what it is made of."""
    if not isinstance(outcomes, Stack):
        told = {o: json.dumps(as_data(o), ensure_ascii=False) for o in set(outcomes)}
        return [told[o] for o in outcomes]
    if isinstance(outcomes, Column):
        return [*map(_json_number, outcomes.values.tolist())]
    found = plain_fields(outcomes)
    if found is None:
        return None
    kind, fields = found
    parts = [f'"kind": {json.dumps(kind)}'] if kind else []
    parts += [f"{json.dumps(name)}: %s" for name in fields]
    form = "{" + ", ".join(parts) + "}"
    columns = [_json_numbers(column) for column in fields.values()]
    return [form % row for row in zip(*columns, strict=True)]


def _json_numbers(numbers: list[Any]) -> Iterable[str]:
    """Return numbers as JSON has them, one type throughout as a rule."""
    kinds = {number.__class__ for number in numbers}
    if kinds == {int} or (kinds == {float} and all(map(math.isfinite, numbers))):
        return number_texts(numbers)
    return map(_json_number, numbers)


def _json_number(number: Any) -> str:
    return json.dumps(without_nan(number), ensure_ascii=False)


class Csv:
    """Rows of a table; the columns follow from the types of the outputs, whatever a frame gave.

    Parameters
    ----------
    table : Table
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        self.names = [column.key for column in table.columns]

    def head(self) -> str:
        """Return the line of names."""
        return csv_line(self.names)

    def line(self, result: Result) -> str:
        """Return a frame's rows; empty cells where an output has no value."""
        rows = self.table.rows(result)
        return "".join(csv_line([row.get(name) for name in self.names]) for row in rows)

    def of_block(self, block: Block[Result]) -> str:
        """Return the rows of several frames."""
        columns = self.table.of_block(block)
        return csv_lines([columns[name] for name in self.names])


def _stdout_for_itself() -> tuple[BinaryIO, bool]:
    """Return stdout as a file that stays it, whatever takes its name and descriptor meanwhile.

    And whether it is to be closed in the end: whoever reads a pipe waits for that.
    """
    sys.stdout.flush()
    try:
        return open(os.dup(sys.stdout.fileno()), "wb"), True
    except (OSError, ValueError, AttributeError):  # stdout is no file, as in tests
        return sys.stdout.buffer, False


def is_regular(file: BinaryIO) -> bool:
    """Return whether a file is a plain one: no pipe, no device, nothing of a program's own."""
    try:
        return stat.S_ISREG(os.fstat(file.fileno()).st_mode)
    except (OSError, ValueError, AttributeError):  # stdout is no file, as in tests
        return False


class LineFile:
    """A file, or stdout, that takes whole lines; made when the first one comes.

    Where there is an older, whole one, it lies beside that until it is closed.

    Parameters
    ----------
    output : str
        Path, or ``-`` for stdout.
    lines : Lines
    at_once : bool
        Whether it replaces an older one with its first line.
    """

    def __init__(self, output: str, lines: Lines, at_once: bool = False) -> None:
        self.output = output
        self.lines = lines
        self.lies_at = output
        """Where it lies."""
        self.stays = ""
        """What is to be said of an older one that stays."""
        self._at_once = at_once
        self._older: BinaryIO | None = None
        self._stdout: BinaryIO | None = None
        self._is_closed = True
        if output == "-":
            self._stdout, self._is_closed = _stdout_for_itself()
        self.broken = False
        """Whether a line could not be written."""
        self._file: BinaryIO | None = None
        self._waits = False
        """Whether it is no plain file: what is written waits for who reads it."""
        self._n_lines = 0
        self._n_bytes = 0

    @property
    def keeps(self) -> bool:
        """Whether what is written stays where a run ends early: there is a file by then."""
        return self._file is not None

    def write(self, result: Result) -> None:
        """Write a frame's line through to the file.

        Raises
        ------
        UsageError
            If it cannot be written; of a file, whole lines are left.
        """
        line = self.lines.line(result)  # before there is a file: a plugin's value may break it
        self._put(self._file or self.open(), line)
        self._n_lines += 1

    def write_block(self, block: Block[Result]) -> None:
        """Write the lines of several frames through to the file; errors as of `write`."""
        lines = self.lines.of_block(block)
        self._put(self._file or self.open(), lines)
        self._n_lines += len(block)

    def open(self) -> BinaryIO:
        """Open the file and write what stands before the first frame.

        Raises
        ------
        UsageError
            If another run is writing it, or it cannot be written.
        """
        if self._file is None:
            try:
                self._file = self._stdout or self._opened()
            except KeyboardInterrupt:
                self.broken = not is_plain(self.output)  # nobody may ever read that pipe
                raise
            self._waits = not is_regular(self._file)
            self._put(self._file, self.lines.head())
        return self._file

    def _opened(self) -> BinaryIO:
        beside = "" if self._at_once else unfinished_by(self.output)
        if not beside:
            return opened_alone(self.output)
        self._older = held_alone(self.output)  # as if it were written: others are refused
        self.lies_at = beside
        return opened_alone(beside)

    def close(self) -> None:
        """Close the file; one without any frame still gets its head."""
        if self.broken:
            return
        file = self.open()
        if self._is_closed:
            with said(self.lies_at):
                if self._older is not None:
                    os.fsync(file.fileno())  # or a power cut may leave the name without the content
                    with suppress(OSError):  # a file system may have no such modes
                        os.chmod(self.lies_at, stat.S_IMODE(os.fstat(self._older.fileno()).st_mode))
                file.close()
        if self._older is not None:
            with said(self.output, f"all frames are in {self.lies_at}"):
                self._older.close()  # Windows replaces no file that is open
                put_over(Path(self.lies_at), Path(os.path.realpath(self.output)))
            sidecar(self.lies_at).unlink(missing_ok=True)
            self.lies_at = self.output

    def close_early(self) -> None:
        """Close the file; an older one stays, and this one lies beside it."""
        if not self.broken:
            self.open()
        if self._older is not None:
            self._older.close()
            self._older, self.stays = None, stays(self.output)
        self.close()

    def _put(self, file: BinaryIO, text: str) -> None:
        data = memoryview(text.encode())
        size = len(data)
        try:
            with reader_awaited() if self._waits else nullcontext():
                while data:
                    data = data[file.write(data) :]
                file.flush()
        except BrokenPipeError:
            raise
        except KeyboardInterrupt:
            self._leave_off(file)
            raise
        except OSError as error:
            self._give_up(file, error)
        self._n_bytes += size

    def _leave_off(self, file: BinaryIO) -> None:
        """Leave whole lines of a file that it opened.

        A pipe is left as it is, for nobody may take the rest of a line, and so is stdout: its file
        may hold what others wrote.
        """
        if not self._waits and self.output != "-":
            os.ftruncate(file.fileno(), self._n_bytes)
            return
        self.broken = True
        if self._is_closed:
            getattr(file, "raw", file).close()  # or what is left would be written now

    def _give_up(self, file: BinaryIO, error: OSError) -> NoReturn:
        self.broken = True
        why = f"cannot be written: {error.strerror or error}"
        if self.output == "-":
            if self._is_closed:
                with suppress(OSError):  # it still holds what was refused
                    file.close()
            raise UsageError(f"stdout {why}") from error
        if is_plain(self.lies_at):
            os.ftruncate(file.fileno(), self._n_bytes)
        file.close()
        n = self._n_lines
        whole = f"the first {n} frames are" if n > 1 else "the first frame is"
        kept = f"{whole} in it, and no part of another" if n else "no frame is in it"
        if self._older is not None:
            kept += f"; {stays(self.output)}"
        raise UsageError(f"{self.lies_at}: {why}; {kept}") from error


def _json_lines(export: Export) -> Writer:
    return _line_file(export, JsonLines(export.full))


def _csv(export: Export) -> Writer:
    assert export.table is not None  # it holds numbers
    return _line_file(export, Csv(export.table))


def _line_file(export: Export, lines: Lines) -> LineFile:
    from tactile_graph.cli.many.made_of import device

    # What a device gives is followed while it comes, under its name.
    return LineFile(export.name, lines, at_once=bool(device(export.pipeline)))


def _joined_lines(parts: Iterator[bytes], file: BinaryIO) -> None:
    for part in parts:
        file.write(part)
        file.flush()  # whoever reads stdout waits for whole lines


def _joined_csv(parts: Iterator[bytes], file: BinaryIO) -> None:
    """Write lines under one line of names, the first part's."""

    def without_names() -> Iterator[bytes]:
        for i, part in enumerate(parts):
            yield part if i == 0 else part[part.index(b"\n") + 1 :]

    _joined_lines(without_names(), file)


JSON_LINES = Exporter("JSON lines", "records", _json_lines, joined=_joined_lines)
CSV = Exporter("CSV", "numbers", _csv, joined=_joined_csv)
