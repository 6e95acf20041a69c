"""Figures 2.8 to 2.19: the studies of the pads family, one or more figures each."""

from __future__ import annotations

from typing import Any

from tactile_graph_thesis.item import Item, Made
from tactile_graph_thesis.work import Work

WIDE = ("bump", "foam", "characteristic", "weight-area")
_ON_ONE_PAD = "Ours is one simulated pad, drawn from the seed; another seed gives another pad."
_CIRCUIT = "Nothing is random here: the circuit is solved as drawn, where the thesis used HSPICE."


def study_done(work: Work, name: str) -> tuple[Any, Any]:
    """Return a study and what it found on the thesis' pad.

    Parameters
    ----------
    work : Work
    name : str
        As ``tactile-graph study`` names it.
    """
    import numpy as np

    from tactile_graph_pads.pad import load_pad
    from tactile_graph_thesis.chapter_2 import load_study

    study = load_study(name)
    rng = np.random.default_rng(work.seed)
    return study, work.once(("study", name), lambda: study.run(load_pad("thesis"), rng))


def _whole(name: str) -> Any:
    """Return a function that makes a study's own figure, table and findings."""

    def make(work: Work) -> Made:
        from tactile_graph_pads.calibration.plot import new_figure

        study, found = study_done(work, name)
        figure = new_figure(*((12.0, 5.0) if name in WIDE else (7.5, 5.0)))
        study.plot(figure, found)
        return Made(findings=tuple(study.findings(found)), table=study.table(found), figure=figure)

    return make


def _figure_2_12(work: Work) -> Made:
    from tactile_graph_pads.calibration.plot import new_figure

    found = study_done(work, "foam")[1]
    figure = new_figure(6.0, 5.0)
    axes = figure.subplots()
    shown = axes.imshow(found.before_v, cmap="gray", vmin=0.0)
    axes.fill(*found.outline.T, fill=False, edgecolor="tab:orange", label="true outline")
    axes.set(title="disc of 1860 g, 6.9 cm", xlabel="column", ylabel="row")
    axes.legend(loc="upper right")
    figure.colorbar(shown, ax=axes, label="output / V", shrink=0.8)
    return Made(figure=figure)


def _figure_2_16(work: Work) -> Made:
    from tactile_graph_pads.calibration.plot import new_figure

    study, found = study_done(work, "characteristic")
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
    return Made(table=study.table(found), figure=figure)


def _item(figure: str, study: Any, title: str, shows: str, why: str) -> Item:
    make = _whole(study) if isinstance(study, str) else study
    return Item(f"figure-{figure}", title, shows, make, why)


ITEMS = (
    _item(
        "2.8",
        "bias-sensitivity",
        "Bias resistors and sensitivity",
        "Volts of a lone element against its resistance, for ten bias resistors.",
        _CIRCUIT,
    ),
    _item(
        "2.9",
        "bias-loaded",
        "Bias resistors with a loaded column",
        "The same with eight loaded neighbours in the column.",
        _CIRCUIT,
    ),
    _item(
        "2.10",
        "bias-coupling",
        "What the neighbours take",
        "Both together, for the four resistors that remain of interest.",
        _CIRCUIT,
    ),
    _item(
        "2.11",
        "bias-random",
        "Coupling at 33 kOhm",
        "An element with eight neighbours of several loads.",
        "The thesis drew its neighbours' loads at random and does not list them.",
    ),
    _item(
        "2.12",
        _figure_2_12,
        "A reading of a disc",
        "A disc as the pad reads it, with pressure on a few elements and none on others.",
        _ON_ONE_PAD,
    ),
    _item(
        "2.13",
        "bump",
        "A grain of sand",
        "A disc without and with a grain of sand under one element.",
        _ON_ONE_PAD + " The grain bears a share of the weight that is assumed, not measured.",
    ),
    _item(
        "2.14",
        "foam",
        "A foam pad",
        "The disc of figure 2.12 without and with foam between it and the pad.",
        _ON_ONE_PAD + " Foam is modelled as a spread of the load over a fixed distance.",
    ),
    _item(
        "2.15",
        "characteristic",
        "Groups of four under rising weights",
        "Mean reading of nine groups of four elements, in two ranges of weight.",
        _ON_ONE_PAD,
    ),
    _item(
        "2.16",
        _figure_2_16,
        "The characteristic of an element",
        "The same with weights divided by four.",
        _ON_ONE_PAD,
    ),
    _item(
        "2.17",
        "error-bars",
        "Error bars of a calibration",
        "Scatter of single elements and of means of four.",
        _ON_ONE_PAD + " The thesis put stacked weights on single elements by hand; here single "
        "elements are the members of a group, since the model knows nothing of where on an "
        "element a load stands.",
    ),
    _item(
        "2.18",
        "curve",
        "The calibration curve",
        "A fifth-order polynomial through the group means, and two other curves.",
        _ON_ONE_PAD,
    ),
    _item(
        "2.19",
        "weight-area",
        "Weight against area",
        "Weights found for the discs of table 2.2 under rising pressure.",
        _ON_ONE_PAD + " The order by area is the coupling's: it vanishes where the circuit is "
        "inverted, which the thesis did not do.",
    ),
)
