"""CapContact frames: a capacitive image beside the mask of what truly touched the glass."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Ellipse, Frame, TrueObject
from tactile_graph_sources.readers.reading import Reading

SHAPE = (41, 72)
PITCH_CM = (0.479, 0.476)
DEVICE = "the CapContact panel"
CONTACT = 0


def frames(reading: Reading, cap: NDArray[Any], ftir: NDArray[Any]) -> Iterator[Frame]:
    """Yield the one frame of such an archive, the mask's contacts as its truth.

    Parameters
    ----------
    reading : Reading
    cap : ndarray, shape (41, 72)
        Capacitive image, in the converter's own counts.
    ftir : ndarray, shape (328, 576)
        0 where the finger touched, 255 elsewhere, a whole number of times finer than ``cap``.

    Raises
    ------
    DataError
        If the two do not fit each other.

    Notes
    -----
    Centre c of a mask cell lies at ``(c + 0.5)/8 - 0.5`` in indices of ``cap``, so both grids
    begin at the same corner. Streli and Holz, CapContact, 2021, doi:10.1145/3411764.3445621.
    """
    where = str(reading.path)
    if cap.ndim != 2 or cap.dtype.kind not in "iuf" or 0 in cap.shape:
        raise DataError(where, f"'cap' has shape {cap.shape} and type {cap.dtype}, not a matrix")
    finer = ftir.shape[0] // cap.shape[0] if ftir.ndim == 2 else 0
    if finer < 1 or ftir.shape != (cap.shape[0] * finer, cap.shape[1] * finer):
        raise DataError(where, f"'ftir' {ftir.shape} is no finer grid of 'cap' {cap.shape}")
    reading.told.agree(where, *cap.shape)
    reading.report.expect(1)
    own = reading.published(PITCH_CM, DEVICE) if cap.shape == SHAPE else None
    pitch = reading.told.pitch_cm or own or (1.0, 1.0)
    x0, y0 = reading.told.origin_cm or (0.0, 0.0)
    found = contacts_of(ftir == CONTACT, (pitch[0] / finer, pitch[1] / finer), (x0, y0))
    reading.recognised("arrays 'cap' and 'ftir', the second a whole number of times finer")
    yield reading.frame(cap, pitch_cm=own, truth=tuple(TrueObject(e) for e in found))


def contacts_of(
    mask: NDArray[np.bool_], pitch_cm: tuple[float, float], origin_cm: tuple[float, float]
) -> list[Ellipse]:
    """Return an ellipse for each contact: its centre, area, direction and ratio of axes.

    Parameters
    ----------
    mask : ndarray of bool, shape (rows, columns)
        True where something touched. Cells that meet at a corner belong together.
    pitch_cm, origin_cm : (float, float)
        Of the mask's cells.

    Returns
    -------
    list of Ellipse
        The ellipse of the same second moments, scaled to the area of the contact's cells.
    """
    from scipy import ndimage

    labels, n = ndimage.label(mask, structure=np.ones((3, 3)))
    ellipses = []
    for k in range(1, n + 1):
        row, column = np.nonzero(labels == k)
        x = origin_cm[0] + (column + 0.5) * pitch_cm[0]
        y = origin_cm[1] + (row + 0.5) * pitch_cm[1]
        ellipses.append(_ellipse(np.asarray(x), np.asarray(y), pitch_cm))
    return ellipses


def _ellipse(x: NDArray[Any], y: NDArray[Any], pitch_cm: tuple[float, float]) -> Ellipse:
    cx, cy = float(x.mean()), float(y.mean())
    # A cell spreads over its own width: without that a line of cells would have no breadth.
    xx = float(((x - cx) ** 2).mean()) + pitch_cm[0] ** 2 / 12.0
    yy = float(((y - cy) ** 2).mean()) + pitch_cm[1] ** 2 / 12.0
    xy = float(((x - cx) * (y - cy)).mean())
    angle = -0.5 * math.atan2(2.0 * xy, xx - yy)  # y runs down, the angle is as seen
    half, root = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
    ratio = math.sqrt((half - root) / (half + root))
    area = len(x) * pitch_cm[0] * pitch_cm[1]
    major = math.sqrt(area / (math.pi * ratio))
    return Ellipse(cx, cy, major, major * ratio, angle)
