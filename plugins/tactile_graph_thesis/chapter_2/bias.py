"""Studies ``bias-sensitivity``, ``bias-loaded``, ``bias-coupling``: figures 2.8, 2.9 and 2.10."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.chapter_2.column import element_volts
from tactile_graph_thesis.chapter_2.study import Finding, Study, Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
RESISTANCE_OHM = np.geomspace(1e3, 1e6, 61)
"""From 2 kg on an element to a few grams."""
BIAS_OHM = np.arange(10e3, 101e3, 10e3)
COMPARED_OHM = np.array([20e3, 30e3, 40e3, 50e3])
NEIGHBOUR_OHM = 80e3
"""100 g on each loaded neighbour."""
N_NEIGHBOURS = 8


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


def bias_curves(
    pad: Pad, rng: np.random.Generator | None = None, bias_ohm: Array = BIAS_OHM
) -> BiasCurves:
    """Return an element's volts for several bias resistors, alone and with loaded neighbours.

    Parameters
    ----------
    pad : Pad
        Its supply is meant; the circuit is the divider whatever the pad's own is.
    rng : numpy.random.Generator, optional
        Not used: nothing here is random.
    bias_ohm : ndarray, shape (m,)
    """
    supply = pad.circuit.supply_v
    neighbours = (NEIGHBOUR_OHM,) * N_NEIGHBOURS
    return BiasCurves(
        RESISTANCE_OHM,
        bias_ohm,
        element_volts(RESISTANCE_OHM, bias_ohm, (), supply),
        element_volts(RESISTANCE_OHM, bias_ohm, neighbours, supply),
    )


# -- figure 2.8 ------------------------------------------------------------------------------


def _sensitivity_findings(found: BiasCurves) -> list[Finding]:
    bias, volts = found.bias_ohm, found.alone_v
    at = found.at_80_kohm(volts)
    below, beyond = bias <= 40e3, bias >= 40e3
    rate_below = 1e4 * np.ptp(at[below]) / np.ptp(bias[below])
    rate_beyond = 1e4 * np.ptp(at[beyond]) / np.ptp(bias[beyond])
    ordered = bool((np.diff(volts, axis=0) > 0.0).all())
    return [
        Finding(
            "100 kOhm records the most and 10 kOhm the least, for any load",
            f"at 100 g {at[-1]:.2f} V against {at[0]:.2f} V; ordered by resistor at every load: "
            f"{'yes' if ordered else 'no'}",
            ordered,
        ),
        Finding(
            "the sensitivity changes less rapidly beyond 40 kOhm",
            f"at 100 g {rate_below:.2f} V for each 10 kOhm below, {rate_beyond:.2f} V beyond",
            bool(rate_beyond < 0.75 * rate_below),
        ),
    ]


# -- figure 2.9 ------------------------------------------------------------------------------


def _spread(found: BiasCurves, volts: Array) -> float:
    """Return by how much 100 kOhm reads more than 50 kOhm, at most, as a share."""
    fifty = int(np.flatnonzero(found.bias_ohm == 50e3)[0])
    return float((volts[-1] / volts[fifty]).max() - 1.0)


def _loaded_findings(found: BiasCurves) -> list[Finding]:
    alone, loaded = _spread(found, found.alone_v), _spread(found, found.loaded_v)
    return [
        Finding(
            "with eight loaded neighbours the curves beyond 50 kOhm lie close together",
            f"from 50 to 100 kOhm the reading rises by at most {100 * loaded:.0f} % loaded, "
            f"{100 * alone:.0f} % alone",
            loaded < 0.15 and loaded < 0.2 * alone,
        ),
        Finding(
            "the coupling is more pronounced for resistors above 50 kOhm",
            "at 100 g the neighbours take "
            + ", ".join(
                f"{100 * share:.0f} % at {ohm / 1e3:.0f} kOhm"
                for ohm, share in zip(
                    found.bias_ohm[::3],
                    (found.at_80_kohm(found.coupling_v) / found.at_80_kohm(found.alone_v))[::3],
                    strict=True,
                )
            ),
            bool((np.diff(found.coupling_v, axis=0) > 0.0).all()),
        ),
    ]


# -- figure 2.10 -----------------------------------------------------------------------------


def _coupling_findings(found: BiasCurves) -> list[Finding]:
    taken = dict(zip(found.bias_ohm, found.at_80_kohm(found.coupling_v), strict=True))
    three = found.coupling_v[np.isin(found.bias_ohm, (30e3, 40e3, 50e3))]
    least = bool((three[0] < three[1:]).all())
    return [
        Finding(
            "of 30, 40 and 50 kOhm the coupling is least at 30 kOhm",
            "at 100 g "
            + ", ".join(f"{v:.2f} V at {ohm / 1e3:.0f} kOhm" for ohm, v in taken.items())
            + f"; least at every load: {'yes' if least else 'no'}",
            least,
        )
    ]


# -- tables and plots ------------------------------------------------------------------------


def _table(found: BiasCurves, loaded: bool, alone: bool = True) -> Table:
    curves = {"alone": found.alone_v} if alone else {}
    if loaded:
        curves["loaded"] = found.loaded_v
    names = [f"{ohm / 1e3:g} kOhm {kind}_V" for kind in curves for ohm in found.bias_ohm]
    values = np.concatenate(list(curves.values())).T
    rows = [
        (float(ohm), *map(float, row))
        for ohm, row in zip(found.resistance_ohm, values, strict=True)
    ]
    return Table(("resistance_ohm", *names), rows)


def label_resistance(axes: Axes) -> None:
    """Give an axis of resistances its scale and words, and one of volts."""
    axes.set_xscale("log")
    axes.set(xlabel="resistance of the element / kOhm  (lighter →)", ylabel="output / V")
    axes.grid(alpha=0.3, which="both")


def _plot(figure: Figure, found: BiasCurves, loaded: bool) -> None:
    from matplotlib import colormaps

    axes = figure.subplots()
    volts = found.loaded_v if loaded else found.alone_v
    shades = colormaps["viridis"](np.linspace(0.0, 0.9, len(found.bias_ohm)))
    for ohm, row, shade in zip(found.bias_ohm, volts, shades, strict=True):
        axes.plot(found.resistance_ohm / 1e3, row, color=shade, label=f"{ohm / 1e3:.0f} kOhm")
    label_resistance(axes)
    title = "eight neighbours of 80 kOhm in the column" if loaded else "nothing else loaded"
    axes.set_title(f"Bias resistors, {title}")
    axes.legend(title="bias resistor", ncols=2)


def _plot_pairs(figure: Figure, found: BiasCurves) -> None:
    axes = figure.subplots()
    for k, ohm in enumerate(found.bias_ohm):
        label = f"{ohm / 1e3:.0f} kOhm"
        kohm = found.resistance_ohm / 1e3
        axes.plot(kohm, found.alone_v[k], color=f"C{k}", label=f"{label} alone")
        axes.plot(kohm, found.loaded_v[k], color=f"C{k}", ls="--", label=f"{label} loaded")
    label_resistance(axes)
    axes.set_title("Before and after eight neighbours of 80 kOhm")
    axes.legend(title="bias resistor", ncols=2)


BIAS_SENSITIVITY = Study(
    "bias-sensitivity",
    "figure 2.8",
    "volts of a lone element for bias resistors of 10 to 100 kOhm",
    bias_curves,
    partial(_table, loaded=False),
    _sensitivity_findings,
    partial(_plot, loaded=False),
)
BIAS_LOADED = Study(
    "bias-loaded",
    "figure 2.9",
    "the same with 8 of the column's other 15 elements at 80 kOhm",
    bias_curves,
    partial(_table, loaded=True, alone=False),
    _loaded_findings,
    partial(_plot, loaded=True),
)
BIAS_COUPLING = Study(
    "bias-coupling",
    "figure 2.10",
    "both at 20 to 50 kOhm: how much the neighbours take",
    partial(bias_curves, bias_ohm=COMPARED_OHM),
    partial(_table, loaded=True),
    _coupling_findings,
    _plot_pairs,
)
