"""The level above the noise of a whole recording, one for all of its frames."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph.steps import Report
from tactile_graph.steps.settings import spelled, validate_settings
from tactile_graph.wires import Frame, Image
from tactile_graph_filters.thresholds.noise_level import (
    OF_PEAK,
    is_of_peak,
    level_above,
    lower_readings,
)

TOGETHER = 256
"""Cells in which noise that is cut off shows: of smaller pads, frames are looked at together."""
MOST_APART = 3.0
"""Times what a frame's largest reading lies above its lower quartile, by which noise may spread."""
MANY, MORE = 0.8, 2.0
"""Quantile of the spread of frames in which noise is cut off, and times the median, from which on
it is that of the recording."""

Readings = tuple[float, float, float]
Values = NDArray[np.float64]


class RecordingLevel(NamedTuple):
    """A level, in the unit of ``quantity``, and of what it was made."""

    level: float
    quantity: str
    told: str


def recording_level(recording: Path | Mapping[str, Any]) -> RecordingLevel:
    """Return the level from which on cells stand out of a recording's noise.

    Parameters
    ----------
    recording : Path or mapping
        The file, or the settings of the source step that reads it.

    Returns
    -------
    RecordingLevel
        Base and noise are the medians of what `noise_level` finds in each frame, the peak is the
        highest of all: an empty frame, or one with a light touch, has the level of all others.
        Of frames in which noise is cut off and that differ in it, those with much of it count.
        Where frames of fewer than 256 cells show no noise, several are looked at as one.

    Raises
    ------
    UsageError
        If no plugin reads recordings, a setting is wrong, or the frames are of several quantities
        or without a valid cell.
    DataError
        If the file is no recording.
    """
    found, cut_off, quantities = [], [], set()
    small: list[tuple[Image, Readings]] = []
    together: list[Readings] = []
    for frame in _frames(recording):
        image = frame.image
        readings = lower_readings(image)
        quantities.add(image.quantity)
        if readings is None:
            continue
        found.append(readings)
        cut_off.append(bool(readings[1] <= image.filled(np.inf).min()))
        if image.values.size < TOGETHER:
            if small and small[0][0].columns != image.columns:
                small = []
            small.append((image, readings))
            if sum(its.values.size for its, _ in small) >= TOGETHER:
                if of_all := _of_all(small):
                    together.append(of_all)
                small = []
    name = str(recording if isinstance(recording, Path) else dict(recording))
    if not found or len(quantities) != 1:
        what = "frames of several quantities" if found else "no frame with a valid cell"
        raise UsageError(f"noise_of {name}: it holds {what}, so one level cannot be told")
    low, base, peaks = np.array(found).T
    spread = float(np.median(base - low))
    if spread == 0.0 and together:
        lowest, middle, _ = np.array(together).T
        spread = float(np.median(middle - lowest))
    spread = max(spread, _hum(base - low, np.array(cut_off), spread))
    level = level_above(spread, float(np.median(base)), float(peaks.max()))
    what = "noise" if spread > 0.0 else "zero, as no noise shows,"
    told = f"the {what} of {name}, {len(found)} frames"
    if spread > 0.0 and is_of_peak(level, float(np.median(base)), float(peaks.max())):
        told += OF_PEAK
    return RecordingLevel(level, quantities.pop(), told)


def _hum(spreads: Values, cut_off: NDArray[np.bool_], usual: float) -> float:
    """Return the spread that many frames reach whose noise is cut off; 0 if it is about the usual.

    Hum leaves some frames all but at rest, in which nothing tells how far it reaches.
    """
    if cut_off.mean() < 0.5:
        return 0.0
    most = float(np.quantile(spreads[cut_off], MANY))
    return most if most > MORE * usual else 0.0


def _of_all(frames: list[tuple[Image, Readings]]) -> Readings | None:
    """Return the readings of several frames as one; None where they differ in more than noise.

    Frames that are pressed all over, or drift, lie farther apart than the cells of each do.
    """
    of_all = lower_readings(_one_of([image for image, _ in frames]))
    scatter = sum(peak - base for _, (_, base, peak) in frames) / len(frames)
    return of_all if of_all and of_all[1] - of_all[0] <= MOST_APART * scatter else None


def _one_of(images: list[Image]) -> Image:
    """Return frames of as many columns one below the other."""
    values = np.concatenate([its.values for its in images])
    valid = None
    if any(its.valid is not None for its in images):
        every = (np.ones(its.shape, np.bool_) if its.valid is None else its.valid for its in images)
        valid = np.concatenate([*every])
    return Image(values, valid=valid)


def _frames(recording: Path | Mapping[str, Any]) -> Iterator[Frame]:
    registry = installed()
    reader = registry.reader()
    if reader is None:
        raise UsageError("noise_of: no plugin that is installed reads recordings")
    path = str(registry.offer("readers", reader).target)
    given = {path: str(recording)} if isinstance(recording, Path) else dict(recording)
    signature = registry.step(reader)
    values, troubles = validate_settings(signature, given)
    for place, message in troubles:
        raise UsageError(f"noise_of, {spelled(place)}: {message}".replace(", : ", ": "))
    injected = {signature.report: Report()} if signature.report else {}
    frames: Iterator[Frame] = signature.target(**signature.arguments(values), **injected)
    return frames
