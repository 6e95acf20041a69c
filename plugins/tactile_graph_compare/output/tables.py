"""The tables of a comparison as plain cells, for terminals and Markdown alike."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from tactile_graph_compare.records.comparison import Comparison, Evolution
from tactile_graph_compare.records.scores import Agreement, Difference, Score
from tactile_graph_compare.score.quantities import decimals, in_order

LEFT = ("variant", "against", "quantity", "verdict", "guard")
"""Columns of words; all others hold numbers."""


@dataclass(frozen=True)
class Table:
    """Rows of cells under a title; where the first cell changes, a new group begins."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""
    can_go: tuple[str, ...] = ()
    """Columns that a narrow terminal does without, the first first."""

    def without(self, column: str) -> Table:
        """Return the table without a column."""
        at = self.columns.index(column)
        rows = tuple((*row[:at], *row[at + 1 :]) for row in self.rows)
        return replace(self, columns=(*self.columns[:at], *self.columns[at + 1 :]), rows=rows)


def tables(comparison: Comparison) -> list[Table]:
    """Return errors, paired differences, agreement and times, those that hold anything."""
    found = [errors(comparison), differences(comparison), agreement(comparison), times(comparison)]
    return [t for t in found if t.rows]


def errors(comparison: Comparison) -> Table:
    """Return how far each variant is off, quantity by quantity."""
    columns = ("quantity", "variant", "mean", "median", "95 %", "largest", "bias", "answers",
               "missing", "extra")  # fmt: skip
    rows = []
    for quantity in comparison.quantities:
        for label in comparison.labels:
            score = comparison.score(label, quantity)
            if score is not None:
                rows.append(_error_row(score))
    note = (
        "* on the Pareto front of mean error and median time: no variant that answers as often "
        "beats it in both"
    )
    can_go = ("extra", "bias", "95 %", "median")
    return Table("Absolute errors", columns, tuple(rows), note if rows else "", can_go)


def _error_row(score: Score) -> tuple[str, ...]:
    parts = (score.mean, score.median, score.p95, score.largest, score.bias)
    return (
        named(score.quantity, score.unit),
        score.variant + (" *" if score.pareto else ""),
        *(number(p, score.unit) for p in parts),
        str(score.n_answered),
        str(score.n_missing),
        str(score.n_extra) if score.quantity in ("centre", "identity") else "",
    )


def differences(comparison: Comparison) -> Table:
    """Return the paired differences of absolute errors."""
    columns = ("quantity", "variant", "against", "mean", "95 % from", "to", "both", "only it",
               "only other", "neither", "verdict")  # fmt: skip
    rows = tuple(
        _difference_row(d)
        for q in comparison.quantities
        for d in comparison.differences
        if d.quantity == q
    )
    methods = ", ".join(sorted({d.method for d in comparison.differences if d.method}))
    note = f"error less the other's where both answered; negative is better; {methods}"
    n = sum(d.p is not None for d in comparison.differences)
    if n > 1:
        note += (
            f"; better, worse: at 95 % for all {n} comparisons together; perhaps: for this one "
            f"alone, as of {n} about {n / 20:.2g} are by luck"
        )
    can_go = ("neither", "only other", "only it", "both", "against", "95 % from", "to")
    return Table("Paired differences", columns, rows, note if rows else "", can_go)


def _difference_row(d: Difference) -> tuple[str, ...]:
    bounds = (signed(x, d.unit) for x in (d.mean, d.low, d.high))
    counts = (d.n_both, d.n_only_variant, d.n_only_reference, d.n_neither)
    return (named(d.quantity, d.unit), d.variant, d.reference, *bounds, *map(str, counts),
            d.verdict)  # fmt: skip


def agreement(comparison: Comparison) -> Table:
    """Return how far the variants lie from one another, quantity by quantity."""
    columns = ("quantity", "variant", "against", "mean", "median", "95 %", "largest", "bias",
               "both", "only it", "only other", "neither")  # fmt: skip
    rows = tuple(
        _agreement_row(a)
        for q in in_order(comparison.units)
        for a in comparison.agreements
        if a.quantity == q
    )
    where = "in every frame" if comparison.reference else "where nobody knows what truly lay there"
    note = f"absolute differences of what both found, {where}; neither: frames"
    can_go = ("neither", "bias", "95 %", "median", "only other", "only it", "against")
    return Table("Agreement", columns, rows, note if rows else "", can_go)


def _agreement_row(a: Agreement) -> tuple[str, ...]:
    parts = (a.mean, a.median, a.p95, a.largest, a.bias)
    counts = (a.n_both, a.n_only_variant, a.n_only_reference, a.n_neither)
    return (
        named(a.quantity, a.unit),
        a.variant,
        a.reference,
        *(number(p, a.unit) for p in parts),
        *("" if n is None else str(n) for n in counts),
    )


def times(comparison: Comparison) -> Table:
    """Return time per frame and what ran."""
    columns = ("variant", "median", "95 %", "by other", "against", "run", "not run", "ok",
               "skipped", "failed")  # fmt: skip
    by_label = {t.variant: t for t in comparison.time_differences}
    rows = []
    for v in comparison.variants:
        against = by_label.get(v.label)
        ran, not_run = v.timeline.ran, v.timeline.not_run
        rows.append(
            (
                v.label,
                us(v.times.median_us),
                us(v.times.p95_us),
                by_other(against.ratio) if against else "",
                against.reference if against else "",
                f"{ran.mean():.1f}" if ran.size else "",
                f"{not_run.mean():.1f}" if not_run.size else "",
                str(v.n_ok),
                str(v.n_skipped),
                str(v.n_failed),
            )
        )
    note = (
        f"µs per frame: the sum of the nodes it needs; beside them {us(comparison.fixed_us)} µs "
        "per frame for all together; by other: median over the frames of its time by the other's, "
        "not the ratio of the medians; run, not run: nodes per frame; ok, skipped, failed: frames"
    )
    can_go = ("against", "ok", "not run", "run", "95 %")
    return Table("Times", columns, tuple(rows), note, can_go)


# -- sentences -------------------------------------------------------------------------------


def heading(comparison: Comparison) -> str:
    """Return what was compared on what."""
    n = len(comparison.variants)
    frames = comparison.frames.n
    text = (
        f"{n} variant{'s' * (n != 1)} on {comparison.source}: {frames} frame{'s' * (frames != 1)}"
    )
    unknown = int((comparison.frames.n_true < 0).sum())
    if frames and unknown == frames:
        text += ", nobody knows what truly lay there"
    elif unknown:
        text += f", {unknown} without a known truth"
    died = left_out(comparison.n_left_out, frames)
    return f"{text}; {died}" if died else text


def left_out(n: int, n_done: int) -> str:
    """Return how many frames are missing of which workers died; nothing where none is."""
    of = n + n_done
    return f"{n} of {of} frame{'s' * (of != 1)} left out: workers died" if n else ""


def saving(comparison: Comparison) -> str:
    """Return what merging saved."""
    s = comparison.saving
    return (
        f"merged into {s.n_nodes_merged} nodes of {s.n_nodes_alone}, {s.n_shared} of them shared: "
        f"{s.merged_s:.3g} s in nodes instead of {s.alone_s:.3g} s, {round(100 * s.share)} % saved"
    )


def evolution_lines(evolution: Evolution) -> Iterator[str]:
    """Yield what a step of the lineage did, the first line naming it."""
    e = evolution
    yield f"{e.parent} → {e.child}"
    if e.added:
        yield f"  added: {', '.join(e.added)}"
    if e.removed:
        yield f"  removed: {', '.join(e.removed)}"
    for change in e.changed:
        yield f"  changed: {change.node} ({'; '.join(map(str, change.changes))})"
    if not (e.added or e.removed or e.changed):
        yield "  no node differs"
    for d in e.differences:
        if d.mean is not None:
            interval = f" [{signed(d.low, d.unit)}, {signed(d.high, d.unit)}]"
            unit = f" {d.unit}" if d.unit else ""
            bounds = interval if d.low is not None else ""
            yield f"  {d.quantity}: {signed(d.mean, d.unit)}{unit}{bounds}, {d.verdict}"
    yield (
        f"  time: {by_other(e.time.ratio)} ({signed_us(e.time.median_us)} µs), medians over the "
        "frames of the time by the parent's, and less it"
    )


def reason_lines(comparison: Comparison, most: int = 3) -> Iterator[tuple[str, str]]:
    """Yield ``skipped``, ``failed`` or ``strange``, where and why; the most frequent of each."""
    for v in comparison.variants:
        for state, output, origin, reason, n in v.reasons[:most]:
            at = f"{origin}: " if origin not in ("", output) else ""
            frames = "1 frame" if n == 1 else f"{n} frames"
            yield state, f"{v.label}, {output} in {frames}: {at}{reason}"
        if len(v.reasons) > most:
            yield "", f"{v.label}: {len(v.reasons) - most} more reasons"


# -- cells -----------------------------------------------------------------------------------


def named(quantity: str, unit: str) -> str:
    """Return a quantity with its unit."""
    return f"{quantity} {unit}" if unit else quantity


def number(value: float | None, unit: str) -> str:
    """Return an error as tables show it; nothing where there is none."""
    if value is None:
        return ""
    return f"{value:.4g}" if abs(value) >= 1e4 else f"{value:.{decimals(unit)}f}"


def signed(value: float | None, unit: str) -> str:
    """Return a difference with its sign."""
    if value is None:
        return ""
    return f"{value:+.4g}" if abs(value) >= 1e4 else f"{value:+.{decimals(unit)}f}"


def us(value: float) -> str:
    """Return microseconds with three or four digits."""
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}"


def by_other(ratio: float) -> str:
    """Return the ratio of two times with no more digits than times of a machine are good for."""
    return f"× {ratio:.{2 if ratio < 9.995 else 1 if ratio < 99.95 else 0}f}"


def signed_us(value: float) -> str:
    """Return a difference in microseconds with its sign."""
    return f"{value:+.0f}" if abs(value) >= 100 else f"{value:+.1f}"


def markdown(comparison: Comparison) -> str:
    """Return the whole comparison as Markdown."""
    parts = [f"{heading(comparison)}.", *(f"Note: {n}." for n in comparison.notes)]
    if comparison.interrupted:
        parts.append("Interrupted: these are the frames done so far.")
    for table in tables(comparison):
        parts += [f"**{table.title}**", _markdown_table(table)]
        parts += [f"_{table.note.replace('* on', 'A star marks what is on')}._"] * bool(table.note)
    parts.append(f"{saving(comparison)[0].upper()}{saving(comparison)[1:]}.")
    for evolution in comparison.lineage:
        first, *rest = evolution_lines(evolution)
        parts += [f"**{_cell(first)}**", "\n".join(f"- {_cell(r.strip())}" for r in rest)]
    reasons = [f"- {_cell(f'{state} {text}'.strip())}" for state, text in reason_lines(comparison)]
    if reasons:
        parts += ["**Outputs without a value**", "\n".join(reasons)]
    return "\n\n".join(parts) + "\n"


def _markdown_table(table: Table) -> str:
    rules = [":--" if c in LEFT else "--:" for c in table.columns]
    lines: list[Sequence[str]] = [table.columns, rules, *table.rows]
    return "\n".join(f"| {' | '.join(_cell(c) for c in line)} |" for line in lines)


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("*", "\\*").replace("<", "&lt;")
