"""Distributions of errors and times, and intervals of differences: one row a variant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tactile_graph_compare.output.tables import signed
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.records.scores import Difference
from tactile_graph_compare.report.axes import Scale, bottom_axis, plot, scale_of, tick_text
from tactile_graph_compare.report.badges import class_of
from tactile_graph_compare.report.markup import Html, tag
from tactile_graph_compare.report.scatter import error_title

WIDTH, LEFT, RIGHT, TOP = 380.0, 14.0, 366.0, 8.0
ROW, TALL = 52.0, 24.0
BAR_ROW = 38.0
BINS = 44


@dataclass(frozen=True, eq=False)
class Row:
    """One variant's values; ``n_missing`` of them are not known."""

    number: int
    label: str
    values: NDArray[np.float64]
    n_missing: int = 0


def error_spread(comparison: Comparison, quantity: str) -> Html | None:
    """Return how the signed errors of a quantity are spread; None without any."""
    rows = []
    unit = ""
    for v in comparison.variants:
        score = comparison.score(v.label, quantity)
        if score is not None:
            unit = score.unit
            known = score.errors[np.isfinite(score.errors)]
            rows.append(Row(v.number, v.label, known, score.n_missing))
    what = "distance of " if quantity == "centre" else "error of "
    title = error_title(quantity, unit, what)
    title += "" if quantity in ("centre", "identity") else ", found less true"
    title = "identity wrong (1) or right (0)" if quantity == "identity" else title
    return spread(f"Spread of the errors of {quantity}", title, rows, log=False)


def agreement_spread(comparison: Comparison, quantity: str) -> Html | None:
    """Return how the signed differences of a quantity are spread, a row a pair; None without."""
    found = [a for a in comparison.agreements if a.quantity == quantity]
    numbers = {v.label: v.number for v in comparison.variants}
    rows = [
        Row(numbers[a.variant], f"{a.variant} against {numbers[a.reference]}", a.differences)
        for a in found
    ]
    if quantity == "identity":
        title = "identities differ (1) or agree (0)"
    elif quantity == "centre":
        title = error_title(quantity, "cm", "distance of ")
    else:
        unit = found[0].unit if found else ""
        title = error_title(quantity, unit, "difference of ") + ", it less the other"
    return spread(f"Spread of the differences of {quantity}", title, rows, log=False)


def time_spread(comparison: Comparison) -> Html | None:
    """Return how the times per frame are spread; None where nothing ran."""
    rows = []
    for v in comparison.variants:
        known = v.times.per_frame_us[np.isfinite(v.times.per_frame_us)]
        rows.append(Row(v.number, v.label, known[known > 0.0]))
    return spread("Spread of the times per frame", "time per frame in µs", rows, log=None)


def spread(name: str, title: str, rows: Sequence[Row], log: bool | None) -> Html | None:
    """Return a histogram, quartiles and median for each row over one axis."""
    known = [r.values for r in rows if r.values.size]
    if not known:
        return None
    scale = scale_of(_ends(np.concatenate(known)), LEFT, RIGHT, log=log)
    bottom = TOP + ROW * len(rows)
    told = title + (" (log)" if scale.log else "")
    parts = [
        *bottom_axis(scale, bottom, TOP, told),
        *(p for i, r in enumerate(rows) for p in _row(r, scale, TOP + ROW * (i + 1) - 6)),
    ]
    if scale.low < 0.0 < scale.high and not scale.log:
        parts.insert(0, tag("path", d=f"M{scale(0):.1f} {TOP:.1f}V{bottom:.1f}", class_="zero"))
    return plot(WIDTH, bottom + 42, name, parts)


def _ends(values: NDArray[np.float64]) -> list[float]:
    """Return the ends of an axis: all values, but for a few that lie far beyond the rest."""
    low, high = np.percentile(values, [1.0, 99.0])
    room = 0.75 * (high - low)
    return [max(float(values.min()), low - room), min(float(values.max()), high + room)]


def _row(row: Row, scale: Scale, base: float) -> list[Html]:
    head = tag("text", f"{row.number}  {row.label}", x=LEFT, y=base - TALL - 8, class_="tick name")
    missing = f"{row.n_missing} missing" if row.n_missing else ""
    if not row.values.size:
        none = tag("text", "no answer at all", x=RIGHT, y=base - 4, class_="tick end")
        return [tag("g", head, none, class_=class_of(row.number))]
    low, first, median, third, p95 = np.percentile(row.values, [5, 25, 50, 75, 95])
    told = (
        f"{row.label}: median {median:.4g}, half within {first:.4g} to {third:.4g}, "
        f"90 % within {low:.4g} to {p95:.4g}; {row.values.size} values"
        + (f", {missing}" if missing else "")
    )
    box = [
        tag("path", d=f"M{scale(low):.1f} {base:.1f}H{scale(p95):.1f}", class_="whisker"),
        tag("path", d=f"M{scale(first):.1f} {base:.1f}H{scale(third):.1f}", class_="half"),
        tag("circle", cx=scale(median), cy=base, r=4.0, class_="median"),
    ]
    note = f"median {tick_text(median, 3)}" + (f" · {missing}" if missing else "")
    beyond = int(((row.values < scale.low) | (row.values > scale.high)).sum())
    note += f" · {beyond} beyond" if beyond else ""
    right = tag("text", note, x=RIGHT, y=base - TALL - 8, class_="tick end halo")
    area = tag("path", d=_area(row.values, scale, base), class_="area")
    return [tag("g", tag("title", told), area, *box, head, right, class_=class_of(row.number))]


def _area(values: NDArray[np.float64], scale: Scale, base: float) -> str:
    at = np.array([scale(v) for v in values.tolist()])
    counts, edges = np.histogram(at, BINS, (scale.start, scale.end))
    heights = base - TALL * counts / max(int(counts.max()), 1)
    path = f"M{edges[0]:.1f} {base:.1f}"
    for height, edge in zip(heights.tolist(), edges[1:].tolist(), strict=True):
        path += f"V{height:.1f}H{edge:.1f}"
    return f"{path}V{base:.1f}Z"


def intervals(comparison: Comparison, quantity: str) -> Html | None:
    """Return the paired differences of a quantity with their intervals; None without any."""
    found = [d for d in comparison.differences if d.quantity == quantity and d.mean is not None]
    if not found:
        return None
    ends = [e for d in found for e in (d.mean, d.low, d.high) if e is not None]
    scale = scale_of([0.0, *ends], LEFT, RIGHT, log=False)
    bottom = TOP + BAR_ROW * len(found)
    unit = f" in {found[0].unit}" if found[0].unit else ""
    numbers = {v.label: v.number for v in comparison.variants}
    parts = [
        *bottom_axis(scale, bottom, TOP, f"change of the error of {quantity}{unit}"),
        tag("path", d=f"M{scale(0):.1f} {TOP:.1f}V{bottom:.1f}", class_="zero"),
        *(_interval(d, numbers, scale, TOP + BAR_ROW * i - 10) for i, d in enumerate(found, 1)),
    ]
    return plot(WIDTH, bottom + 42, f"Paired differences of {quantity}", parts)


def _interval(d: Difference, numbers: Mapping[str, int], scale: Scale, base: float) -> Html:
    mean = d.mean or 0.0
    low, high = (mean if e is None else e for e in (d.low, d.high))
    told = f"{signed(d.mean, d.unit)}, {d.verdict}"
    head = f"{numbers[d.variant]} against {numbers[d.reference]}: {told}"
    return tag(
        "g",
        tag("title", f"{d.variant} against {d.reference}: {told}"),
        tag("path", d=f"M{scale(low):.1f} {base:.1f}H{scale(high):.1f}", class_="half"),
        tag("circle", cx=scale(mean), cy=base, r=5.0, class_="median"),
        tag("text", head, x=LEFT, y=base - 12, class_="tick name halo"),
        class_=class_of(numbers[d.variant]),
    )
