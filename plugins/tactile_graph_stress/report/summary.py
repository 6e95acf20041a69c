"""``Summary``: the rows of one step, counted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tactile_graph_stress.study import Row
from tactile_graph_stress.verdict import Outcome


@dataclass(frozen=True)
class Summary:
    """One step: how many cases came to what, and the largest error among the measured."""

    step: str
    kind: str
    counts: dict[Outcome, int]
    worst: Row | None


def summaries(rows: Sequence[Row]) -> list[Summary]:
    """Return a summary of each step, in the order of the rows."""
    steps: dict[str, list[Row]] = {}
    for row in rows:
        steps.setdefault(row.step, []).append(row)
    return [_of(step, mine) for step, mine in steps.items()]


def _of(step: str, rows: list[Row]) -> Summary:
    counts = {o: sum(r.verdict.outcome is o for r in rows) for o in Outcome}
    measured = [r for r in rows if r.verdict.units is not None]
    told = [r for r in measured if r.verdict.outcome is not Outcome.NO_DIGITS]
    worst = max(told, key=lambda r: r.verdict.units or 0.0, default=None)
    return Summary(step, rows[0].kind, counts, worst)


def shown_units(units: float) -> str:
    """Return an error in units, short."""
    if units >= 1e4:
        return f"{units:.0e}".replace("e+0", "e").replace("e+", "e")
    return f"{units:.0f}" if units >= 10.0 else f"{units:.1f}"
