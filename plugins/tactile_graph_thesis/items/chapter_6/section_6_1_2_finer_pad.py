"""Section 6.1.2: what smaller elements are worth: circle-3 on pads with the same area."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import load
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.geometry import Geometry
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.circles import circle_errors
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
FINER = (1, 2, 3)
"""How many elements stand in the place of one, each way."""
DISCS = ("DISC I", "DISC II", "DISC III")
READINGS = 60
BETTER = 0.9


class FinerPads(NamedTuple):
    """Errors of circle-3 on pads of smaller elements.

    Parameters
    ----------
    pitch_cm : tuple of float
    centre_cm, radius_cm : ndarray, shape (pads,)
        Mean errors: distance of the centres, and radius.
    """

    pitch_cm: tuple[float, ...]
    centre_cm: Array
    radius_cm: Array


def finer(pad: Pad, n: int) -> Pad:
    """Return a pad of the same area with n by n elements in the place of one.

    Parameters
    ----------
    pad : Pad
    n : int

    Notes
    -----
    An element of a smaller area has the law of a smaller load: its grams are a share of the old
    ones. Bumps and voids keep their size in cm.
    """
    old, law = pad.geometry, pad.law
    geometry = Geometry(n * old.rows, n * old.columns, old.element_cm / n, old.gap_cm / n)
    share = 1.0 / n**2
    smaller = replace(
        law,
        load_g=law.load_g * share,
        load2_g=None if law.load2_g is None else law.load2_g * share,
        turn_on_g=law.turn_on_g * share,
        saturation_g=law.saturation_g * share,
    )
    return replace(pad, geometry=geometry, law=smaller)


def finer_pads(work: Work) -> FinerPads:
    """Return circle-3's errors on the thesis' discs, pad by pad.

    Parameters
    ----------
    work : Work
    """
    rows = []
    pitches = []
    for n in FINER:
        pad = finer(work.pad, n)
        frames = _frames(work, pad)
        errors = circle_errors(frames, [load("circle-3").runner(seed=work.seed)], DISCS)[0]
        off = errors.reshape(-1, 3)
        rows.append((np.hypot(off[:, 0], off[:, 1]).mean(), off[:, 2].mean()))
        pitches.append(pad.geometry.pitch_cm)
    centre, radius = np.array(rows).T
    return FinerPads(tuple(pitches), centre, radius)


def _frames(work: Work, pad: Pad) -> list[Any]:
    told = {key: value for key, value in asdict(pad).items() if key not in ("about", "learned")}
    settings = {"scene": "discs", "frames": min(READINGS, 3 * work.readings), "pad": told}
    return list(load("circle-1").with_source("simulate", **settings).frames(work.seed))


def _study(work: Work) -> Made:
    found = work.once("finer-pad", lambda: finer_pads(work))
    rows = list(
        zip(found.pitch_cm, map(float, found.centre_cm), map(float, found.radius_cm), strict=True)
    )
    return Made(
        findings=(better(found),),
        table=Table(("pitch_cm", "centre_error_cm", "radius_error_cm"), rows),
        figure=_figure(found),
    )


def better(found: FinerPads) -> Finding:
    """Return whether smaller elements give nearer circles.

    Parameters
    ----------
    found : FinerPads
    """
    words = "; ".join(
        f"{pitch:.2g} cm: centre {c:.2f}, radius {r:.2f} cm"
        for pitch, c, r in zip(found.pitch_cm, found.centre_cm, found.radius_cm, strict=True)
    )
    first = np.array([found.centre_cm[0], found.radius_cm[0]])
    last = np.array([found.centre_cm[-1], found.radius_cm[-1]])
    return Finding(
        "smaller elements give better results",
        f"mean errors of circle-3 by pitch, {words}",
        "a mean error, of centre or radius, above nine tenths of that on the thesis' elements",
        bool((last < BETTER * first).all()),
    )


def _figure(found: FinerPads) -> Figure:
    figure = new_figure(5.6, 3.8)
    axes = figure.subplots()
    axes.plot(found.pitch_cm, found.centre_cm, "o-", label="centre")
    axes.plot(found.pitch_cm, found.radius_cm, "o-", label="radius")
    axes.set(
        xlabel="pitch of the elements / cm",
        ylabel="mean error of circle-3 / cm",
        title="Pads of the same area with smaller elements",
    )
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    axes.legend()
    return figure


ITEMS = (
    Item(
        "finer-pad",
        "Smaller elements",
        "Errors of circle-3 on pads of the same area with two and three elements each way in the "
        "place of one, with bumps and voids of the same size.",
        _study,
        "The thesis has one pad; ours are simulated. The structuring element of circle-3 keeps its "
        "number of cells.",
        after="6.1.2",
    ),
)
