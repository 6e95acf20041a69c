"""Section 6.1.3, study ``subpixel``: errors and times of circle-3 against subdivision."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import load
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.circles import signed_circle_errors
from tactile_graph_thesis.measure.shown_reading import DISCS
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
FACTORS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16)
QUICK_FACTORS = (1, 2, 4, 8)
MOST_TIMED = 60
"""Readings that are timed."""
KINDS: dict[str, Callable[[int], str]] = {
    "element of 5 × 5 cells": lambda _: "disc5",
    "element of one pitch's radius": lambda factor: f"disc:{2 * factor + 1}",
}
"""How the structuring element goes with the factor: as many cells, or as many centimetres."""


class SubpixelErrors(NamedTuple):
    """Errors of circle-3 for each factor and kind of structuring element.

    Parameters
    ----------
    factors : tuple of int
        Cells a side.
    error_cm : ndarray, shape (kinds, factors, readings, 3)
        Of centre x, centre y and radius, found less true, over the discs of table 4.2.
    time_us : ndarray, shape (kinds, factors)
        Median time of a frame.
    """

    factors: tuple[int, ...]
    error_cm: Array
    time_us: Array

    @property
    def radius_cm(self) -> Array:
        """Mean size of the radius error, shape (kinds, factors)."""
        return np.asarray(np.abs(self.error_cm[..., 2]).mean(axis=-1))

    @property
    def bias_cm(self) -> Array:
        """Mean radius error, shape (kinds, factors)."""
        return np.asarray(self.error_cm[..., 2].mean(axis=-1))

    @property
    def centre_cm(self) -> Array:
        """Mean distance of the centre, shape (kinds, factors)."""
        return np.asarray(np.hypot(self.error_cm[..., 0], self.error_cm[..., 1]).mean(axis=-1))


def subpixel_errors(work: Work) -> SubpixelErrors:
    """Return the errors and times of circle-3 for rising factors.

    Parameters
    ----------
    work : Work
    """
    factors = QUICK_FACTORS if work.quick else FACTORS
    base = load("circle-3")
    frames = work.frames("discs", len(DISCS) * work.readings)
    runners: list[Any] = []
    for element_of in KINDS.values():
        for factor in factors:
            element = element_of(factor)
            settings = {
                "fine.factor": factor,
                "eroded.element": element,
                "dilated.element": element,
            }
            runners.append(base.with_settings(settings).runner(seed=work.seed))
    errors = signed_circle_errors(frames, runners, DISCS)
    shape = (len(KINDS), len(factors))
    times = _times_us(runners, frames[:MOST_TIMED])
    return SubpixelErrors(factors, errors.reshape(*shape, -1, 3), times.reshape(shape))


def _times_us(runners: list[Any], frames: list[Any]) -> Array:
    """Return each runner's median time of a frame; all take turns, frame by frame."""
    spent = np.empty((len(frames), len(runners)))
    for k, frame in enumerate(frames):
        for j, runner in enumerate(runners):
            start = time.perf_counter()
            runner(frame)
            spent[k, j] = time.perf_counter() - start
    return np.asarray(1e6 * np.median(spent, axis=0))


# -- the item --------------------------------------------------------------------------------


def _subpixel(work: Work) -> Made:
    found = subpixel_errors(work)
    (fixed, scaled), factors = found.radius_cm, found.factors
    two = float(fixed[factors.index(2)])
    best, k = min((float(errors.min()), k) for k, errors in enumerate((fixed, scaled)))
    at = factors[int(found.radius_cm[k].argmin())]
    return Made(
        findings=(
            Finding(
                "cutting elements in four makes the radius somewhat more accurate (section 4.2.5)",
                f"radius error {scaled[0]:.2f} cm uncut with element #1, {two:.2f} cm at 2 × 2",
                "a radius no nearer at 2 × 2",
                bool(two < scaled[0]),
            ),
            Finding(
                "(not in the thesis) more than four parts improve further",
                f"{two:.2f} cm at 2 × 2; least {best:.2f} cm at {at} × {at}, with an "
                f"{list(KINDS)[k]}; at {factors[-1]} × {factors[-1]} {fixed[-1]:.2f} cm with "
                f"as many cells, {scaled[-1]:.2f} cm with as many centimetres",
                "a least error that is nine tenths of that at 2 × 2 or more",
                best < 0.9 * two,
            ),
        ),
        table=_table(found),
        figure=_figure(found),
        notes=(
            f"Over {found.error_cm.shape[2]} readings of the discs of table 4.2. A frame takes "
            f"{found.time_us[0, found.factors.index(2)]:.0f} µs at 2 × 2 and "
            f"{found.time_us[0, -1]:.0f} µs at {found.factors[-1]} × {found.factors[-1]} with an "
            "element of as many cells. Times differ from run to run, errors do not.",
        ),
    )


def _table(found: SubpixelErrors) -> Table:
    columns = (
        "cells_a_side",
        *(
            f"{kind}: {what}"
            for kind in KINDS
            for what in ("radius_cm", "radius_bias_cm", "centre_cm", "time_us")
        ),
    )
    rows = []
    for j, factor in enumerate(found.factors):
        values: list[float] = []
        for k in range(len(KINDS)):
            values += [
                float(v[k, j])
                for v in (found.radius_cm, found.bias_cm, found.centre_cm, found.time_us)
            ]
        rows.append((factor, *values))
    return Table(columns, rows)


def ticks_about(low: float, high: float) -> list[float]:
    """Return the 1, 2 and 5 of powers of ten, from at or below a number to at or above another.

    Parameters
    ----------
    low, high : float
        Above 0, ``low`` below ``high``.
    """
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    ticks = [float(f"{digit}e{power}") for power in powers for digit in (1, 2, 5)]
    below = sum(tick <= low for tick in ticks)
    above = sum(tick >= high for tick in ticks)
    return ticks[below - 1 : len(ticks) - above + 1]


def _figure(found: SubpixelErrors) -> Figure:
    figure = new_figure(11.0, 4.8)
    errors, bias, times = figure.subplots(1, 3)
    for k, kind in enumerate(KINDS):
        errors.plot(found.factors, found.radius_cm[k], "o-", color=f"C{k}", label=f"radius, {kind}")
        errors.plot(
            found.factors, found.centre_cm[k], "s--", color=f"C{k}", label=f"centre, {kind}"
        )
        bias.plot(found.factors, found.bias_cm[k], "o-", color=f"C{k}", label=kind)
        times.plot(found.factors, found.time_us[k], "o-", color=f"C{k}", label=kind)
    bias.axhline(0.0, color="0.6", lw=1.0)
    errors.set(title="size of the error", ylabel="mean error / cm", yscale="log")
    bias.set(title="bias of the radius", ylabel="found less true / cm")
    times.set(title="time", ylabel="median time of a frame / µs", yscale="log")
    for axes in (errors, bias, times):
        axes.set_xlabel("cells a side of an element")
        axes.set_xticks(found.factors)
        axes.grid(alpha=0.3)
    for axes in (errors, times):
        ticks = ticks_about(*axes.get_ylim())
        axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.set_ylim(ticks[0], ticks[-1])
        axes.minorticks_off()
    handles, labels = errors.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize="small")
    return figure


ITEMS = (
    Item(
        "subpixel",
        "Errors against subdivision",
        "Error, bias and time of circle-3 against the number of cells each element is cut into; "
        "once with a structuring element of as many cells, once of as many centimetres.",
        _subpixel,
        "The thesis has no such curve: section 6.1.3 wishes for it. A finer grid shifts the "
        "boundary outwards, since boundary points are centres of cells: what the radius gains is "
        "mostly bias. An element of as many cells also opens less and less.",
        after="6.1.3",
    ),
)
