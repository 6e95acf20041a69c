"""Study ``weight-area``: what objects of several areas weigh, with and without decoupling (2.19)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Circle
from tactile_graph_pads.calibration import Calibration
from tactile_graph_pads.calibration_fit import calibrated
from tactile_graph_pads.calibration_points import points_of
from tactile_graph_pads.pad import Pad
from tactile_graph_pads.studies.bench import Bench
from tactile_graph_pads.studies.characteristic import STACK_CM, characteristic
from tactile_graph_pads.studies.study import Finding, Study, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
TABLE_2_2 = (
    ("Object 1", 1860.0, 6.9),
    ("Object 2", 1090.0, 6.1),
    ("Object 3", 675.0, 4.3),
    ("Object 4", 1280.0, 3.8),
    ("Object 5", 1000.0, 2.5),
)
"""Name, weight in grams, radius in cm."""
PRESSURES_G_CM2 = np.array([15.0, 25.0, 40.0, 60.0])
"""Own weight and what is stacked on top, over the footprint: the text's way to compare."""
N_PLACEMENTS = 24
CALIBRATED_G = np.array([20, 30, 40, 60, 80, 120, 160, 240, 320, 480, 640, 960, 1400, 2000.0])
N_GROUPS = 30
"""Many, so that the calibration's own scatter does not hide what the area does."""


class Weighings(NamedTuple):
    """Weights found for objects of several areas under the same pressures.

    Parameters
    ----------
    names : tuple of str
    area_cm2 : ndarray, shape (k,)
    pressure_g_cm2 : ndarray, shape (p,)
    weight_g : ndarray, shape (k, p)
        True, stacked weights included.
    coupled_g, decoupled_g : ndarray, shape (k, p, n)
        Found in each of n placements, without and with the crosstalk taken out.
    """

    names: tuple[str, ...]
    area_cm2: Array
    pressure_g_cm2: Array
    weight_g: Array
    coupled_g: Array
    decoupled_g: Array

    def error_percent(self, decoupled: bool) -> Array:
        """Return the mean error of each object under each pressure, shape (k, p).

        Parameters
        ----------
        decoupled : bool
        """
        found = self.decoupled_g if decoupled else self.coupled_g
        return np.asarray(100.0 * (found.mean(axis=2) / self.weight_g - 1.0))

    def growth(self, decoupled: bool) -> float:
        """Return by how many percent of weight the size of the error grows over 100 cm^2.

        Parameters
        ----------
        decoupled : bool
        """
        size = abs(self.error_percent(decoupled)).mean(axis=1)
        return float(100.0 * np.polyfit(self.area_cm2, size, 1)[0])


def weight_area(
    pad: Pad, rng: np.random.Generator, n_placements: int = N_PLACEMENTS
) -> Weighings:
    """Return what the objects of table 2.2 seem to weigh with more and more stacked on top.

    Parameters
    ----------
    pad : Pad
    rng : numpy.random.Generator
    n_placements : int
        Each object is put down so often, at random places.

    Notes
    -----
    Both ways are calibrated on groups of four elements of the same pad (section 2.4.2): one in
    volts as the thesis does, one in the conductance behind the decoupled frame. A weight is the
    sum of the grams over all elements. The plate under a stack keeps the centre of pressure
    within a millimetre or two of the middle.
    """
    volt, siemens = _curves(pad, rng)
    bench = Bench(pad, rng)
    radius = np.array([r for _, _, r in TABLE_2_2])
    weight = np.pi * radius[:, None] ** 2 * PRESSURES_G_CM2
    shape = (*weight.shape, n_placements)
    coupled, decoupled = np.empty(shape), np.empty(shape)
    for k, p, n in np.ndindex(shape):
        read = _read(bench, float(radius[k]), float(weight[k, p]))
        coupled[k, p, n] = volt.grams_of(np.minimum(read, volt.up_to)).load_g.sum()
        behind = bench.siemens(read)[0]
        decoupled[k, p, n] = siemens.grams_of(np.minimum(behind, siemens.up_to)).load_g.sum()
    names = tuple(f"{name}, {r:g} cm" for name, _, r in TABLE_2_2)
    return Weighings(names, np.pi * radius**2, PRESSURES_G_CM2, weight, coupled, decoupled)


def _curves(pad: Pad, rng: np.random.Generator) -> tuple[Calibration, Calibration]:
    """Return isotonic calibrations of volts and of decoupled conductance."""
    found = characteristic(pad, rng, CALIBRATED_G, N_GROUPS)
    return (
        calibrated(points_of(found.observations("volt")), "isotonic", "volt"),
        calibrated(points_of(found.observations("siemens")), "isotonic", "siemens"),
    )


def _read(bench: Bench, radius_cm: float, weight_g: float) -> Array:
    """Return one reading of a disc put down anew, fully on the pad."""
    width, height = bench.pad.geometry.size_cm
    x, y = (float(bench.rng.uniform(radius_cm, side - radius_cm)) for side in (width, height))
    dx, dy = bench.rng.normal(0.0, STACK_CM, 2)
    disc = Circle(x, y, radius_cm)
    return bench.volts(bench.load_g(disc, weight_g, bench.gains(), (float(dx), float(dy))))


def _table(found: Weighings) -> Table:
    columns = ("object", "area_cm2", "pressure_g_cm2", "weight_g", "coupled_g", "coupled_error_%",
               "decoupled_g", "decoupled_error_%")  # fmt: skip
    off, off_decoupled = found.error_percent(False), found.error_percent(True)
    rows = [
        (
            found.names[k], float(found.area_cm2[k]), float(found.pressure_g_cm2[p]),
            float(found.weight_g[k, p]), float(found.coupled_g[k, p].mean()), float(off[k, p]),
            float(found.decoupled_g[k, p].mean()), float(off_decoupled[k, p]),
        )
        for k, p in np.ndindex(*found.weight_g.shape)
    ]  # fmt: skip
    return Table(columns, rows)


def _findings(found: Weighings) -> list[Finding]:
    coupled, decoupled = (
        abs(found.error_percent(way)).mean(axis=1) for way in (False, True)
    )
    small, large = int(found.area_cm2.argmin()), int(found.area_cm2.argmax())
    growth = [found.growth(way) for way in (False, True)]
    return [
        Finding(
            "at the same load per element, smaller objects weigh more nearly right than larger "
            "ones (figure 2.19)",
            f"without decoupling the mean error is {coupled[small]:.0f} % for the smallest and "
            f"{coupled[large]:.0f} % for the largest, growing by {growth[0]:.0f} % of weight "
            "for each 100 cm²",
            bool(growth[0] > 10.0 and coupled[small] < coupled[large]),
        ),
        Finding(
            "the cause is the electrical coupling",
            f"with decoupling {decoupled[small]:.0f} % for the smallest and "
            f"{decoupled[large]:.0f} % for the largest, growing by {growth[1]:.1f} % of weight "
            "for each 100 cm²",
            bool(growth[1] < 0.25 * growth[0] and decoupled.max() < 0.5 * coupled[large]),
        ),
    ]


def _plot(figure: Figure, found: Weighings) -> None:
    both = figure.subplots(1, 2, sharey=True, sharex=True)
    top = 1.05 * float(found.weight_g.max())
    for axes, values, title in (
        (both[0], found.coupled_g, "without decoupling"),
        (both[1], found.decoupled_g, "with decoupling"),
    ):
        axes.plot([0.0, top], [0.0, top], color="0.6", lw=1.0)
        for k, name in enumerate(found.names):
            axes.errorbar(found.weight_g[k], values[k].mean(axis=1), values[k].std(axis=1),
                          marker="o", ms=3.5, capsize=2.0, label=name)  # fmt: skip
        axes.set(title=title, xlabel="weight / g")
        axes.grid(alpha=0.3)
    both[0].set_ylabel("weight found / g")
    both[0].legend()


WEIGHT_AREA = Study(
    "weight-area",
    "figure 2.19",
    "the objects of table 2.2 with weights stacked on them, with and without decoupling",
    weight_area,
    _table,
    _findings,
    _plot,
)
