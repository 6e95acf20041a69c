"""Figures 2.12 to 2.14: a disc as it is read, with sand under it, and through foam."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import UsageError
from tactile_graph.wires import Circle
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.contact import Contact, Grain
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.bench import ON_ONE_PAD, Bench
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

Array = NDArray[np.float64]
GRAIN = Grain(row=5, column=5, share=0.9)
FOAM_CM = 1.3


class Footprints(NamedTuple):
    """The same object read without and with something put between it and the pad.

    Parameters
    ----------
    before_v, after_v : ndarray, shape (rows, columns)
    before_g, after_g : ndarray, shape (rows, columns)
        What each element truly bore.
    covered : ndarray, shape (rows, columns)
        Share of each element that lies under the object.
    outline : ndarray, shape (n, 2)
        The object's outline in columns and rows.
    """

    before_v: Array
    after_v: Array
    before_g: Array
    after_g: Array
    covered: Array
    outline: Array


def bump(pad: Pad, rng: np.random.Generator) -> Footprints:
    """Return a disc of 2000 g and 2.5 cm read without and with a grain of sand under it.

    Parameters
    ----------
    pad : Pad
    rng : numpy.random.Generator
        Draws the unevenness, the same for both, and the noise.

    Raises
    ------
    UsageError
        If the grain's element is not on the pad.
    """
    rows, columns = pad.geometry.shape
    if GRAIN.row >= rows or GRAIN.column >= columns:
        raise UsageError(
            f"the grain's element ({GRAIN.row}, {GRAIN.column}) is not on the pad of {rows} rows "
            f"and {columns} columns"
        )
    centre = _centre_of(pad, GRAIN)
    return _compare(pad, replace(pad.contact, sand=(GRAIN,)), Circle(*centre, 2.5), 2000.0, rng)


def foam(pad: Pad, rng: np.random.Generator) -> Footprints:
    """Return the disc of figure 2.12, 1860 g and 6.9 cm, read without and with a foam pad.

    Parameters
    ----------
    pad : Pad
    rng : numpy.random.Generator
    """
    width, height = pad.geometry.size_cm
    disc = Circle(width / 2, height / 2, 6.9)
    return _compare(pad, replace(pad.contact, foam_cm=FOAM_CM), disc, 1860.0, rng)


def _centre_of(pad: Pad, grain: Grain) -> tuple[float, float]:
    return float(pad.geometry.x_cm[grain.column]), float(pad.geometry.y_cm[grain.row])


def _compare(
    pad: Pad, contact: Contact, disc: Circle, weight_g: float, rng: np.random.Generator
) -> Footprints:
    bench = Bench(pad, rng)
    gains = bench.gains()
    before = bench.load_g(disc, weight_g, gains)
    before_v = bench.volts(before)
    bench.pad = replace(pad, contact=contact)
    after = bench.load_g(disc, weight_g, gains)
    covered = coverage_cm2(disc, pad.geometry) / pad.geometry.element_area_cm2
    outline = (disc.outline_cm() - 0.5 * pad.geometry.element_cm) / pad.geometry.pitch_cm
    return Footprints(before_v, bench.volts(after), before, after, covered, outline)


def unevenness(volts: Array, covered: Array) -> float:
    """Return the scatter of wholly covered elements over their mean.

    Parameters
    ----------
    volts, covered : ndarray, shape (rows, columns)
    """
    inside = volts[covered > 0.999]
    return float(inside.std() / inside.mean())


def edge_contrast(volts: Array, covered: Array) -> float:
    """Return how much higher the object's rim reads than the ring around it, 0 to 1.

    The rim are the covered elements beside uncovered ones, the ring the uncovered ones beside
    covered ones; the difference of their means over the sum.

    Parameters
    ----------
    volts, covered : ndarray, shape (rows, columns)
    """
    inside = covered > 0.5
    ring = _beside(inside) & ~inside
    rim = _beside(~inside) & inside
    high, low = volts[rim].mean(), volts[ring].mean()
    return float((high - low) / (high + low))


def _beside(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    grown = mask.copy()
    grown[1:] |= mask[:-1]
    grown[:-1] |= mask[1:]
    grown[:, 1:] |= mask[:, :-1]
    grown[:, :-1] |= mask[:, 1:]
    return grown


def _table(found: Footprints) -> Table:
    rows, columns = found.before_v.shape
    names = ("row", "column", "covered", "before_g", "after_g", "before_V", "after_V")
    fields = (found.covered, found.before_g, found.after_g, found.before_v, found.after_v)
    touched = (found.before_g > 0.0) | (found.after_g > 1e-3)
    return Table(
        names,
        [
            (i, j, *(float(values[i, j]) for values in fields))
            for i in range(rows)
            for j in range(columns)
            if touched[i, j]
        ],
    )


def _all_on_the_grain(found: Footprints) -> Finding:
    at = (GRAIN.row, GRAIN.column)
    before, after = (max(v[at], 0.0) / v.sum() for v in (found.before_v, found.after_v))
    n_before, n_after = (int((v > 0.1).sum()) for v in (found.before_v, found.after_v))
    return Finding(
        "the whole image of the disc seems to lie on the bump (figure 2.13)",
        f"element {at} holds {100 * after:.0f} % of all volts ({100 * before:.0f} % without "
        f"the grain); {n_after} of {n_before} elements still read above 0.1 V",
        "less than half of all volts on the grain's element, or more elements that read than "
        "without it",
        bool(after > 0.5 and n_after <= n_before),
    )


def _smoothed(found: Footprints) -> tuple[Finding, ...]:
    rough = [unevenness(v, found.covered) for v in (found.before_v, found.after_v)]
    edge = [edge_contrast(v, found.covered) for v in (found.before_v, found.after_v)]
    return (
        Finding(
            "with foam the force is spread more evenly, as by a low-pass filter (figure 2.14)",
            f"scatter inside the footprint {100 * rough[0]:.0f} % without, "
            f"{100 * rough[1]:.0f} % with",
            "scatter that falls by less than three tenths",
            rough[1] < 0.7 * rough[0],
        ),
        Finding(
            "with foam object and background are less distinct",
            f"contrast of rim against surroundings {edge[0]:.2f} without, {edge[1]:.2f} with",
            "contrast that falls by less than a fifth",
            edge[1] < 0.8 * edge[0],
        ),
    )


# -- the figures -----------------------------------------------------------------------------


def _draw(axes: Axes, volts: Array, outline: Array, top: float | None = None) -> AxesImage:
    shown = axes.imshow(volts, cmap="gray", vmin=0.0, vmax=top)
    axes.fill(*outline.T, fill=False, edgecolor="tab:orange", label="true outline")
    axes.set_xlabel("column")
    return shown


def _pair_figure(found: Footprints, before: str, after: str) -> Figure:
    figure = new_figure(12.0, 5.0)
    both = figure.subplots(1, 2, sharey=True)
    top = float(max(found.before_v.max(), found.after_v.max()))
    for axes, volts, name in zip(
        both, (found.before_v, found.after_v), (before, after), strict=True
    ):
        shown = _draw(axes, volts, found.outline, top)
        axes.set_title(name)
    both[0].set_ylabel("row")
    figure.colorbar(shown, ax=both, label="output / V", shrink=0.8)
    return figure


def _figure_2_12(work: Work) -> Made:
    found = work.on_pad(foam)
    figure = new_figure(6.0, 5.0)
    axes = figure.subplots()
    shown = _draw(axes, found.before_v, found.outline)
    axes.set(title="disc of 1860 g, 6.9 cm", ylabel="row")
    axes.legend(loc="upper right")
    figure.colorbar(shown, ax=axes, label="output / V", shrink=0.8)
    return Made(figure=figure)


def _figure_2_13(work: Work) -> Made:
    found = work.on_pad(bump)
    on_sand = f"on sand at ({GRAIN.row}, {GRAIN.column})"
    figure = _pair_figure(found, "disc of 2000 g, 2.5 cm", on_sand)
    return Made(findings=(_all_on_the_grain(found),), table=_table(found), figure=figure)


def _figure_2_14(work: Work) -> Made:
    found = work.on_pad(foam)
    figure = _pair_figure(found, "disc of 1860 g, 6.9 cm", f"through foam of {FOAM_CM:g} cm")
    return Made(findings=_smoothed(found), table=_table(found), figure=figure)


ITEMS = (
    Item(
        "figure-2.12",
        "A reading of a disc",
        "A disc as the pad reads it, with pressure on a few elements and none on others.",
        _figure_2_12,
        ON_ONE_PAD,
    ),
    Item(
        "figure-2.13",
        "A grain of sand",
        "A disc without and with a grain of sand under one element.",
        _figure_2_13,
        ON_ONE_PAD + " The grain bears a share of the weight that is assumed, not measured.",
        study="bump",
    ),
    Item(
        "figure-2.14",
        "A foam pad",
        "The disc of figure 2.12 without and with foam between it and the pad.",
        _figure_2_14,
        ON_ONE_PAD + " Foam is modelled as a spread of the load over a fixed distance.",
        study="foam",
    ),
)
