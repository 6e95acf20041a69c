"""Tables 4.3 to 4.8 together: one pad for all of them, and what it takes to explain them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.measure.one_pad import TABLES, averages, cells, near, pad_errors
from tactile_graph_thesis.numbers import error_table
from tactile_graph_thesis.work import PAD as USUAL
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
PAD = "thesis-tables"
"""Fitted to all five tables by benchmarks/one_pad.py; taken where no other pad is asked for."""
SCENES = ("discs-in-part", "rectangles-in-part")
PADS, QUICK_PADS = 15, 4
"""So many are built by the one description, which a part of their unevenness tells apart."""
EACH = 20
"""Readings of each object on each of them: the thesis' own number."""
ENOUGH = 24
"""Averages within 30 % from which one pad explains the tables: three in five of all."""


def _one_pad(work: Work) -> Made:
    n = QUICK_PADS if work.quick else PADS
    errors = [_errors(work, k) for k in range(n)]
    of_each = np.array([averages(one) for one in errors])
    together = {key: np.concatenate([one[key] for one in errors]) for key in errors[0]}
    found = averages(together)
    low, high = np.quantile(of_each, [0.05, 0.95], axis=0)
    compared = tuple(
        Compared(cell.words, cell.unit, float(value), cell.thesis, float(a), float(b))
        for cell, value, a, b in zip(cells(), found, low, high, strict=True)
    )
    rows = [
        (*cell[:4], cell.thesis, c.ours, c.low, c.high, c.ratio)
        for cell, c in zip(cells(), compared, strict=True)
    ]
    columns = ("table", "object", "error", "unit", "thesis", "ours", "5 %", "95 %", "ratio")
    counts = near(of_each).sum(axis=1)
    far = [cell.words for cell, is_near in zip(cells(), near(found), strict=True) if not is_near]
    return Made(
        compared,
        (explains(found), best_disc(found)),
        Table(columns, rows),
        _figure(compared, _pad(work)),
        notes=(
            f"{n} pads by the description of {_pad(work)}, {EACH} readings of each object on each. "
            f"On one such pad {np.median(counts):.0f} of {len(found)} are within 30 % in the "
            f"median, {counts.min()} to {counts.max()}.",
            f"Further off than 30 %: {'; '.join(far)}.",
        ),
    )


def _pad(work: Work) -> str:
    return PAD if work.pad_name == USUAL else work.pad_name


def _errors(work: Work, k: int) -> dict[tuple[str, str], Array]:
    """Return the errors on the k-th pad."""
    from tactile_graph import load

    frames = []
    for scene, n_objects in zip(SCENES, (3, 2), strict=True):
        settings = {"scene": scene, "pad": _pad(work), "frames": n_objects * EACH}
        source = load("circle-1").with_source("simulate", **settings)
        frames.append(list(source.frames(1000 * (work.seed + 1) + k)))
    return pad_errors(*frames)


def explains(found: Array) -> Finding:
    """Return whether one pad comes near to most of the averages.

    Parameters
    ----------
    found : ndarray, shape (39,)
    """
    n = int(near(found).sum())
    return Finding(
        "(not in the thesis) one pad with what the text tells of explains tables 4.3 to 4.8",
        f"{n} of {len(found)} averages are within 30 % of the printed ones",
        f"fewer than {ENOUGH}, on pads that it was not fitted on",
        n >= ENOUGH,
    )


def best_disc(found: Array) -> Finding:
    """Return whether DISC I's radius errs least by each of the three algorithms, as printed.

    Parameters
    ----------
    found : ndarray, shape (39,)
    """
    radius = {
        (cell.table, cell.object): value
        for cell, value in zip(cells(), found, strict=True)
        if cell.quantity == "radius"
    }
    tables = [t for t in TABLES if (t, "DISC I") in radius]
    of_table = {t: [radius[t, o] for o in error_table(t).objects] for t in tables}
    words = "; ".join(
        f"{TABLES[t]} {', '.join(f'{v:.2f}' for v in values)}" for t, values in of_table.items()
    )
    return Finding(
        "the lightest disc, DISC I, has the best radius by each algorithm",
        f"DISC I, II, III, cm: {words}",
        "an algorithm by which DISC II or DISC III errs less",
        all(values[0] == min(values) for values in of_table.values()),
    )


def _figure(compared: tuple[Compared, ...], pad: str) -> Figure:
    figure = new_figure(7.5, 8.5)
    axes = figure.subplots()
    at = np.arange(len(compared))
    ratio = np.array([c.ratio if c.ratio is not None else np.nan for c in compared])
    ends = [
        np.array([getattr(c, end) / (c.thesis or np.nan) for c in compared])
        for end in ("low", "high")
    ]
    axes.axvspan(0.7, 1.3, color="0.9", zorder=0, label="within 30 %")
    axes.hlines(at, ends[0], ends[1], color="C0", lw=1.0, label="nine in ten pads")
    axes.plot(ratio, at, "o", ms=4, color="C0", label="all together")
    axes.axvline(1.0, color="0.5", lw=0.8)
    axes.set_yticks(at, [c.what for c in compared], fontsize="x-small")
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.minorticks_off()
    axes.set_xticks([0.25, 0.5, 1.0, 2.0, 4.0], ["1/4", "1/2", "1", "2", "4"])
    axes.set_xlabel("average error, ours / thesis")
    axes.set_title(f"Tables of one pad, {pad}")
    axes.legend(fontsize="small", loc="lower left")
    axes.grid(alpha=0.3, axis="x")
    return figure


ITEMS = (
    Item(
        "one-pad",
        "Tables of one pad",
        "Every average error of the tables of discs and rectangles, on one pad that was fitted to "
        "all of them with what the text tells of: bumps, voids, noise points, pressure off the "
        "middle, a turn-on, and objects that touch over a part of their size only.",
        _one_pad,
        "By their weight alone the heavier discs lose fewer elements and err less. What turns the "
        "order round is that the two heavy cylinders touch over a part of their base, as the "
        "thesis notes of RECTANGLE I, on a pad of low turn-on and hardly any voids. Errors along x "
        "and along y differ in the thesis up to four times, which no pad that is alike in both "
        "can have.",
        after="4.3.9",
    ),
)
