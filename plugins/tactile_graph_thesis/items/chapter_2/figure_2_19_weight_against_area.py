"""Figure 2.19: what objects of several areas weigh, with and without decoupling."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import UsageError
from tactile_graph.wires import Circle
from tactile_graph_pads.calibration.calibration import Calibration
from tactile_graph_pads.calibration.fit import calibrated
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.calibration.points import points_of
from tactile_graph_pads.pad import Pad
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.bench import ON_ONE_PAD, Bench
from tactile_graph_thesis.measure.groups_of_four import STACK_CM, group_readings
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
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
    sums_g : ndarray, shape (k, p, n)
        With the crosstalk taken out, by a calibration of the groups' sums.
    """

    names: tuple[str, ...]
    area_cm2: Array
    pressure_g_cm2: Array
    weight_g: Array
    coupled_g: Array
    decoupled_g: Array
    sums_g: Array

    def error_percent(self, found_g: Array) -> Array:
        """Return the mean error of each object under each pressure, shape (k, p).

        Parameters
        ----------
        found_g : ndarray, shape (k, p, n)
        """
        return np.asarray(100.0 * (found_g.mean(axis=2) / self.weight_g - 1.0))

    def growth(self, found_g: Array) -> float:
        """Return by how many percent of weight the size of the error grows over 100 cm^2.

        Parameters
        ----------
        found_g : ndarray, shape (k, p, n)
        """
        size = abs(self.error_percent(found_g)).mean(axis=1)
        return float(100.0 * np.polyfit(self.area_cm2, size, 1)[0])


def weight_area(pad: Pad, rng: np.random.Generator, n_placements: int = N_PLACEMENTS) -> Weighings:
    """Return what the objects of table 2.2 seem to weigh with more and more stacked on top.

    Parameters
    ----------
    pad : Pad
    rng : numpy.random.Generator
    n_placements : int
        Each object is put down so often, at random places.

    Notes
    -----
    All ways are calibrated on groups of four elements of the same pad (section 2.4.2): one in
    volts as the thesis does, two in the conductance behind the decoupled frame. A weight is the
    sum of the grams over all elements. The plate under a stack keeps the centre of pressure
    within a millimetre or two of the middle.
    """
    volt, siemens, sums = curves(pad, rng)
    bench = Bench(pad, rng)
    radii = table_2_2_radii_cm()
    radius = np.array(list(radii.values()))
    weight = np.pi * radius[:, None] ** 2 * PRESSURES_G_CM2
    shape = (*weight.shape, n_placements)
    coupled, decoupled, by_sums = (np.empty(shape) for _ in range(3))
    for at in np.ndindex(shape):
        read = put_down(bench, float(radius[at[0]]), float(weight[at[:2]]))
        behind = bench.siemens(read)[0]
        coupled[at] = weighed_g(volt, read)
        decoupled[at], by_sums[at] = weighed_g(siemens, behind), weighed_g(sums, behind)
    names = tuple(f"{name}, {r:g} cm" for name, r in radii.items())
    return Weighings(names, np.pi * radius**2, PRESSURES_G_CM2, weight, coupled, decoupled, by_sums)


def table_2_2_radii_cm() -> dict[str, float]:
    """Return the radius of each object of table 2.2, by name."""
    return {name: float(radius) for name, (_, radius) in numbers("table-2.2")["rows"].items()}


def curves(pad: Pad, rng: np.random.Generator) -> tuple[Calibration, Calibration, Calibration]:
    """Return calibrations of volts, and twice of decoupled conductance: by means, by sums."""
    found = group_readings(pad, rng, CALIBRATED_G, N_GROUPS)
    volt, siemens = (found.observations(q) for q in ("volt", "siemens"))
    return (
        calibrated(points_of(volt), "isotonic", "volt"),
        calibrated(points_of(siemens), "isotonic", "siemens"),
        calibrated(points_of(siemens), "sums", "siemens", observations=siemens),
    )


def weighed_g(curve: Calibration, readings: Array) -> float:
    """Return the weight on all elements; a reading beyond the curve counts as its end."""
    return float(curve.grams_of(np.minimum(readings, curve.up_to)).load_g.sum())


def put_down(bench: Bench, radius_cm: float, weight_g: float) -> Array:
    """Return one reading of a disc put down anew, fully on the pad.

    Raises
    ------
    UsageError
        If it does not fit on the pad.
    """
    width, height = bench.pad.geometry.size_cm
    if min(width, height) - radius_cm < radius_cm:
        disc_of = f"a disc of {radius_cm:g} cm radius"
        raise UsageError(f"{disc_of} does not fit on the pad of {width:g} by {height:g} cm")
    x, y = (float(bench.rng.uniform(radius_cm, side - radius_cm)) for side in (width, height))
    dx, dy = bench.rng.normal(0.0, STACK_CM, 2)
    disc = Circle(x, y, radius_cm)
    return bench.volts(bench.load_g(disc, weight_g, bench.gains(), (float(dx), float(dy))))


def _ways(found: Weighings) -> dict[str, Array]:
    return {"coupled": found.coupled_g, "decoupled": found.decoupled_g, "by sums": found.sums_g}


def _table(found: Weighings) -> Table:
    ways = _ways(found)
    columns = ("object", "area_cm2", "g_per_cm2", "weight_g",
               *(f"{way}{unit}" for way in ways for unit in ("_g", "_error_%")))  # fmt: skip
    means = [(g.mean(axis=2), found.error_percent(g)) for g in ways.values()]
    rows = []
    for k, p in np.ndindex(*found.weight_g.shape):
        told = (found.area_cm2[k], found.pressure_g_cm2[p], found.weight_g[k, p])
        values = [float(v[k, p]) for pair in means for v in pair]
        rows.append((found.names[k], *map(float, told), *values))
    return Table(columns, rows)


def _findings(found: Weighings) -> tuple[Finding, ...]:
    size = {way: abs(found.error_percent(g)).mean(axis=1) for way, g in _ways(found).items()}
    growth = {way: found.growth(g) for way, g in _ways(found).items()}
    small, large = int(found.area_cm2.argmin()), int(found.area_cm2.argmax())
    words = {
        way: f"mean error {size[way][small]:.0f} % for the smallest, {size[way][large]:.0f} % for "
        f"the largest, growing by {growth[way]:.1f} % of weight for each 100 cm²"
        for way in size
    }
    return (
        Finding(
            "at the same load per element, smaller objects weigh more nearly right than larger "
            "ones (figure 2.19)",
            f"without decoupling: {words['coupled']}",
            "a loss that grows by less than ten points from the smallest object to the largest",
            bool(growth["coupled"] > 10.0 and size["coupled"][small] < size["coupled"][large]),
        ),
        Finding(
            "the cause is the electrical coupling",
            f"with decoupling: {words['decoupled']}",
            "a decoupled loss that still grows by a tenth as much, or is half as large",
            bool(
                abs(growth["decoupled"]) < 0.1 * growth["coupled"]
                and size["decoupled"][large] < 0.5 * size["coupled"][large]
            ),
        ),
        Finding(
            "(not in the thesis) what is left comes of calibrating uneven groups by their mean "
            "reading, not of area; a calibration of their sums takes it off too",
            f"with decoupling, by sums: {words['by sums']}",
            "five percent or more of the weight left amiss",
            bool(size["by sums"].max() < 5.0),
        ),
    )


def _figure(found: Weighings) -> Figure:
    figure = new_figure(12.0, 5.0)
    parts = figure.subplots(1, 3)
    top = 1.05 * float(found.weight_g.max())
    ways = _ways(found)
    for axes, way, title in (
        (parts[0], "coupled", "without decoupling"),
        (parts[1], "decoupled", "with decoupling"),
    ):
        axes.plot([0.0, top], [0.0, top], color="0.6", lw=1.0)
        for k, name in enumerate(found.names):
            values = ways[way][k]
            axes.errorbar(found.weight_g[k], values.mean(axis=1), values.std(axis=1),
                          marker="o", ms=3.5, capsize=2.0, label=name)  # fmt: skip
        axes.set(title=title, xlabel="weight / g", ylabel="weight found / g", ylim=(0.0, top))
        axes.grid(alpha=0.3)
    parts[0].legend()
    _plot_errors(parts[2], found)
    return figure


def _plot_errors(axes: Axes, found: Weighings) -> None:
    for (way, values), style in zip(_ways(found).items(), ("-", "--", ":"), strict=True):
        axes.plot([], [], f"k{style}", label=way)
        for p, percent in enumerate(found.error_percent(values).T):
            label = f"{found.pressure_g_cm2[p]:g} g/cm²" if way == "coupled" else None
            axes.plot(found.area_cm2, percent, style, color=f"C{p}", marker=".", label=label)
    axes.set(title="error against area", xlabel="area / cm²", ylabel="mean error of weight / %")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small", loc="lower left")


def _figure_2_19(work: Work) -> Made:
    found = work.on_pad(weight_area)
    return Made(findings=_findings(found), table=_table(found), figure=_figure(found))


ITEMS = (
    Item(
        "figure-2.19",
        "Weight against area",
        "Weights found for the discs of table 2.2 under rising pressure.",
        _figure_2_19,
        ON_ONE_PAD + " The order by area is the coupling's: it vanishes where the circuit is "
        "inverted, which the thesis did not do.",
        study="weight-area",
    ),
)
