"""A summary for people: outcomes, quantities, and a row a recording."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

from tactile_graph.cli.output.live_table import shown
from tactile_graph.cli.summary.quantiles import Numbers
from tactile_graph.cli.summary.summary import SHARES, Group, Quantity, Summary, kind
from tactile_graph.vocabulary import words_and_unit

MOST_REASONS = 5
MOST_WORDS = 6
MOST_RECORDINGS = 40
LONGEST_NAME = 36
STYLES = {"ok": "green", "skipped": "yellow", "failed": "red"}
LACKING = ("skipped", "failed")
STATISTICS = ("n", "mean", "5 %", "median", "95 %", "least", "most")
CAN_GO = ("95 %", "5 %", "least", "most", "median")
"""Statistics that a narrow terminal does without, the first first."""
GAP = 2


def show(console: Console, title: str, summary: Summary) -> None:
    """Print a summary, what is of all recordings last."""
    several = len(summary.recordings) > 1
    if several:
        _recordings(console, summary)
    console.print(_head(title, summary), soft_wrap=True)
    for line in _outcomes(summary.all):
        console.print(line, soft_wrap=True)
    _quantities(console, summary)
    for line in _texts(summary.all):
        console.print(line, soft_wrap=True)


def _head(title: str, summary: Summary) -> Text:
    n, frames = len(summary.recordings), summary.frames
    parts = [f"{frames} frame{'' if frames == 1 else 's'}"]
    parts[0] += f" of {n} recordings" if n > 1 else ""
    if summary.lasts_s:
        parts.append(_rate(summary.n_steps, summary.lasts_s))
    return Text.assemble((title, "bold"), ": ", ", ".join(parts))


def _rate(n_steps: int, lasts_s: float) -> str:
    return f"{_lasting(lasts_s)} by their times ({n_steps / lasts_s:.4g} frames a second)"


def _lasting(seconds: float) -> str:
    for size, unit in ((3600.0, "h"), (60.0, "min")):
        if seconds >= 2 * size:
            return f"{seconds / size:.4g} {unit}"
    return f"{seconds:.4g} s"


def _outcomes(group: Group) -> Iterator[Text]:
    """Yield a line for each output, and one for each reason why it has no value."""
    width = max((cell_len(o) for o in group.outcomes), default=0)
    for output, words in group.outcomes.items():
        line = Text(f"{output:<{width}}  ")
        parts = []
        for how, style in STYLES.items():
            n = sum(count for word, count in words.items() if kind(word) == how)
            if n or how == "ok":
                parts.append((f"{n} {'ran' if how == 'ok' else how}", style if n else ""))
        for i, part in enumerate(parts):
            line.append(", " if i else "")
            line.append(*part)
        yield line
        lacking = [(n, word) for word, n in words.most_common() if kind(word) != "ok"]
        for n, word in lacking[:MOST_REASONS]:
            yield Text(f"{'':<{width}}  {n:>6} {word}", STYLES[kind(word)])
        if lacking[MOST_REASONS:]:
            rest = sum(n for n, _ in lacking[MOST_REASONS:])
            more = len(lacking) - MOST_REASONS
            yield Text(f"{'':<{width}}  {rest:>6} for {more} other reasons (--json gives them)")


def _quantities(console: Console, summary: Summary) -> None:
    """Print a row for each quantity, errors last; columns that have no place are left out."""
    told = summary.all.numbers
    quantities = sorted(told, key=lambda q: (_is_error(q), _first_place(told, q)))
    quantities = [q for q in quantities if told[q].n + told[q].n_not_finite]
    if not quantities:
        return
    rows, styles = [], []
    for quantity in quantities:
        numbers, unit = told[quantity], quantity.unit
        found = summary.all.statistics(quantity)
        p5, median, p95 = (found.quantiles[SHARES.index(share)] for share in (0.05, 0.5, 0.95))
        cells = (found.mean, p5, median, p95, found.least, found.most)
        n = str(numbers.n) + (
            f" (+{numbers.n_not_finite} no number)" if numbers.n_not_finite else ""
        )
        rows.append([_called(quantity.key), unit, n, *(_cell(c, unit) for c in cells)])
        styles.append("magenta" if _is_error(quantity) else "")
    kept = _kept(["", "unit", *STATISTICS], rows, console.width)
    table = _table(*kept)
    for row, style in zip(zip(*kept.values(), strict=True), styles, strict=True):
        table.add_row(*row, style=style)
    console.print(table)
    if gone := [name for name in STATISTICS if name not in kept]:
        left_out = f"not shown for want of width: {', '.join(gone)} (--json gives all)"
        console.print(left_out, style="dim", soft_wrap=True)
    if any(map(_is_error, quantities)):
        console.print("errors against the truth are without their sign", style="dim")


def _kept(heads: list[str], rows: list[list[str]], width: int) -> dict[str, list[str]]:
    """Return the columns a console has room for; of the first one words may stand in lines."""
    kept = {h: [row[i] for row in rows] for i, h in enumerate(heads)}
    least = {h: max(map(cell_len, (h, *cells))) for h, cells in kept.items()}
    least[heads[0]] = max(cell_len(word) for name in kept[heads[0]] for word in name.split())
    for name in CAN_GO:
        if sum(least[h] + GAP for h in kept) - GAP <= width:
            break
        del kept[name]
    return kept


def _texts(group: Group) -> Iterator[Text]:
    for key, words in group.texts.items():
        most = [f"{word} {n}" for word, n in words.most_common(MOST_WORDS)]
        more = len(words) - len(most)
        told = ", ".join(most) + (f", and {more} more" if more > 0 else "")
        if told:
            yield Text(f"{_called(key)}: {told}")


def _recordings(console: Console, summary: Summary) -> None:
    """Print a row a recording: the medians of as many quantities as there is room for."""
    told = summary.all.numbers
    quantities = sorted(told, key=lambda q: (not _is_error(q), _first_place(told, q)))
    names = list(summary.recordings)
    chosen = names[:MOST_RECORDINGS]
    head = ["recording", "frames", "lasts", *LACKING]
    longest = min(LONGEST_NAME, console.width // 4)
    rows = [_row(_cut(name, longest), summary.recordings[name]) for name in chosen]
    width = sum(max(cell_len(c) for c in column) + 2 for column in zip(head, *rows, strict=True))
    room, kept = console.width - width, []
    for quantity in quantities:
        cells = [_median(summary.recordings[name], quantity) for name in chosen]
        wide = max(cell_len(c) for c in (*cells, *_stacked(quantity).split("\n"))) + 2
        if wide > room:
            break
        room -= wide
        kept.append((_stacked(quantity), cells))
    table = _table(*head, *(name for name, _ in kept))
    for i, row in enumerate(rows):
        table.add_row(*row, *(cells[i] for _, cells in kept))
    console.print(table)
    said = ["medians"] if kept else []
    if len(kept) < len(quantities):
        n = len(quantities) - len(kept)
        hidden = "1 quantity is" if n == 1 else f"{n} quantities are"
        said.append(f"{hidden} not shown for want of width")
    if len(names) > len(chosen):
        said.append(f"{len(names) - len(chosen)} recordings more")
    console.print("; ".join(said) + " (--json gives all)\n", style="dim", soft_wrap=True)


def _row(name: str, group: Group) -> list[str]:
    lasts = group.times.lasts_s
    counts = [group.ended(how) for how in LACKING]
    return [name, str(group.frames), "" if lasts is None else _lasting(lasts), *map(str, counts)]


def _cut(name: str, longest: int) -> str:
    """Return a name on one line; of a long one its end, which tells it from others."""
    line = name.replace("\n", "\\n").replace("\t", "\\t")
    if cell_len(line) <= longest:
        return line
    while cell_len(line) >= longest:
        line = line[1:]
    return f"…{line}"


def _first_place(told: dict[Quantity, Numbers], quantity: Quantity) -> int:
    """Return the place of a column among all: those of another unit stand beside it."""
    return next(i for i, other in enumerate(told) if other.key == quantity.key)


def _median(group: Group, quantity: Quantity) -> str:
    if quantity not in group.numbers:
        return ""
    median = group.statistics(quantity).quantiles[SHARES.index(0.5)]
    return _cell(float(median), quantity.unit)


def _stacked(quantity: Quantity) -> str:
    """Return a column's head: its output over the quantity over its unit."""
    output, _, field = quantity.key.rpartition(".")
    return "\n".join((output, words_and_unit(field)[0], quantity.unit))


def _called(key: str) -> str:
    output, _, field = key.rpartition(".")
    return f"{output} {words_and_unit(field)[0]}".strip()


def _is_error(quantity: Quantity) -> bool:
    return "_error_" in quantity.key


def _cell(value: float, unit: str) -> str:
    return "" if math.isnan(value) else shown(float(value), unit)


def _table(*heads: str) -> Table:
    table = Table(box=None, pad_edge=False, padding=(0, GAP, 0, 0), header_style="bold")
    for i, head in enumerate(heads):
        left: Any = "left" if i == 0 or head == "unit" else "right"
        table.add_column(head, justify=left, no_wrap=i > 0, overflow="fold", vertical="bottom")
    return table
