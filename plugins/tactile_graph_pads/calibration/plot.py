"""Draw a calibration: measured points with error bars and the curve (figures 2.17 and 2.18)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tactile_graph.files import check_target, whole_file
from tactile_graph_pads.calibration.calibration import Calibration

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FORMATS = (".png", ".svg", ".pdf")


def new_figure(width_in: float = 7.5, height_in: float = 5.0) -> Figure:
    """Return an empty figure of its own, known to no window and no global state.

    Parameters
    ----------
    width_in, height_in : float
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width_in, height_in), layout="constrained", dpi=110)
    FigureCanvasAgg(figure)
    return figure


def check_picture(path: str | Path) -> Path:
    """Return where a picture is to go.

    Raises
    ------
    UsageError
        If its name's ending is no known format, or its folder is not there.
    """
    path = Path(path)
    check_target("--plot", path, FORMATS, told_by_name=True)
    return path


def draw_calibration(axes: Axes, calibration: Calibration) -> None:
    """Draw reading against load: curve, points, and error bars of one standard deviation.

    Parameters
    ----------
    axes : matplotlib Axes
    calibration : Calibration
    """
    load = np.array([p.load_g for p in calibration.points])
    read, sd, single = (
        np.array([getattr(p, name) for p in calibration.points])
        for name in ("reading", "sd", "sd_single")
    )
    rows, columns = calibration.provenance.group
    if single.any():
        axes.errorbar(load, read, single, fmt="none", ecolor="0.75", elinewidth=1.0, capsize=2.0,
                      label="±1 SD of single elements")  # fmt: skip
    axes.errorbar(load, read, sd, fmt="o", ms=4.0, color="C0", capsize=3.0,
                  label=f"mean, ±1 SD over groups of {rows}x{columns}")  # fmt: skip
    fine = np.linspace(0.0, calibration.up_to, 400)
    axes.plot(calibration.grams_of(fine).load_g, fine, color="C3", label=_fit_name(calibration))
    unit = calibration.units.reading
    axes.set(xlabel="load on an element / g", ylabel=f"reading / {unit}")
    axes.set_ylim(bottom=0.0)
    axes.set_xlim(left=0.0)
    axes.grid(alpha=0.3)
    axes.legend()


def _fit_name(calibration: Calibration) -> str:
    fit, quality = calibration.fit, calibration.quality
    name = {
        "polynomial": f"polynomial of order {len(getattr(fit, 'coefficients', ())) - 1}",
        "isotonic": "isotonic",
        "power": "power law",
    }[fit.kind]
    return f"{name}, rms {quality.rms_percent:.1f} % of load"


def save_calibration_plot(path: str | Path, calibration: Calibration) -> None:
    """Write the picture of a calibration.

    Parameters
    ----------
    path : str or Path
    calibration : Calibration
    """
    figure = new_figure()
    axes = figure.subplots()
    draw_calibration(axes, calibration)
    axes.set_title(calibration.about or "Calibration")
    save_figure(figure, check_picture(path))


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure in the format its name says, whole or not at all.

    Parameters
    ----------
    figure : matplotlib Figure
    path : Path
    """
    with whole_file(path) as file:
        figure.savefig(file, format=path.suffix.lower().lstrip("."))
