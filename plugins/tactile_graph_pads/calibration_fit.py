"""Fit a calibration curve: fifth-order polynomial (the thesis), isotonic lines, or a power law."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_pads.calibration import (
    FORMAT,
    UNITS,
    Calibration,
    Isotonic,
    Point,
    Polynomial,
    PowerLaw,
    Provenance,
    Quality,
    Units,
)

Array = NDArray[np.float64]
FitKind = Literal["polynomial", "isotonic", "power"]
FITS: tuple[str, ...] = get_args(FitKind)
LEAST_LOADS = {"isotonic": 3, "power": 3}


def calibrated(
    points: Sequence[Point],
    kind: FitKind = "polynomial",
    reading: Literal["volt", "siemens", "counts", "raw"] = "volt",
    order: int = 5,
    where: str = "calibration",
    about: str = "",
    provenance: Provenance | None = None,
) -> Calibration:
    """Return the calibration of one kind that comes nearest to the points.

    Parameters
    ----------
    points : sequence of Point
        By rising load, as `calibration_points.points_of` makes them.
    kind : "polynomial", "isotonic" or "power"
    reading : str
        What was read.
    order : int
        Of the polynomial.
    where : str
        What errors name.
    about : str
    provenance : Provenance, optional

    Raises
    ------
    DataError
        If there are too few loads for this kind, or the fit is not monotone.

    Notes
    -----
    Minimised is the sum of squares of the relative error of load for the polynomial (which goes
    through (0, 0)), that of ln load for the power law, and that of the reading under the
    condition that it does not fall for the isotonic lines.
    """
    needed = order + 1 if kind == "polynomial" else LEAST_LOADS[kind]
    if len(points) < needed:
        what = f"a polynomial of order {order}" if kind == "polynomial" else f"the {kind} fit"
        raise DataError(
            where, f"too few loads: {what} needs {needed} different ones, got {len(points)}"
        )
    load = np.array([p.load_g for p in points])
    read = np.array([p.reading for p in points])
    fit: Polynomial | Isotonic | PowerLaw
    if kind == "polynomial":
        fit = fit_polynomial(read, load, order, where)
    elif kind == "isotonic":
        fit = fit_isotonic(read, load, np.array([float(p.placements) for p in points]), where)
    else:
        fit = fit_power(read, load, where)
    top = fit.points[-1][0] if isinstance(fit, Isotonic) else float(read.max())
    return Calibration(
        format=FORMAT,
        reading=reading,
        fit=fit,
        from_reading=float(read.min()),
        up_to=top,
        quality=quality_of(fit, read, load, top),
        points=tuple(points),
        about=about,
        units=Units(UNITS[reading]),
        provenance=provenance or Provenance(),
    )


def fit_polynomial(
    reading: Array, load_g: Array, order: int, where: str = "calibration"
) -> Polynomial:
    """Return grams as a polynomial of the reading, through (0, 0).

    Parameters
    ----------
    reading, load_g : ndarray, shape (n,)
    order : int
    where : str

    Raises
    ------
    DataError
        If it falls somewhere between 0 and the largest reading.
    """
    top = float(reading.max())
    powers = (reading[:, None] / top) ** np.arange(1, order + 1)
    scaled = np.linalg.lstsq(powers / load_g[:, None], np.ones(len(load_g)), rcond=None)[0]
    fine = np.linspace(0.0, 1.0, 2001)
    slope = np.polyval((scaled * np.arange(1, order + 1))[::-1], fine)
    falling = fine[slope < 0.0]
    if falling.size:
        raise DataError(
            where,
            f"not monotone: the polynomial of order {order} falls between readings "
            f"{falling[0] * top:.4g} and {falling[-1] * top:.4g}, so one reading there would mean "
            "several loads; take fewer orders, other loads, or the isotonic fit",
        )
    coefficients = scaled / top ** np.arange(1.0, order + 1)
    return Polynomial("polynomial", (0.0, *map(float, coefficients)))


def fit_isotonic(
    reading: Array, load_g: Array, weights: Array, where: str = "calibration"
) -> Isotonic:
    """Return the straight lines through the readings nearest to these that do not fall.

    Parameters
    ----------
    reading, load_g, weights : ndarray, shape (n,)
        By rising load.
    where : str

    Raises
    ------
    DataError
        If fewer than two levels of reading are left.

    Notes
    -----
    Pool adjacent violators (Ayer et al. 1955, 10.1214/aoms/1177728423); loads that share a
    pooled reading are averaged.
    """
    blocks: list[tuple[float, float, float]] = []  # reading, load, weight
    for block in zip(reading.tolist(), load_g.tolist(), weights.tolist(), strict=True):
        blocks.append(block)
        while len(blocks) > 1 and blocks[-1][0] <= blocks[-2][0]:
            (r1, g1, w1), (r0, g0, w0) = blocks.pop(), blocks.pop()
            w = w0 + w1
            blocks.append(((r0 * w0 + r1 * w1) / w, (g0 * w0 + g1 * w1) / w, w))
    if len(blocks) < 2:
        raise DataError(where, "not monotone: the readings do not rise with the loads at all")
    return Isotonic("isotonic", ((0.0, 0.0), *((r, g) for r, g, _ in blocks)))


def fit_power(reading: Array, load_g: Array, where: str = "calibration") -> PowerLaw:
    """Return grams as a power of the reading.

    Parameters
    ----------
    reading, load_g : ndarray, shape (n,)
    where : str

    Raises
    ------
    DataError
        If the power is not above 0.
    """
    unit = 1e-6 if reading.max() < 1e-2 else 1.0
    exponent, log_scale = np.polyfit(np.log(reading / unit), np.log(load_g), 1)
    if exponent <= 0.0:
        raise DataError(where, f"not monotone: the loads go with reading^{exponent:.3g}, falling")
    return PowerLaw("power", float(np.exp(log_scale)), float(exponent), unit)


def quality_of(
    fit: Polynomial | Isotonic | PowerLaw, reading: Array, load_g: Array, up_to: float
) -> Quality:
    """Return how far a fit is from its points, in load.

    Parameters
    ----------
    fit : Polynomial, Isotonic or PowerLaw
    reading, load_g : ndarray, shape (n,)
    up_to : float
        Readings above it count as this.
    """
    off = fit.grams(np.minimum(reading, up_to)) - load_g
    share = 100.0 * off / load_g
    spread = float(((load_g - load_g.mean()) ** 2).sum())
    return Quality(
        rms_g=float(np.sqrt((off**2).mean())),
        largest_g=float(abs(off).max()),
        rms_percent=float(np.sqrt((share**2).mean())),
        largest_percent=float(abs(share).max()),
        r_squared=float(1.0 - (off**2).sum() / spread) if spread > 0.0 else 0.0,
    )
