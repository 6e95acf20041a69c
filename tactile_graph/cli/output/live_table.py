"""A table that grows a row a frame: its columns are laid out before the first row."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from rich.cells import cell_len, set_cell_size
from rich.console import Console
from rich.text import Text

from tactile_graph.api.result import Result
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Failed
from tactile_graph.engine.tables.columns import Column, OutputColumns, values_of
from tactile_graph.foreign_text import visible

GAP = "  "
ERRORS = "error"
LONGEST_LABEL = 32
STAY = ("name", "kind", "probability")
"""Fields of an output that give way last: what it is, and how surely."""
DECIMALS = {"cm": 3, "°": 1, "s": 3, "ms": 2, "µs": 1}


def shown(value: Any, unit: str = "") -> str:
    """Return a scalar as tables show it."""
    if value is None:
        return ""
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    if isinstance(value, float | np.floating):
        digits, value = DECIMALS.get(unit), float(value)
        # Seconds may count from long ago: their decimals are what tells one frame from the next.
        most = 1e11 if unit == "s" else 1e4
        return f"{value:.5g}" if digits is None or abs(value) >= most else f"{value:.{digits}f}"
    return visible(str(value))


@dataclass
class _Cell:
    column: Column
    width: int

    def text(self, value: Any) -> str:
        text = shown(value, self.column.unit)
        if self.column.kind is str:
            return set_cell_size(_cut(text, self.width), self.width)
        return " " * (self.width - cell_len(text)) + text


@dataclass
class _Block:
    """One output's columns under its name, its errors under theirs."""

    output: OutputColumns
    cells: list[_Cell]
    errors: list[_Cell]

    @property
    def name(self) -> str:
        """What stands over the columns; nothing where the output is a bare number."""
        return self.output.output if self.cells[0].column.field else ""

    @property
    def all(self) -> list[_Cell]:
        return self.cells + self.errors

    @property
    def width(self) -> int:
        return _width(self.all)


class LiveTable:
    """Rows for people, printed as they come.

    Parameters
    ----------
    console : Console
    outputs : list of OutputColumns
    first : Result
        Decides whether time, label and errors have columns.
    """

    def __init__(self, console: Console, outputs: list[OutputColumns], first: Result) -> None:
        self.console = console
        frame = first.frame
        lead = [Column("frame", "", "frame", "", int)]
        if frame.time_s is not None:
            lead.append(Column("time_s", "", "time", "s", float))
        if frame.label:
            lead.append(Column("label", "", "label", "", str))
        self.lead = [_cell(c) for c in lead]
        if frame.time_s is not None:
            self.lead[1].width = max(self.lead[1].width, len(shown(frame.time_s, "s")))
        if frame.label:
            self.lead[-1].width = min(LONGEST_LABEL, max(len("label"), cell_len(frame.label)))
        known = frame.truth is not None
        self.blocks = [_block(o, errors=known and bool(o.errors)) for o in outputs]
        self.hidden = self._fit(first)
        self._failed: dict[str, tuple[str, int]] = {}
        self._head()

    def _fit(self, first: Result) -> list[Column]:
        """Take columns for which the terminal has no room from the outputs that have most.

        Those go first that are empty in the first row, unless an output has no value there: what
        it leaves empty then, as the place of what does not lie there yet, may well come.
        """
        columns = [c.column for b in self.blocks for c in b.all]
        whole = not any(first.outcome(b.output.output).__class__ in NO_VALUE for b in self.blocks)
        empty = {c.key for b in self.blocks for c in _empty(first, b.output) if whole}

        def rank(cells: list[_Cell], at: int) -> tuple[bool, bool, int]:
            column = cells[at].column
            return column.key in empty, column.field not in STAY, at

        hidden: list[Column] = []
        while self.blocks and self._width() > self.console.width:
            widest = max(reversed(self.blocks), key=lambda b: len(b.all))
            cells = widest.errors if len(widest.cells) == 1 and widest.errors else widest.cells
            last = max(range(len(cells)), key=partial(rank, cells))
            hidden.append(cells.pop(last).column)
            self.blocks = [b for b in self.blocks if b.cells]
            for block in self.blocks:
                _widen(block.cells, block.name)
        return sorted(hidden, key=columns.index)

    def _width(self) -> int:
        return _width(self.lead) + sum(b.width + len(GAP) for b in self.blocks)

    def _head(self) -> None:
        lead = " " * _width(self.lead)
        names = Text(lead)
        for block in self.blocks:
            self._group(names, block.cells, block.name, "bold")
            self._group(names, block.errors, ERRORS, "bold magenta")
        cells = [*self.lead, *(c for b in self.blocks for c in b.all)]
        fields = Text(GAP.join(_aligned(c, c.column.field or c.column.output) for c in cells))
        units = Text(GAP.join(_aligned(c, c.column.unit) for c in cells), style="dim")
        for line in (names, fields, units):
            if line.plain.strip():
                self._print(line)
        self._print(Text("─" * min(len(fields.plain), self.console.width), style="dim"))

    def _group(self, line: Text, cells: list[_Cell], name: str, style: str) -> None:
        if cells:
            line.append(GAP)
            line.append(set_cell_size(_cut(name, _width(cells)), _width(cells)), style=style)

    def row(self, result: Result) -> None:
        """Print a frame's row; where an output has no value, why: the same failure in full once."""
        frame = result.frame
        lead = {"frame": frame.index, "time_s": frame.time_s, "label": frame.label}
        line = Text(GAP.join(c.text(lead[c.column.key]) for c in self.lead))
        for i, block in enumerate(self.blocks):
            line.append(GAP)
            outcome = result.outcome(block.output.output)
            if outcome.__class__ in NO_VALUE:
                last = i == len(self.blocks) - 1
                room = self.console.width - cell_len(line.plain) if last else block.width
                text = self._why(block.output.output, outcome, frame.index)
                text = _cut(text, room).ljust(0 if last else block.width)
                line.append(text, style="red" if isinstance(outcome, Failed) else "yellow")
            else:
                values = values_of(result, block.output)
                for j, cell in enumerate(block.all):
                    style = "magenta" if cell.column.error else ""
                    line.append(GAP if j else "")
                    line.append(cell.text(values.get(cell.column.key)), style=style)
        self._print(line)

    def _why(self, output: str, outcome: Any, frame: int) -> str:
        reason = " ".join(outcome.reason.split())
        if not isinstance(outcome, Failed):
            return f"skipped: {reason}"
        told, first = self._failed.setdefault(output, (reason, frame))
        if told != reason:
            self._failed[output] = (reason, frame)
        elif first != frame:
            reason = f"as in frame {first}"
        return f"failed: {reason}"

    def _print(self, line: Text) -> None:
        line.rstrip()
        self.console.print(line, no_wrap=True, overflow="ignore", crop=False)


def _block(output: OutputColumns, errors: bool) -> _Block:
    values = list(output.values) or [Column(output.output, output.output, "", "", str)]
    block = _Block(output, [_cell(c) for c in values], [])
    _widen(block.cells, block.name)
    if errors:
        block.errors = [_cell(c) for c in output.errors]
    return block


def _empty(result: Result, output: OutputColumns) -> list[Column]:
    """Return the columns of an output's value that it leaves empty."""
    values = values_of(result, output)
    return [c for c in output.values if values.get(c.key) is None]


def _widen(cells: list[_Cell], name: str) -> None:
    """Make room for the name that stands over the cells."""
    cells[0].width += max(0, cell_len(name) - _width(cells))


def _cell(column: Column) -> _Cell:
    kind = column.kind
    least = 14 if kind is str else 5 if issubclass(kind, int | np.integer) else 7
    if issubclass(kind, float | np.floating) and column.unit not in DECIMALS:
        least = 9
    return _Cell(column, max(least, len(column.field or column.output), len(column.unit)))


def _aligned(cell: _Cell, text: str) -> str:
    return text.ljust(cell.width) if cell.column.kind is str else text.rjust(cell.width)


def _width(cells: list[_Cell]) -> int:
    return sum(c.width for c in cells) + len(GAP) * max(0, len(cells) - 1)


def _cut(text: str, width: int) -> str:
    return text if cell_len(text) <= width else set_cell_size(text, max(0, width - 1)) + "…"
