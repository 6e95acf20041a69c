"""Tables 4.3 to 4.5, 4.7 and 4.8: errors of the localisers beside the thesis'."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph import load
from tactile_graph_thesis.drawing.beside import beside_figure
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.beside_thesis import beside_thesis
from tactile_graph_thesis.measure.circles import circle_errors
from tactile_graph_thesis.measure.one_pad import TABLES
from tactile_graph_thesis.measure.rectangles import signed_errors
from tactile_graph_thesis.numbers import error_table
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]


def table_errors(work: Work, name: str) -> dict[str, Array]:
    """Return the absolute errors behind a table: object -> shape (readings, 3).

    Parameters
    ----------
    work : Work
    name : str
        ``table-4.3`` and the like.
    """
    return work.once(("errors", name), lambda: _measured(work, name))


def _measured(work: Work, name: str) -> dict[str, Array]:
    objects = error_table(name).objects
    n = len(objects) * work.readings
    runner = load(TABLES[name]).runner(seed=work.seed)
    if TABLES[name].startswith("circle"):
        found = circle_errors(work.frames("discs", n), [runner], objects)[0]
        return dict(zip(objects, found, strict=True))
    signed = signed_errors(runner, work.frames("rectangles", n))
    return {label: np.abs(signed[label][:, :3]) for label in objects}


def _average(work: Work, name: str, quantity: int) -> float:
    """Return the mean over objects of a quantity's average error."""
    return float(np.mean([np.nanmean(e[:, quantity]) for e in table_errors(work, name).values()]))


def _said(ours: float, before: float, unit: str) -> str:
    return f"{ours:.2f} against {before:.2f} {unit} before"


def _made(work: Work, name: str, title: str, findings: tuple[Finding, ...] = ()) -> Made:
    beside = beside_thesis(name, table_errors(work, name), work.group)
    lost = ", ".join(
        f"{n} of {work.readings} of {label}" for label, n in beside.missing.items() if n
    )
    notes = [f"{work.readings} readings of each object, in groups of {work.group}."]
    if lost:
        notes.append(f"Without an answer, and left out: {lost}.")
    rows = beside.compared
    table = Table(
        ("object and quantity", "unit", "ours", "5 %", "95 %", "thesis", "ratio"),
        [(c.what, c.unit, c.ours, c.low, c.high, c.thesis, c.ratio) for c in rows],
    )
    return Made(rows, findings, table, beside_figure(rows, title), notes=tuple(notes))


# -- discs -----------------------------------------------------------------------------------


def _table_4_3(work: Work) -> Made:
    return _made(work, "table-4.3", "Errors of the first circular localisation")


def _table_4_4(work: Work) -> Made:
    before, now = (_average(work, t, 2) for t in ("table-4.3", "table-4.4"))
    centre = [_centre(work, t) for t in ("table-4.3", "table-4.4")]
    findings = (
        smaller("the radius improves somewhat over the first algorithm", now, before),
        alike("the centres stay approximately the same", centre[1], centre[0]),
    )
    return _made(work, "table-4.4", "Errors of the second circular localisation", findings)


def _table_4_5(work: Work) -> Made:
    before, now = (_average(work, t, 2) for t in ("table-4.4", "table-4.5"))
    centre = [_centre(work, t) for t in ("table-4.4", "table-4.5")]
    worst = max(np.mean(e) for errors in table_errors(work, "table-4.5").values() for e in errors.T)
    findings = (
        smaller("the convex hull improves the radius dramatically", now, before, 0.5),
        smaller("the centres are somewhat improved", centre[1], centre[0]),
        within_an_element(float(worst)),
    )
    return _made(work, "table-4.5", "Errors of the third circular localisation", findings)


def _centre(work: Work, name: str) -> float:
    return float(np.mean([_average(work, name, q) for q in (0, 1)]))


def smaller(thesis: str, now_cm: float, before_cm: float, share: float = 1.0) -> Finding:
    """Return whether an error fell below a share of what it was.

    Parameters
    ----------
    thesis : str
        What the thesis concludes.
    now_cm, before_cm : float
    share : float
    """
    left = "no smaller error" if share == 1.0 else f"{100 * share:.0f} % of the error or more left"
    return Finding(
        thesis, f"mean error {_said(now_cm, before_cm, 'cm')}", left, now_cm < share * before_cm
    )


def alike(thesis: str, now_cm: float, before_cm: float) -> Finding:
    """Return whether an error is within a tenth of what it was.

    Parameters
    ----------
    thesis : str
        What the thesis concludes.
    now_cm, before_cm : float
    """
    return Finding(
        thesis,
        f"mean error {_said(now_cm, before_cm, 'cm')}",
        "a change by a tenth",
        abs(now_cm / before_cm - 1.0) < 0.1,
    )


def within_an_element(worst_cm: float) -> Finding:
    """Return whether all average errors are below 1 cm.

    Parameters
    ----------
    worst_cm : float
        The largest.
    """
    return Finding(
        "errors are typically within or around 1 cm, less than an element's pitch",
        f"largest average error {worst_cm:.2f} cm",
        "an average error of 1 cm",
        worst_cm < 1.0,
    )


# -- rectangles ------------------------------------------------------------------------------


def _table_4_7(work: Work) -> Made:
    lengths = {k: float(np.nanmean(e[:, 1])) for k, e in table_errors(work, "table-4.7").items()}
    findings = (only_large_error(*lengths.values()),)
    return _made(work, "table-4.7", "Errors of the first rectangular localisation", findings)


def only_large_error(one_cm: float, two_cm: float) -> Finding:
    """Return whether the error of RECTANGLE I's length is the larger.

    Parameters
    ----------
    one_cm, two_cm : float
        Average errors of the two rectangles' lengths.
    """
    return Finding(
        "the only large error is that of RECTANGLE I's length",
        f"RECTANGLE I {one_cm:.2f} cm on average, RECTANGLE II {two_cm:.2f} cm",
        "as large a one of RECTANGLE II",
        one_cm > two_cm,
    )


def _table_4_8(work: Work) -> Made:
    findings = tuple(
        smaller(
            f"morphological cleaning somewhat improves the {quantity}",
            *(_average(work, t, j) for t in ("table-4.8", "table-4.7")),
        )
        for j, quantity in ((1, "length"), (2, "breadth"))
    )
    return _made(work, "table-4.8", "Errors of the second rectangular localisation", findings)


_CIRCLES = (
    "The pad's unevenness was fitted once to the three tables of discs together, so agreement on "
    "average is no test of it; the order of the three algorithms is. The thesis does not say how "
    "many readings a table holds: groups as large as its own choice of section 4.1 are taken. "
    "Its maxima lie nearer to its averages than ours: its errors hardly "
    "scatter, as those of a few readings, or of objects placed by hand and measured with a ruler. "
    "The drawing of structuring element #2 is lost; the digital disc of five cells stands for it."
)
_RECTANGLES = (
    "The pad is the one fitted to the discs and knows no contacts outside the object, which "
    "the thesis sees in figure 4.24, nor a RECTANGLE I that touches the pad over a part of its "
    "length only, which it tells of in section 4.3.6; with both added, in amounts fitted to its "
    "tables, ours come near to them (benchmarks/rectangle_errors.py). Lengths are the full axes "
    "of the fitted ellipse, as the thesis reads them. Tables 4.7 and 4.8 are equal in the angle, "
    "as both take it from the same step; so are ours, but for readings without an answer."
)
_EIGHT = (
    " The thesis does not say how often its pre-filter is applied. Here it makes eight passes, "
    "which fill a lost element too; after one pass the opening often leaves nothing of "
    "RECTANGLE II, of which the thesis' table shows no trace. Whether the second algorithm betters "
    "the first also depends on what a cell is taken for: at the pad's true pitch it does not, "
    "with a cell read as a whole centimetre it does (docs/evidence/objects.md)."
)

ITEMS = (
    Item(
        "table-4.3",
        "Discs: errors of the first algorithm (structuring element #1)",
        "Errors of centre and radius with circle-1 on the discs of table 4.2.",
        _table_4_3,
        _CIRCLES,
        after="4.12",
    ),
    Item(
        "table-4.4",
        "Discs: errors of the second algorithm (structuring element #2)",
        "The same with circle-2, on elements cut in four.",
        _table_4_4,
        _CIRCLES,
        after="4.17",
    ),
    Item(
        "table-4.5",
        "Discs: errors of the third algorithm (convex hull)",
        "The same with circle-3, fitted to the corners of the convex hull.",
        _table_4_5,
        _CIRCLES,
        after="4.20",
    ),
    Item(
        "table-4.7",
        "Rectangles: errors of the first algorithm",
        "Errors of angle, length and breadth with rectangle-1 on the rectangles of table 4.6.",
        _table_4_7,
        _RECTANGLES,
        after="4.28",
    ),
    Item(
        "table-4.8",
        "Rectangles: errors of the second algorithm",
        "The same with rectangle-2, opened on elements cut in a hundred.",
        _table_4_8,
        _RECTANGLES + _EIGHT,
        after="4.36",
    ),
)
