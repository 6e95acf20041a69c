"""Table 4.9 and figures 4.38 to 4.43: identification by weight and area."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.measure.identification import mean_curves
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from tactile_graph_thesis.measure.identification_tables import Confusion, Curve

PADS = 3
"""Simulated pads over which the curves are averaged."""
QUICK_DIFFERENCES_G = (0, 200, 500, 1000, 1250, 2000)
THESIS_CLASSIFIER = "minimum_distance_normalised"


# -- table 4.9 -------------------------------------------------------------------------------


def _table_4_9(work: Work) -> Made:
    from tactile_graph_thesis.measure.identification_tables import table_4_9

    said = numbers("table-4.9")
    found = table_4_9(int(said["readings"]), work.seed)
    compared = tuple(
        Compared(
            f"{name}: readings identified",
            "%",
            100.0 * one.share_right,
            float(said["right_percent"]),
        )
        for name, one in found.items()
    )
    ours = found[THESIS_CLASSIFIER]
    rows = [
        (name, true, got, n)
        for name, one in found.items()
        for (true, got), n in sorted(one.nearest.items())
    ]
    return Made(
        compared,
        (
            Finding(
                "every reading of the five objects is identified",
                f"{100 * ours.share_right:.1f} % of {ours.n} by the thesis' classifier",
                ours.share_right == 1.0,
            ),
        ),
        Table(("classifier", "true", "identified as", "readings"), rows),
        _confusion_figure(ours),
    )


def _confusion_figure(found: Confusion) -> Any:
    counts = [[found.nearest.get((true, got), 0) for got in found.names] for true in found.names]
    figure = new_figure(6.4, 5.0)
    axes = figure.subplots()
    axes.imshow(counts, "Greys", vmin=0, vmax=2 * np.max(counts))
    at = range(len(found.names))
    for i in at:
        for j in at:
            axes.text(j, i, str(counts[i][j]), ha="center", va="center")
    axes.set_xticks(at, found.names, rotation=20)
    axes.set_yticks(at, found.names)
    axes.set(
        xlabel="identified as",
        ylabel="object on the pad",
        title="readings, classifier of equations 4.9 and 4.10",
    )
    return figure


# -- figures 4.38 to 4.43 --------------------------------------------------------------------


def _curves(work: Work) -> dict[str, Curve]:
    def made() -> dict[str, Curve]:
        fewer: dict[str, Any] = {"differences_g": QUICK_DIFFERENCES_G, "n_test": 25}
        seeds = range(work.seed, work.seed + (1 if work.quick else PADS))
        return {c.pair.figure: c for c in mean_curves(seeds, **(fewer if work.quick else {}))}

    return work.once("identification curves", made)


def _worst(curve: Curve, step: str = THESIS_CLASSIFIER) -> float:
    """Return the largest error beyond the thesis' difference in weight, in percent."""
    beyond = curve.differences_g > numbers("identification")["beyond_g"]
    return float(100.0 * curve.error[step][beyond].max())


def _figure(number: str) -> Any:
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
                _worst(curve) < limit,
            ),
            Finding(
                "the error decreases with the difference in weight",
                f"{error[0]:.0f} % at {curve.differences_g[0]:g} g, {error[-1]:.1f} % at "
                f"{curve.differences_g[-1]:g} g",
                bool(error[-1] < error[0] or error[0] == 0),
            ),
            *_about(number, work),
        )
        return Made((compared,), findings, _table(curve), _plot(curve, limit))

    return make


def _mean_error(work: Work, number: str) -> float:
    return float(100.0 * _curves(work)[number].error[THESIS_CLASSIFIER].mean())


def _about(number: str, work: Work) -> tuple[Finding, ...]:
    """Return what the thesis says of one figure beside the others."""
    if number == "4.38":
        errors = {n: _mean_error(work, n) for n in ("4.38", "4.39", "4.40")}
        words = ", ".join(f"figure {n} {e:.1f} %" for n, e in errors.items())
        return (
            Finding(
                "discs of 6.9 cm are told apart worse than smaller ones",
                f"mean error {words}",
                errors["4.38"] == max(errors.values()),
            ),
        )
    if number == "4.41":
        errors = {n: _mean_error(work, n) for n in ("4.41", "4.42", "4.43")}
        words = ", ".join(f"figure {n} {e:.1f} %" for n, e in errors.items())
        return (
            Finding(
                "of different radii, the nearest two are told apart worst",
                f"mean error {words}",
                errors["4.41"] == max(errors.values()),
            ),
        )
    return ()


def _table(curve: Curve) -> Table:
    rows = zip(curve.differences_g, *(100.0 * e for e in curve.error.values()), strict=True)
    return Table(
        ("difference_g", *(f"{name}_percent" for name in curve.error)),
        [tuple(map(float, row)) for row in rows],
    )


def _plot(curve: Curve, limit: float) -> Any:
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


_HEAVIER = "A weight piled on a disc stands a little off its centre; how far is assumed."
_SHOWS = "Readings taken for the wrong one of two discs, against their difference in weight"
ITEMS = (
    Item(
        "table-4.9",
        "Five objects identified",
        "Readings of each object of table 4.9, identified by weight and area.",
        _table_4_9,
        "The pentagon's size is not given; one is assumed.",
    ),
    *(
        Item(
            f"figure-{number}",
            f"Identification, {radii}",
            f"{_SHOWS}, {radii}.",
            _figure(number),
            _HEAVIER + more,
        )
        for number, radii, more in (
            ("4.38", "both of 6.9 cm", ""),
            ("4.39", "both of 6.1 cm", ""),
            ("4.40", "both of 4.3 cm", " The thesis' tables give two weights for this disc."),
            ("4.41", "6.9 and 6.1 cm", ""),
            ("4.42", "6.9 and 4.3 cm", " The thesis' caption repeats the pair before."),
            ("4.43", "6.1 and 4.3 cm", ""),
        )
    ),
)
