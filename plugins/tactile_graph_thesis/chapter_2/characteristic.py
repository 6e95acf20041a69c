"""Studies ``characteristic`` and ``error-bars``: groups of four elements (figures 2.15 to 2.17)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Rectangle
from tactile_graph_pads.calibration.points import Observation
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.chapter_2.bench import Bench
from tactile_graph_thesis.chapter_2.study import Finding, Study, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
LIGHT_G = np.arange(50.0, 701.0, 50.0)
HEAVY_G = np.arange(750.0, 3001.0, 250.0)
N_GROUPS = 9
STACK_CM = 0.15
"""How far from the middle a stack of weights stands, per axis (section 2.4.2)."""


class GroupReadings(NamedTuple):
    """Groups of four neighbouring elements under rising weights.

    Parameters
    ----------
    weight_g : ndarray, shape (w,)
        On a whole group.
    corner : ndarray of int, shape (n, 2)
        Row and column of each group's top left element.
    volts, siemens : ndarray, shape (n, w, 4)
        What the four elements read, and the conductances found behind the whole frame.
    load_g : ndarray, shape (n, w, 4)
        What each of them truly bore.
    """

    weight_g: Array
    corner: NDArray[np.intp]
    volts: Array
    siemens: Array
    load_g: Array

    @property
    def group_v(self) -> Array:
        """Mean of the four, shape (n, w)."""
        return np.asarray(self.volts.mean(axis=2))

    def observations(self, quantity: str = "volt") -> list[Observation]:
        """Return what a calibration takes: one observation for each group and weight.

        Parameters
        ----------
        quantity : "volt" or "siemens"
        """
        values = self.volts if quantity == "volt" else self.siemens
        return [
            Observation(float(self.weight_g[w]) / 4.0, values[k, w], f"group {k + 1}")
            for w in range(len(self.weight_g))
            for k in range(len(self.corner))
        ]


def characteristic(
    pad: Pad,
    rng: np.random.Generator,
    weight_g: Array | None = None,
    n_groups: int = N_GROUPS,
) -> GroupReadings:
    """Return what groups of four elements read under rising weights, at random places.

    Parameters
    ----------
    pad : Pad
    rng : numpy.random.Generator
    weight_g : ndarray, shape (w,), optional
        On a whole group; figure 2.15's two ranges if not given.
    n_groups : int

    Notes
    -----
    A square plate covers exactly the four. It stays where it is while weights are stacked on
    it, each a little off the middle, so one group's curve keeps its unevenness.
    """
    weights = np.concatenate([LIGHT_G, HEAVY_G]) if weight_g is None else weight_g
    bench = Bench(pad, rng)
    rows, columns = pad.geometry.shape
    corner = np.stack(
        [rng.integers(0, rows - 1, n_groups), rng.integers(0, columns - 1, n_groups)], axis=1
    )
    volts, siemens, load = (np.empty((n_groups, len(weights), 4)) for _ in range(3))
    for k, (row, column) in enumerate(corner):
        four = (slice(row, row + 2), slice(column, column + 2))
        plate, gains = _plate(pad, row, column), _touching(bench, four)
        for w, grams in enumerate(weights):
            x, y = rng.normal(0.0, STACK_CM, 2)
            bears = bench.load_g(plate, float(grams), gains, (float(x), float(y)))
            read = bench.volts(bears)
            volts[k, w], load[k, w] = read[four].ravel(), bears[four].ravel()
            siemens[k, w] = bench.siemens(read)[0][four].ravel()
    return GroupReadings(weights, corner, volts, siemens, load)


def _plate(pad: Pad, row: int, column: int) -> Rectangle:
    geometry = pad.geometry
    side = 2.0 * geometry.element_cm + geometry.gap_cm
    x = 0.5 * (geometry.x_cm[column] + geometry.x_cm[column + 1])
    y = 0.5 * (geometry.y_cm[row] + geometry.y_cm[row + 1])
    return Rectangle(float(x), float(y), side, side, 0.0)


def _touching(bench: Bench, four: tuple[slice, slice]) -> Array:
    """Return gains for a plate that rests on at least one of its elements."""
    while True:
        gains = bench.gains()
        if gains[four].any():
            return gains


# -- figures 2.15 and 2.16 -------------------------------------------------------------------


def _table(found: GroupReadings) -> Table:
    names = [f"group {k + 1}_V" for k in range(len(found.corner))]
    values = np.column_stack(
        [found.weight_g, found.weight_g / 4.0, found.group_v.T, found.group_v.mean(axis=0)]
    )
    columns = ("weight_g", "load_g an element", *names, "mean_V")
    return Table(columns, [tuple(map(float, row)) for row in values])


def _findings(found: GroupReadings) -> list[Finding]:
    mean = found.group_v.mean(axis=0)
    at = {g: float(np.interp(g, found.weight_g, mean)) for g in (100.0, 700.0, 750.0, 3000.0)}
    light = (at[700.0] - at[100.0]) / 6.0
    heavy = (at[3000.0] - at[750.0]) / 22.5
    falls = np.minimum(np.diff(mean), 0.0)
    return [
        Finding(
            "the readings rise with the weight in both ranges, but for a slight glitch "
            "(figures 2.15 and 2.17)",
            f"mean of the groups {at[100.0]:.2f} V at 100 g, {at[700.0]:.2f} V at 700 g, "
            f"{at[3000.0]:.2f} V at 3000 g; falls {np.count_nonzero(falls)} times, by at most "
            f"{-1e3 * falls.min():.0f} mV",
            bool(-falls.min() < 0.05 * mean[-1] and at[100.0] < at[700.0] < at[3000.0]),
        ),
        Finding(
            "(figure 2.15) the curve flattens: two ranges need two scales",
            f"{1e3 * light:.0f} mV for each 100 g below 700 g, {1e3 * heavy:.0f} mV above",
            heavy < 0.3 * light,
        ),
    ]


def _plot(figure: Figure, found: GroupReadings) -> None:
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


def error_bars(pad: Pad, rng: np.random.Generator) -> ErrorBars:
    """Return how far means of four and single elements lie from the mean of all.

    Parameters
    ----------
    pad : Pad
    rng : numpy.random.Generator
    """
    found = characteristic(pad, rng)
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


def _bar_findings(found: ErrorBars) -> list[Finding]:
    group, single = np.median(found.group_percent), np.median(found.single_percent)
    return [
        Finding(
            "single elements vary by about ±100 %",
            f"at a load's worst element {single:.0f} % (median over loads), standard deviation "
            f"{np.median(found.single_sd_percent):.0f} %",
            bool(50.0 < single < 300.0),
        ),
        Finding(
            "the mean of four neighbours varies by about ±20 %",
            f"at a load's worst group {group:.0f} % (median over loads; from "
            f"{found.group_percent.min():.0f} to {found.group_percent.max():.0f} %), standard "
            f"deviation {np.median(found.group_sd_percent):.0f} %",
            bool(group <= 35.0),
        ),
        Finding(
            "averaging over four is a dramatic improvement",
            f"{single / group:.0f} times smaller error bars",
            bool(single > 3.0 * group),
        ),
    ]


def _bar_plot(figure: Figure, found: ErrorBars) -> None:
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


CHARACTERISTIC = Study(
    "characteristic",
    "figures 2.15, 2.16",
    "nine groups of four elements at random places, 0 to 700 g and 750 to 3000 g",
    characteristic,
    _table,
    _findings,
    _plot,
)
ERROR_BARS = Study(
    "error-bars",
    "figure 2.17",
    "scatter of single elements and of means of four",
    error_bars,
    _bar_table,
    _bar_findings,
    _bar_plot,
)
