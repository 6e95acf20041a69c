"""Figure 2.18: the calibration curve of an element, three ways."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.calibration import Calibration
from tactile_graph_pads.calibration.fit import FitKind, calibrated, fitted_g
from tactile_graph_pads.calibration.plot import draw_calibration, new_figure
from tactile_graph_pads.calibration.points import points_of
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.bench import ON_ONE_PAD
from tactile_graph_thesis.measure.groups_of_four import GroupReadings, group_readings
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


class Curves(NamedTuple):
    """Calibrations of one pad from the same readings.

    Parameters
    ----------
    load_g, reading_v : ndarray, shape (w,)
        Known loads on an element, and the mean of all groups.
    fits : tuple of str
    fitted_g : ndarray, shape (3, w)
        What each fit makes of those readings.
    true_v : ndarray, shape (w,)
        What an even pad reads with the same load on all four of a group.
    calibrations : tuple of Calibration
    """

    load_g: Array
    reading_v: Array
    fits: tuple[str, ...]
    fitted_g: Array
    true_v: Array
    calibrations: tuple[Calibration, ...]

    @property
    def off_percent(self) -> Array:
        """How far each fit is from the known loads, shape (3, w)."""
        return 100.0 * (self.fitted_g / self.load_g - 1.0)


_KINDS: tuple[FitKind, ...] = ("polynomial", "isotonic", "power")


def curves(pad: Pad, readings: GroupReadings) -> Curves:
    """Return three calibrations from groups of four elements.

    Parameters
    ----------
    pad : Pad
    readings : GroupReadings
        Made on it.
    """
    points = points_of(readings.observations())
    made = tuple(calibrated(points, kind) for kind in _KINDS)
    load, read = (np.array([getattr(p, n) for p in points]) for n in ("load_g", "reading"))
    fitted = [fitted_g(c.fit, points) for c in made]
    return Curves(load, read, _KINDS, np.array(fitted), _even_volts(pad, load), made)


def _even_volts(pad: Pad, load_g: Array) -> Array:
    bears = np.zeros(pad.geometry.shape)
    volts = np.empty(len(load_g))
    for k, grams in enumerate(load_g):
        bears[:2, :2] = grams
        volts[k] = pad.forward(bears)[:2, :2].mean()
    return volts


def _table(found: Curves) -> Table:
    names = [f"{fit}: {what}" for fit in found.fits for what in ("load_g", "off_%")]
    columns = ("load_g", "reading_V", "even pad_V", *names)
    pairs = np.stack([found.fitted_g, found.off_percent], axis=1).reshape(-1, len(found.load_g))
    values = np.column_stack([found.load_g, found.reading_v, found.true_v, pairs.T])
    return Table(columns, [tuple(map(float, row)) for row in values])


def _findings(found: Curves) -> tuple[Finding, ...]:
    words, worst = [], {}
    for fit, made in zip(found.fits, found.calibrations, strict=True):
        q = made.quality
        words.append(f"{fit} {q.rms_percent:.1f} % rms, {q.largest_percent:.0f} % at most")
        worst[fit] = q.rms_percent
    top = found.reading_v[-1]
    return (
        Finding(
            "a fifth-order polynomial is a usable, smooth calibration curve (figure 2.18)",
            "off in load: " + "; ".join(words),
            "an error of a fifth of the load or more, rms",
            worst["polynomial"] < 20.0,
        ),
        Finding(
            "(not in the thesis) a power law does not fit volts: the divider saturates",
            f"{worst['power'] / worst['polynomial']:.1f} times the polynomial's error",
            "an error no larger than the polynomial's",
            worst["power"] > worst["polynomial"],
        ),
        Finding(
            "(not in the thesis) two of the four share a column and so half the supply, beyond "
            "which a curve taken this way knows nothing",
            f"reads up to {top:.2f} V at {found.load_g[-1]:.0f} g an element",
            "a reading of more than 2.6 V, half the supply and a tenth of a volt",
            bool(top < 2.6),
        ),
    )


def _figure(found: Curves) -> Figure:
    figure = new_figure()
    axes = figure.subplots()
    draw_calibration(axes, found.calibrations[0])
    others = list(zip(found.fits, found.calibrations, strict=True))[1:]
    for (fit, made), style in zip(others, ("--", ":"), strict=True):
        fine = np.linspace(0.0, made.up_to, 300)
        name = f"{fit}, rms {made.quality.rms_percent:.1f} % of load"
        axes.plot(made.grams_of(fine).load_g, fine, style, label=name)
    axes.plot(found.load_g, found.true_v, "k-", lw=0.8, alpha=0.6, label="an even pad")
    axes.set_xlim(0.0, 1.1 * found.load_g[-1])
    axes.set_title("Calibration curve of an element")
    axes.legend(loc="lower right")
    return figure


def _figure_2_18(work: Work) -> Made:
    found = curves(work.pad, work.on_pad(group_readings))
    return Made(findings=_findings(found), table=_table(found), figure=_figure(found))


ITEMS = (
    Item(
        "figure-2.18",
        "The calibration curve",
        "A fifth-order polynomial through the group means, and two other curves.",
        _figure_2_18,
        ON_ONE_PAD,
        study="curve",
    ),
)
