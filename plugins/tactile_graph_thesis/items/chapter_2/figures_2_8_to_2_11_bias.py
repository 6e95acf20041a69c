"""Figures 2.8 to 2.11: bias resistors, and what loaded neighbours in the column take."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.circuits.divider import Divider
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
RESISTANCE_OHM = np.geomspace(1e3, 1e6, 61)
"""From 2 kg on an element to a few grams."""
BIAS_OHM = np.arange(10e3, 101e3, 10e3)
COMPARED_OHM = np.array([20e3, 30e3, 40e3, 50e3])
NEIGHBOURS_OHM = (80e3,) * 8
"""100 g on each loaded neighbour."""
CHOSEN_BIAS_OHM = 33e3
EQUAL_NEIGHBOURS_OHM = np.array([60e3, 100e3, 150e3, 200e3, 300e3])
DRAWN_BETWEEN_OHM = (60e3, 300e3)


# -- the circuit -----------------------------------------------------------------------------


def element_volts(
    resistance_ohm: ArrayLike, bias_ohm: ArrayLike, neighbours_ohm: ArrayLike, supply_v: float
) -> Array:
    """Return the volts of one element of a column, shape (n_bias, n_resistance).

    Parameters
    ----------
    resistance_ohm : array_like, shape (n_resistance,)
        What the element is varied over.
    bias_ohm : array_like, shape (n_bias,)
        Bias resistors to try.
    neighbours_ohm : array_like, shape (n_neighbours,)
        The loaded others of its column; none for figure 2.8, eight of 80 kOhm for figure 2.9.
    supply_v : float
        What drives the row.
    """
    resistance, bias = np.atleast_1d(resistance_ohm), np.atleast_1d(bias_ohm)
    neighbours = np.atleast_1d(np.asarray(neighbours_ohm, dtype=np.float64))
    volts = np.empty((bias.size, resistance.size))
    columns = np.empty((1 + neighbours.size, resistance.size))
    columns[0] = 1.0 / resistance
    columns[1:] = 1.0 / neighbours[:, None]
    for row, ohm in enumerate(bias):
        circuit = Divider(bias_ohm=float(ohm), supply_v=supply_v)
        volts[row] = supply_v * circuit.ratio(columns)[0]
    return volts


# -- figures 2.8 to 2.10: several bias resistors -----------------------------------------------


class BiasCurves(NamedTuple):
    """Volts of one element against its resistance, for several bias resistors.

    Parameters
    ----------
    resistance_ohm : ndarray, shape (n,)
    bias_ohm : ndarray, shape (m,)
    alone_v, loaded_v : ndarray, shape (m, n)
        Without and with eight loaded neighbours in the column.
    """

    resistance_ohm: Array
    bias_ohm: Array
    alone_v: Array
    loaded_v: Array

    @property
    def coupling_v(self) -> Array:
        """Volts the neighbours take, shape (m, n)."""
        return self.alone_v - self.loaded_v

    def at_80_kohm(self, volts: Array) -> Array:
        """Return each bias resistor's volts at 80 kOhm, 100 g, shape (m,)."""
        log_ohm = np.log(self.resistance_ohm)
        return np.array([np.interp(np.log(80e3), log_ohm, row) for row in volts])


def bias_curves(supply_v: float, bias_ohm: Array = BIAS_OHM) -> BiasCurves:
    """Return an element's volts for several bias resistors, alone and with loaded neighbours.

    Parameters
    ----------
    supply_v : float
        The circuit is the divider, whatever the pad's own is.
    bias_ohm : ndarray, shape (m,)
    """
    alone_v, loaded_v = (
        element_volts(RESISTANCE_OHM, bias_ohm, neighbours, supply_v)
        for neighbours in ((), NEIGHBOURS_OHM)
    )
    return BiasCurves(RESISTANCE_OHM, bias_ohm, alone_v, loaded_v)


def _figure_2_8(work: Work) -> Made:
    found = bias_curves(work.pad.circuit.supply_v)
    figure = _curves_figure(found, found.alone_v, "nothing else loaded")
    return Made(
        findings=_sensitivity(found), table=_table(found, alone=found.alone_v), figure=figure
    )


def _sensitivity(found: BiasCurves) -> tuple[Finding, ...]:
    bias, volts = found.bias_ohm, found.alone_v
    at = found.at_80_kohm(volts)
    below, beyond = bias <= 40e3, bias >= 40e3
    rate_below = 1e4 * np.ptp(at[below]) / np.ptp(bias[below])
    rate_beyond = 1e4 * np.ptp(at[beyond]) / np.ptp(bias[beyond])
    ordered = bool((np.diff(volts, axis=0) > 0.0).all())
    return (
        Finding(
            "100 kOhm records the most and 10 kOhm the least, for any load",
            f"at 100 g {at[-1]:.2f} V against {at[0]:.2f} V; ordered by resistor at every load: "
            f"{'yes' if ordered else 'no'}",
            "a load at which a smaller resistor reads as much",
            ordered,
        ),
        Finding(
            "the sensitivity changes less rapidly beyond 40 kOhm",
            f"at 100 g {rate_below:.2f} V for each 10 kOhm below, {rate_beyond:.2f} V beyond",
            "a rise beyond that is three quarters of that below, or more",
            bool(rate_beyond < 0.75 * rate_below),
        ),
    )


def _figure_2_9(work: Work) -> Made:
    found = bias_curves(work.pad.circuit.supply_v)
    figure = _curves_figure(found, found.loaded_v, "eight neighbours of 80 kOhm in the column")
    return Made(
        findings=_clustering(found), table=_table(found, loaded=found.loaded_v), figure=figure
    )


def _rise(found: BiasCurves, volts: Array) -> float:
    """Return by how much 100 kOhm reads more than 50 kOhm, at most, as a share."""
    fifty = int(np.flatnonzero(found.bias_ohm == 50e3)[0])
    return float((volts[-1] / volts[fifty]).max() - 1.0)


def _clustering(found: BiasCurves) -> tuple[Finding, ...]:
    alone, loaded = _rise(found, found.alone_v), _rise(found, found.loaded_v)
    taken = found.at_80_kohm(found.coupling_v) / found.at_80_kohm(found.alone_v)
    shares = zip(found.bias_ohm[::3], taken[::3], strict=True)
    words = ", ".join(f"{100 * share:.0f} % at {ohm / 1e3:.0f} kOhm" for ohm, share in shares)
    return (
        Finding(
            "with eight loaded neighbours the curves beyond 50 kOhm lie close together",
            f"from 50 to 100 kOhm the reading rises by at most {100 * loaded:.0f} % loaded, "
            f"{100 * alone:.0f} % alone",
            "a rise of 15 % when loaded, or of a fifth of that alone",
            loaded < 0.15 and loaded < 0.2 * alone,
        ),
        Finding(
            "the coupling is more pronounced for resistors above 50 kOhm",
            f"at 100 g the neighbours take {words}",
            "a load at which a larger resistor loses less",
            bool((np.diff(found.coupling_v, axis=0) > 0.0).all()),
        ),
    )


def _figure_2_10(work: Work) -> Made:
    found = bias_curves(work.pad.circuit.supply_v, COMPARED_OHM)
    figure = new_figure()
    axes = figure.subplots()
    kohm = found.resistance_ohm / 1e3
    for k, ohm in enumerate(found.bias_ohm):
        label = f"{ohm / 1e3:.0f} kOhm"
        axes.plot(kohm, found.alone_v[k], color=f"C{k}", label=f"{label} alone")
        axes.plot(kohm, found.loaded_v[k], color=f"C{k}", ls="--", label=f"{label} loaded")
    _finish(axes, "Before and after eight neighbours of 80 kOhm", "bias resistor")
    table = _table(found, alone=found.alone_v, loaded=found.loaded_v)
    return Made(findings=(_least_coupling(found),), table=table, figure=figure)


def _least_coupling(found: BiasCurves) -> Finding:
    taken = dict(zip(found.bias_ohm, found.at_80_kohm(found.coupling_v), strict=True))
    three = found.coupling_v[np.isin(found.bias_ohm, (30e3, 40e3, 50e3))]
    least = bool((three[0] < three[1:]).all())
    words = ", ".join(f"{v:.2f} V at {ohm / 1e3:.0f} kOhm" for ohm, v in taken.items())
    return Finding(
        "of 30, 40 and 50 kOhm the coupling is least at 30 kOhm",
        f"at 100 g {words}; least at every load: {'yes' if least else 'no'}",
        "a load at which 40 or 50 kOhm lose less",
        least,
    )


# -- figure 2.11: several loads of the neighbours ----------------------------------------------


class NeighbourCurves(NamedTuple):
    """Volts of one element against its resistance, for several loads of its neighbours.

    Parameters
    ----------
    resistance_ohm : ndarray, shape (n,)
    neighbours_ohm : ndarray, shape (m, 8)
        The eight loaded neighbours of each curve: first sets of equal ones, then one drawn.
    alone_v : ndarray, shape (n,)
    loaded_v : ndarray, shape (m, n)
    """

    resistance_ohm: Array
    neighbours_ohm: Array
    alone_v: Array
    loaded_v: Array

    @property
    def names(self) -> list[str]:
        """What to call each set of neighbours."""
        return [*(f"8 at {row[0] / 1e3:g} kOhm" for row in self.neighbours_ohm[:-1]), "8 drawn"]


def neighbour_curves(pad: Pad, rng: np.random.Generator) -> NeighbourCurves:
    """Return an element's volts at 33 kOhm with neighbours of 60 to 300 kOhm.

    Parameters
    ----------
    pad : Pad
        Its supply is meant.
    rng : numpy.random.Generator
        Draws the last set, in which the eight differ.

    Notes
    -----
    The text gives its eight neighbours "the same resistance variations each", spread over 60 to
    300 kOhm; both readings of that are here: eight equal ones a curve, and eight drawn ones.
    Where in the column they sit makes no difference to this circuit.
    """
    n = len(NEIGHBOURS_OHM)
    equal = np.repeat(EQUAL_NEIGHBOURS_OHM[:, None], n, axis=1)
    sets = np.vstack([equal, rng.uniform(*DRAWN_BETWEEN_OHM, n)])
    supply = pad.circuit.supply_v
    loaded = [element_volts(RESISTANCE_OHM, CHOSEN_BIAS_OHM, ohms, supply)[0] for ohms in sets]
    alone = element_volts(RESISTANCE_OHM, CHOSEN_BIAS_OHM, (), supply)[0]
    return NeighbourCurves(RESISTANCE_OHM, sets, alone, np.array(loaded))


def _figure_2_11(work: Work) -> Made:
    found = work.on_pad(neighbour_curves)
    figure = new_figure()
    axes = figure.subplots()
    kohm = found.resistance_ohm / 1e3
    axes.plot(kohm, found.alone_v, "k", label="alone")
    for name, row in zip(found.names, found.loaded_v, strict=True):
        axes.plot(kohm, row, "--" if name == "8 drawn" else "-", label=name)
    _finish(axes, "33 kOhm with eight loaded neighbours", "neighbours", 1)
    columns = ("resistance_ohm", "alone_V", *(f"{name}_V" for name in found.names))
    values = np.column_stack([found.resistance_ohm, found.alone_v, found.loaded_v.T])
    table = Table(columns, [tuple(map(float, row)) for row in values])
    return Made(findings=(_more_from_heavier(found),), table=table, figure=figure)


def _more_from_heavier(found: NeighbourCurves) -> Finding:
    taken = found.alone_v - found.loaded_v
    k = int(np.argmin(abs(found.resistance_ohm - 80e3)))
    share = 100 * taken[:, k] / found.alone_v[k]
    falls = bool((np.diff(taken[:-1], axis=0) < 0.0).all())
    between = bool((taken[-1] < taken[0]).all() and (taken[-1] > taken[-2]).all())
    words = ", ".join(f"{s:.0f} % ({n})" for s, n in zip(share, found.names, strict=True))
    return Finding(
        "the coupling is more pronounced for smaller loading resistances",
        f"of an element at {found.resistance_ohm[k] / 1e3:.0f} kOhm the neighbours take "
        f"{words}; so at every load: {'yes' if falls and between else 'no'}",
        "a load at which neighbours of less resistance take less, or random ones do not take a "
        "middling share",
        falls and between,
    )


# -- tables and drawing ------------------------------------------------------------------------


def _table(found: BiasCurves, **curves_v: Array) -> Table:
    """Return curves, such as ``alone``, side by side for each bias resistor."""
    names = [f"{ohm / 1e3:g} kOhm {kind}_V" for kind in curves_v for ohm in found.bias_ohm]
    values = np.column_stack([found.resistance_ohm, np.concatenate(list(curves_v.values())).T])
    return Table(("resistance_ohm", *names), [tuple(map(float, row)) for row in values])


def _curves_figure(found: BiasCurves, volts: Array, condition: str) -> Figure:
    from matplotlib import colormaps

    figure = new_figure()
    axes = figure.subplots()
    shades = colormaps["viridis"](np.linspace(0.0, 0.9, len(found.bias_ohm)))
    for ohm, row, shade in zip(found.bias_ohm, volts, shades, strict=True):
        axes.plot(found.resistance_ohm / 1e3, row, color=shade, label=f"{ohm / 1e3:.0f} kOhm")
    _finish(axes, f"Bias resistors, {condition}", "bias resistor")
    return figure


def _finish(axes: Axes, title: str, legend: str, columns: int = 2) -> None:
    """Give an axis of resistances its scale and words, and one of volts."""
    axes.set_xscale("log")
    axes.set(xlabel="resistance of the element / kOhm  (lighter →)", ylabel="output / V")
    axes.grid(alpha=0.3, which="both")
    axes.set_title(title)
    axes.legend(title=legend, ncols=columns)


_CIRCUIT = "Nothing is random here: the circuit is solved as drawn, where the thesis used HSPICE."
ITEMS = (
    Item(
        "figure-2.8",
        "Bias resistors and sensitivity",
        "Volts of a lone element against its resistance, for ten bias resistors.",
        _figure_2_8,
        _CIRCUIT,
        study="bias-sensitivity",
    ),
    Item(
        "figure-2.9",
        "Bias resistors with a loaded column",
        "The same with eight loaded neighbours in the column.",
        _figure_2_9,
        _CIRCUIT,
        study="bias-loaded",
    ),
    Item(
        "figure-2.10",
        "What the neighbours take",
        "Both together, for the four resistors that remain of interest.",
        _figure_2_10,
        _CIRCUIT,
        study="bias-coupling",
    ),
    Item(
        "figure-2.11",
        "Coupling at 33 kOhm",
        "An element with eight neighbours of several loads.",
        _figure_2_11,
        "The thesis drew its neighbours' loads at random and does not list them.",
        study="bias-random",
    ),
)
