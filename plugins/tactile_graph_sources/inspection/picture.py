"""The picture of a recording: fullest frame, highest reading of each cell, load over time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tactile_graph.quantities import unit_of
from tactile_graph_sources.inspection.look import Looked, Sensor
from tactile_graph_sources.inspection.measure import stack_of_frames
from tactile_graph_sources.inspection.words import fullest

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARKS = {"dead": ("x", "white"), "stuck": ("o", "red"), "noisy": ("^", "orange")}


def save_picture(looked: Sequence[Looked], path: Path) -> None:
    """Write the picture of a recording that was looked into for each of its sensors, a row each.

    Raises
    ------
    UsageError
        If the file cannot be written.
    """
    from tactile_graph.draw.strip import figure_bytes, picture_format
    from tactile_graph.files import write_whole

    kind = picture_format(path)
    write_whole(path, figure_bytes(figure_of(looked), kind))


def figure_of(looked: Sequence[Looked]) -> Figure:
    """Return the picture as a figure."""
    from matplotlib.figure import Figure

    rows = [(one, sensor) for one in looked for sensor in one.sensors]
    n = len(rows)
    figure = Figure(figsize=(12.0, 3.9 * n + 0.4), layout="constrained")
    figure.suptitle(f"{looked[0].path.name}: {looked[0].format}", fontsize=10)
    axes = figure.subplots(n, 3, squeeze=False)
    for row, (one, sensor) in zip(axes, rows, strict=True):
        _frame(row[0], sensor, one.chosen or sensor.label)
        _peaks(row[1], sensor)
        _load(row[2], sensor)
    return figure


def _unit(sensor: Sensor) -> str:
    quantity = sensor.frames[0].image.quantity
    return unit_of(quantity)


def _frame(axes: Axes, sensor: Sensor, label: str) -> None:
    frame = fullest(sensor)
    _grid(axes, sensor, np.asarray(frame.image.filled(np.nan)))
    axes.set_title(f"{label} frame {frame.index}, the fullest".strip(), fontsize=9)


def _peaks(axes: Axes, sensor: Sensor) -> None:
    stack = stack_of_frames(sensor.frames)
    highest = np.where(np.isfinite(stack), stack, -np.inf).max(axis=0)
    highest[~np.isfinite(highest)] = np.nan
    _grid(axes, sensor, highest)
    axes.set_title(f"highest of {len(sensor.frames)} frames", fontsize=9)
    image = sensor.frames[0].image
    for name, (marker, colour) in _MARKS.items():
        cells = getattr(sensor.measured, name)
        if cells:
            rows, columns = np.array(cells).T
            axes.scatter(
                image.x_cm[columns],
                image.y_cm[rows],
                marker=marker,
                s=22,
                facecolors=colour if marker == "x" else "none",
                edgecolors=None if marker == "x" else colour,
                label=f"{name} ({len(cells)})",
            )
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7, loc="upper right", facecolor="0.4", labelcolor="white")


def _grid(axes: Axes, sensor: Sensor, values: NDArray[np.float64]) -> None:
    image = sensor.frames[0].image
    axes.set_facecolor("0.75")
    drawn = axes.imshow(values, extent=image.extent_cm, cmap="viridis", interpolation="nearest")
    axes.set_xlabel("x (cm)")
    axes.set_ylabel("y (cm)")
    bar = axes.figure.colorbar(drawn, ax=axes, shrink=0.85)
    bar.set_label(_unit(sensor))


def _load(axes: Axes, sensor: Sensor) -> None:
    stack = stack_of_frames(sensor.frames)
    total = np.nansum(stack, axis=(1, 2))
    times = [f.time_s for f in sensor.frames]
    timed = all(t is not None for t in times) and len(times) > 1
    at = np.array(times if timed else [f.index for f in sensor.frames], dtype=np.float64)
    axes.plot(at, total, "." if len(at) < 60 else "-", lw=1.0, color="C0", label="sum of the cells")
    gaps = [k for k, f in enumerate(sensor.frames) if f.gap]
    if gaps:
        axes.plot(at[gaps], total[gaps], "v", color="C3", label=f"after a gap ({len(gaps)})")
    axes.set_xlabel("time (s)" if timed else "frame")
    axes.set_ylabel(f"sum of the cells ({_unit(sensor)})")
    axes.set_title("load", fontsize=9)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
