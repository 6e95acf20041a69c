"""A study as Markdown: what each step withstands, and where it gives up."""

from __future__ import annotations

import platform
from collections.abc import Sequence

from tactile_graph_stress.case import GROUPS
from tactile_graph_stress.report.summary import shown_units, summaries
from tactile_graph_stress.study import Row
from tactile_graph_stress.verdict import Outcome

MOST_SAID = 12


def markdown(rows: Sequence[Row], command: str) -> str:
    """Return the whole report.

    Parameters
    ----------
    rows : sequence of Row
    command : str
        What made it.
    """
    import numpy

    from tactile_graph_stress.subject import KINDS

    counts = {o: sum(r.verdict.outcome is o for r in rows) for o in Outcome}
    told = ", ".join(f"{counts[o]} {o.value}" for o in Outcome)
    lines = [
        f"Made by `{command}` with Python {platform.python_version()} and NumPy"
        f" {numpy.__version__}: {len(rows)} cases of {len(summaries(rows))} steps; {told}.",
        "",
    ]
    for kind in KINDS:
        mine = [r for r in rows if r.kind == kind]
        if mine:
            lines += [f"### {kind}", "", *_matrix(mine), "", *_given_up(mine), *_broken(mine)]
    return "\n".join(lines).rstrip() + "\n"


def _matrix(rows: Sequence[Row]) -> list[str]:
    found = dict.fromkeys(r.group for r in rows)
    groups = [*(g for g in GROUPS if g in found), *(g for g in found if g not in GROUPS)]
    lines = [
        "| step | " + " | ".join(groups) + " |",
        "|---|" + "---|" * len(groups),
    ]
    for step in dict.fromkeys(r.step for r in rows):
        mine = [r for r in rows if r.step == step]
        cells = [_cell([r for r in mine if r.group == g]) for g in groups]
        lines.append(f"| `{step}` | " + " | ".join(cells) + " |")
    return lines


def _cell(rows: Sequence[Row]) -> str:
    """Return the largest error of a group, and how many of its cases had another outcome."""
    if not rows:
        return ""
    count = {o: sum(r.verdict.outcome is o for r in rows) for o in Outcome}
    told = [
        r.verdict.units for r in rows
        if r.verdict.units is not None
        and r.verdict.outcome in (Outcome.EXACT, Outcome.GOOD, Outcome.DEGRADED)
    ]  # fmt: skip
    parts = [shown_units(max(told))] if told else []
    if count[Outcome.FINITE] and not told:
        parts.append("finite")
    if count[Outcome.NO_DIGITS]:
        parts.append("lost" if not told else f"lost {count[Outcome.NO_DIGITS]}")
    if count[Outcome.GAVE_UP]:
        all_up = count[Outcome.GAVE_UP] == len(rows)
        parts.append("gives up" if all_up else f"gives up {count[Outcome.GAVE_UP]}/{len(rows)}")
    if count[Outcome.BROKEN]:
        parts.append(f"**BROKEN {count[Outcome.BROKEN]}/{len(rows)}**")
    return ", ".join(parts)


def _given_up(rows: Sequence[Row]) -> list[str]:
    """Return what is said where steps give up, and in which cases."""
    said: dict[str, dict[str, list[str]]] = {}
    for row in rows:
        if row.verdict.outcome is Outcome.GAVE_UP:
            where = said.setdefault(_general(row.verdict.note), {})
            where.setdefault(f"{row.group}: {row.case}", []).append(row.step)
    n_steps = len({r.step for r in rows})
    lines = ["| says | when |", "|---|---|"] if said else []
    for text, where in said.items():
        when = [_when(case, steps, n_steps) for case, steps in where.items()]
        more = len(when) - MOST_SAID
        when = [*when[:MOST_SAID], f"and {more} more"] if more > 0 else when
        lines.append(f"| {text} | {'; '.join(when)} |".replace("\n", " "))
    return [*lines, ""] if said else []


def _when(case: str, steps: list[str], n_steps: int) -> str:
    return case if len(steps) == n_steps else f"{case} ({', '.join(steps)})"


def _general(note: str) -> str:
    """Return a message without its first number, so that those of many cases are one."""
    import re

    return re.sub(r"\b\d+ (of \d+ )?points?\b", "n points", note, count=1).replace("|", "\\|")


def _broken(rows: Sequence[Row]) -> list[str]:
    broken = [r for r in rows if r.verdict.outcome is Outcome.BROKEN]
    lines = [f"- **BROKEN** `{r.step}`, {r.group}: {r.case}: {r.verdict.note}" for r in broken]
    return [*lines, ""] if lines else []
