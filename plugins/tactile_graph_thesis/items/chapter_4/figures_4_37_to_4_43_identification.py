"""Figures 4.37 to 4.43: how often one of two discs is taken for the other, by weight and area."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.items.block_diagram import block_diagram
from tactile_graph_thesis.measure.identification_errors import (
    AS_IN_THE_THESIS,
    PAIRS,
    THESIS_CLASSIFIER,
    Curve,
    Pair,
    Trials,
    mean_curves,
)
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
SAID = "the error decreases with the difference in weight"
SAID_OF = ("4.38", "4.39", "4.40")
"""Figures of which the thesis says so."""
NOT_SAID = f"(not in the thesis) {SAID}"
SCARCE_PERCENT = 2.0
"""Largest error of a curve below which it is counting noise: six of 300 readings."""
FALLING = 0.8
"""Share of how errors vary that a falling curve explains where they decrease."""
PADS = 3
"""Simulated pads over which the curves are averaged."""
QUICK = Trials(differences_g=(0, 200, 500, 1000, 1250, 2000), n_test=25)


def _curves(work: Work) -> dict[str, Curve]:
    def made() -> dict[str, Curve]:
        trials = (QUICK if work.quick else AS_IN_THE_THESIS)._replace(pad=work.pad_name)
        seeds = range(work.seed, work.seed + (1 if work.quick else PADS))
        return {curve.pair.figure: curve for curve in mean_curves(seeds, trials)}

    return work.once("identification curves", made)


def _worst(curve: Curve, step: str = THESIS_CLASSIFIER) -> float:
    """Return the largest error beyond the thesis' difference in weight, in percent."""
    beyond = curve.differences_g > numbers("identification")["beyond_g"]
    return float(100.0 * curve.error[step][beyond].max())


def _figure(number: str) -> Callable[[Work], Made]:
    def make(work: Work) -> Made:
        curve, said = _curves(work)[number], numbers("identification")
        limit = float(said["error_below_percent"])
        error = 100.0 * curve.error[THESIS_CLASSIFIER]
        compared = Compared(
            f"largest error beyond {said['beyond_g']} g", "%", _worst(curve), limit, limit=True
        )
        findings = (
            Finding(
                f"the error falls below {limit:g} % beyond {said['beyond_g']} g",
                f"largest error there {_worst(curve):.1f} %",
                f"a reading of either pair in {100 / limit:.0f}, or more, taken for the other",
                _worst(curve) < limit,
            ),
            *decreases(curve.differences_g, error, SAID if number in SAID_OF else NOT_SAID),
            *_about(number, work),
        )
        return Made((compared,), findings, _table(curve), _plot(curve, limit))

    return make


def decreases(differences_g: Array, error_percent: Array, said: str = SAID) -> tuple[Finding, ...]:
    """Return whether errors fall as weights part; nothing where too few err to tell.

    Parameters
    ----------
    differences_g, error_percent : ndarray, shape (n,)
    said : str
        The finding's words.
    """
    if error_percent.max() < SCARCE_PERCENT:
        return ()
    about = error_percent - error_percent.mean()
    left = error_percent - falling(error_percent)
    explained = 1.0 - float(left @ left) / float(about @ about) if about.any() else 0.0
    return (
        Finding(
            said,
            f"{error_percent[0]:.0f} % at {differences_g[0]:g} g, {error_percent[-1]:.1f} % at "
            f"{differences_g[-1]:g} g; a curve that never rises explains {100 * explained:.0f} % "
            "of how errors vary",
            f"a falling curve that explains less than {100 * FALLING:.0f} %",
            explained >= FALLING,
        ),
    )


def falling(values: Array) -> Array:
    """Return the nearest values that never rise, by least squares, shape (n,).

    Parameters
    ----------
    values : ndarray, shape (n,)

    Notes
    -----
    Isotonic regression by the minimum of maxima of means (R. E. Barlow et al. 1972).
    """
    n = len(values)
    return np.array(
        [
            min(max(values[a:b].mean() for b in range(i + 1, n + 1)) for a in range(i + 1))
            for i in range(n)
        ]
    )


def _mean_error(work: Work, number: str) -> float:
    return float(100.0 * _curves(work)[number].error[THESIS_CLASSIFIER].mean())


def _about(number: str, work: Work) -> tuple[Finding, ...]:
    """Return what the thesis says of one figure beside the others."""
    if number == "4.38":
        thesis = "discs of 6.9 cm are told apart worse than smaller ones"
        return (_told_apart_worst(work, ("4.38", "4.39", "4.40"), thesis),)
    if number == "4.41":
        thesis = "of different radii, the nearest two are told apart worst"
        return (_told_apart_worst(work, ("4.41", "4.42", "4.43"), thesis),)
    return ()


def _told_apart_worst(work: Work, figures: tuple[str, ...], thesis: str) -> Finding:
    """Return whether the first of some figures has the largest mean error."""
    errors = {number: _mean_error(work, number) for number in figures}
    words = ", ".join(f"figure {number} {error:.1f} %" for number, error in errors.items())
    return Finding(
        thesis,
        f"mean error {words}",
        f"a larger error in any but figure {figures[0]}",
        errors[figures[0]] == max(errors.values()),
    )


def _table(curve: Curve) -> Table:
    rows = zip(curve.differences_g, *(100.0 * e for e in curve.error.values()), strict=True)
    return Table(
        ("difference_g", *(f"{name}_percent" for name in curve.error)),
        [tuple(map(float, row)) for row in rows],
    )


def _plot(curve: Curve, limit: float) -> Figure:
    figure = new_figure(7.5, 4.6)
    axes = figure.subplots()
    for name, error in curve.error.items():
        axes.plot(curve.differences_g, 100.0 * error, "o-", ms=4, label=name.replace("_", " "))
    axes.axhline(limit, color="0.5", ls=":", label=f"{limit:g} %")
    axes.axvline(numbers("identification")["beyond_g"], color="0.8", lw=1.0)
    pair = curve.pair
    axes.set(
        xlabel="difference in weight / g",
        ylabel="taken for the wrong disc / %",
        title=f"{pair.base_g:g} g, {pair.radius_cm:g} cm against "
        f"{pair.other_radius_cm:g} cm and heavier",
    )
    axes.set_ylim(bottom=-1.0)
    axes.grid(alpha=0.3)
    axes.legend()
    return figure


def _item(pair: Pair, more: str = "") -> Item:
    one, other = pair.radius_cm, pair.other_radius_cm
    radii = f"both of {one:g} cm" if one == other else f"{one:g} and {other:g} cm"
    return Item(
        f"figure-{pair.figure}",
        f"Identification, {radii}",
        "Readings taken for the wrong one of two discs, against their difference in weight, "
        f"{radii}.",
        _figure(pair.figure),
        "A weight piled on a disc stands a little off its centre; how far is assumed." + more,
    )


_MORE = {
    "4.40": " The thesis' tables give two weights for this disc.",
    "4.42": " The thesis' caption repeats the pair before.",
}
ITEMS = (
    block_diagram(
        "4.37",
        "thesis-identify",
        "Blocks of identification and localisation",
        "The thesis leaves open which features index the objects; weight and area are taken.",
    ),
    *(_item(pair, _MORE.get(pair.figure, "")) for pair in PAIRS),
)
