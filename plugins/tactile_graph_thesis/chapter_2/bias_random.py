"""Study ``bias-random``: 33 kOhm with eight neighbours at random places (figure 2.11)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.chapter_2.bias import N_NEIGHBOURS, RESISTANCE_OHM, label_resistance
from tactile_graph_thesis.chapter_2.column import element_volts, random_neighbours
from tactile_graph_thesis.chapter_2.study import Finding, Study, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
BIAS_OHM = 33e3
COMMON_OHM = np.array([60e3, 100e3, 150e3, 200e3, 300e3])


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


def bias_random(pad: Pad, rng: np.random.Generator) -> NeighbourCurves:
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
    equal = np.repeat(COMMON_OHM[:, None], N_NEIGHBOURS, axis=1)
    sets = np.vstack([equal, random_neighbours(rng, N_NEIGHBOURS)])
    supply = pad.circuit.supply_v
    loaded = [element_volts(RESISTANCE_OHM, BIAS_OHM, ohms, supply)[0] for ohms in sets]
    alone = element_volts(RESISTANCE_OHM, BIAS_OHM, (), supply)[0]
    return NeighbourCurves(RESISTANCE_OHM, sets, alone, np.array(loaded))


def _names(found: NeighbourCurves) -> list[str]:
    equal = [f"8 at {row[0] / 1e3:g} kOhm" for row in found.neighbours_ohm[:-1]]
    return [*equal, "8 drawn"]


def _table(found: NeighbourCurves) -> Table:
    columns = ("resistance_ohm", "alone_V", *(f"{name}_V" for name in _names(found)))
    values = np.column_stack([found.resistance_ohm, found.alone_v, found.loaded_v.T])
    return Table(columns, [tuple(map(float, row)) for row in values])


def _findings(found: NeighbourCurves) -> list[Finding]:
    taken = found.alone_v - found.loaded_v
    k = int(np.argmin(abs(found.resistance_ohm - 80e3)))
    share = 100 * taken[:, k] / found.alone_v[k]
    falls = bool((np.diff(taken[:-1], axis=0) < 0.0).all())
    between = bool((taken[-1] < taken[0]).all() and (taken[-1] > taken[-2]).all())
    words = ", ".join(f"{s:.0f} % ({n})" for s, n in zip(share, _names(found), strict=True))
    return [
        Finding(
            "the coupling is more pronounced for smaller loading resistances",
            f"of an element at {found.resistance_ohm[k] / 1e3:.0f} kOhm the neighbours take "
            f"{words}; so at every load: {'yes' if falls and between else 'no'}",
            falls and between,
        )
    ]


def _plot(figure: Figure, found: NeighbourCurves) -> None:
    axes = figure.subplots()
    kohm = found.resistance_ohm / 1e3
    axes.plot(kohm, found.alone_v, "k", label="alone")
    for name, row in zip(_names(found), found.loaded_v, strict=True):
        axes.plot(kohm, row, "--" if name == "8 drawn" else "-", label=name)
    label_resistance(axes)
    axes.set_title("33 kOhm with eight loaded neighbours")
    axes.legend(title="neighbours")


BIAS_RANDOM = Study(
    "bias-random",
    "figure 2.11",
    "volts at 33 kOhm with 8 random neighbours of 60 to 300 kOhm",
    bias_random,
    _table,
    _findings,
    _plot,
)
