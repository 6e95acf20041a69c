"""Figures 2.15 to 2.17: the characteristic of an element by groups of four, and its error bars."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.bench import ON_ONE_PAD
from tactile_graph_thesis.measure.groups_of_four import GroupReadings, group_readings
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


# -- figures 2.15 and 2.16 -------------------------------------------------------------------


def _table(found: GroupReadings) -> Table:
    names = [f"group {k + 1}_V" for k in range(len(found.corner))]
    values = np.column_stack(
        [found.weight_g, found.weight_g / 4.0, found.group_v.T, found.group_v.mean(axis=0)]
    )
    columns = ("weight_g", "load_g an element", *names, "mean_V")
    return Table(columns, [tuple(map(float, row)) for row in values])


def rises_and_flattens(found: GroupReadings) -> tuple[Finding, ...]:
    """Return whether readings rise with the weight, and less and less.

    Parameters
    ----------
    found : GroupReadings
    """
    mean = found.group_v.mean(axis=0)
    at = {g: float(np.interp(g, found.weight_g, mean)) for g in (100.0, 700.0, 750.0, 3000.0)}
    light = (at[700.0] - at[100.0]) / 6.0
    heavy = (at[3000.0] - at[750.0]) / 22.5
    falls = np.minimum(np.diff(mean), 0.0)
    return (
        Finding(
            "the readings rise with the weight in both ranges, but for a slight glitch "
            "(figures 2.15 and 2.17)",
            f"mean of the groups {at[100.0]:.2f} V at 100 g, {at[700.0]:.2f} V at 700 g, "
            f"{at[3000.0]:.2f} V at 3000 g; falls {np.count_nonzero(falls)} times, by at most "
            f"{-1e3 * falls.min():.0f} mV",
            "a fall by a twentieth of the range, or a reading no higher at 700 or 3000 g",
            bool(-falls.min() < 0.05 * mean[-1] and at[100.0] < at[700.0] < at[3000.0]),
        ),
        Finding(
            "(figure 2.15) the curve flattens: two ranges need two scales",
            f"{1e3 * light:.0f} mV for each 100 g below 700 g, {1e3 * heavy:.0f} mV above",
            "three tenths of the slope or more above 700 g",
            heavy < 0.3 * light,
        ),
    )


def _figure(found: GroupReadings) -> Figure:
    figure = new_figure(12.0, 5.0)
    axes = figure.subplots(1, 3)
    light = found.weight_g <= 700.0
    for part, which, title in (
        (axes[0], light, "0 to 700 g on four"),
        (axes[1], ~light, "750 to 3000 g on four"),
        (axes[2], np.ones_like(light), "one element (a quarter)"),
    ):
        share = 4.0 if part is axes[2] else 1.0
        for row in found.group_v:
            part.plot(found.weight_g[which] / share, row[which], lw=0.9, marker=".", ms=3)
        part.set(title=title, xlabel=f"{'load' if share > 1 else 'weight'} / g")
        part.grid(alpha=0.3)
    axes[0].set_ylabel("mean of four elements / V")
    figure.suptitle(f"{len(found.corner)} groups of four elements")
    return figure


def _figure_2_15(work: Work) -> Made:
    found = work.on_pad(group_readings)
    return Made(findings=rises_and_flattens(found), table=_table(found), figure=_figure(found))


def _figure_2_16(work: Work) -> Made:
    found = work.on_pad(group_readings)
    figure = new_figure()
    axes = figure.subplots()
    for k, row in enumerate(found.group_v):
        axes.plot(found.weight_g / 4.0, row, ".-", lw=0.9, label=f"group {k + 1}")
    axes.set(
        title="a quarter of the weight on each element",
        xlabel="load on an element / g",
        ylabel="mean of four elements / V",
    )
    axes.grid(alpha=0.3)
    axes.legend(ncols=2)
    return Made(table=_table(found), figure=figure)


# -- figure 2.17 -----------------------------------------------------------------------------


class ErrorBars(NamedTuple):
    """Scatter of readings around their mean, for each load.

    Parameters
    ----------
    load_g : ndarray, shape (w,)
        On each element.
    mean_v : ndarray, shape (w,)
    group_percent, single_percent : ndarray, shape (w,)
        Largest deviation from the mean, of means of four and of single elements.
    group_sd_percent, single_sd_percent : ndarray, shape (w,)
        Standard deviations.
    group_range_v, single_range_v : ndarray, shape (2, w)
        Lowest and highest readings.
    """

    load_g: Array
    mean_v: Array
    group_percent: Array
    single_percent: Array
    group_sd_percent: Array
    single_sd_percent: Array
    group_range_v: Array
    single_range_v: Array


def error_bars(found: GroupReadings) -> ErrorBars:
    """Return how far means of four and single elements lie from the mean of all.

    Parameters
    ----------
    found : GroupReadings
    """
    mean = found.group_v.mean(axis=0)
    read = (found.group_v, np.moveaxis(found.volts, 1, -1).reshape(-1, len(mean)))
    group, single = (volts / mean - 1.0 for volts in read)
    return ErrorBars(
        found.weight_g / 4.0,
        mean,
        *(100.0 * abs(off).max(axis=0) for off in (group, single)),
        *(100.0 * off.std(axis=0, ddof=1) for off in (group, single)),
        *(np.stack([volts.min(axis=0), volts.max(axis=0)]) for volts in read),
    )


def _bar_table(found: ErrorBars) -> Table:
    columns = ("load_g", "mean_V", "of four: largest_%", "single: largest_%",
               "of four: SD_%", "single: SD_%")  # fmt: skip
    return Table(columns, [tuple(map(float, row)) for row in zip(*found[:6], strict=True)])


def about_as_in_the_thesis(found: ErrorBars) -> tuple[Finding, ...]:
    """Return whether single elements and means of four scatter as the thesis says.

    Parameters
    ----------
    found : ErrorBars
    """
    group, single = np.median(found.group_percent), np.median(found.single_percent)
    return (
        Finding(
            "single elements vary by about ±100 %",
            f"at a load's worst element {single:.0f} % (median over loads), standard deviation "
            f"{np.median(found.single_sd_percent):.0f} %",
            "half as much or less, or twice as much or more",
            bool(50.0 < single < 200.0),
        ),
        Finding(
            "the mean of four neighbours varies by about ±20 %",
            f"at a load's worst group {group:.0f} % (median over loads; from "
            f"{found.group_percent.min():.0f} to {found.group_percent.max():.0f} %), standard "
            f"deviation {np.median(found.group_sd_percent):.0f} %",
            "half as much or less, or twice as much or more",
            bool(10.0 < group < 40.0),
        ),
        Finding(
            "averaging over four is a dramatic improvement",
            f"{single / group:.0f} times smaller error bars",
            "three times or less; of independent elements it would be twice",
            bool(single > 3.0 * group),
        ),
    )


def _bar_figure(found: ErrorBars) -> Figure:
    figure = new_figure()
    axes = figure.subplots()
    for span, color, name in (
        (found.single_range_v, "0.75", "single elements, lowest to highest"),
        (found.group_range_v, "C0", "means of four, lowest to highest"),
    ):
        bar = abs(span - found.mean_v)
        axes.errorbar(found.load_g, found.mean_v, bar, fmt="none", ecolor=color, capsize=3.0,
                      label=name)  # fmt: skip
    axes.plot(found.load_g, found.mean_v, "o-", color="C0", ms=3.5, lw=1.0, label="mean")
    axes.set(xlabel="load on an element / g", ylabel="reading / V")
    axes.set_title("Error bars of nine groups of four elements")
    axes.grid(alpha=0.3)
    axes.legend(loc="upper left")
    return figure


def _figure_2_17(work: Work) -> Made:
    found = error_bars(work.on_pad(group_readings))
    return Made(
        findings=about_as_in_the_thesis(found), table=_bar_table(found), figure=_bar_figure(found)
    )


ITEMS = (
    Item(
        "figure-2.15",
        "Groups of four under rising weights",
        "Mean reading of nine groups of four elements, in two ranges of weight.",
        _figure_2_15,
        ON_ONE_PAD,
        study="characteristic",
    ),
    Item(
        "figure-2.16",
        "The characteristic of an element",
        "The same with weights divided by four.",
        _figure_2_16,
        ON_ONE_PAD,
    ),
    Item(
        "figure-2.17",
        "Error bars of a calibration",
        "Scatter of single elements and of means of four.",
        _figure_2_17,
        ON_ONE_PAD + " The thesis put stacked weights on single elements by hand; here single "
        "elements are the members of a group, since the model knows nothing of where on an "
        "element a load stands.",
        study="error-bars",
    ),
)
