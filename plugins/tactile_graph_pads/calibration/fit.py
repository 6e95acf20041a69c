"""Fit a calibration curve: polynomial (the thesis), isotonic lines, group sums, power law."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_pads.calibration.calibration import (
    FORMAT,
    UNITS,
    Calibration,
    Point,
    Quality,
    Units,
)
from tactile_graph_pads.calibration.curves import Isotonic, Polynomial, PowerLaw
from tactile_graph_pads.calibration.points import Observation

Array = NDArray[np.float64]
FitKind = Literal["polynomial", "isotonic", "sums", "power"]
FITS: tuple[str, ...] = get_args(FitKind)
LEAST_LOADS = {"isotonic": 3, "sums": 3, "power": 3}
MOST_LINES = 12
WHERE = "calibration"
"""What errors name."""


def calibrated(
    points: Sequence[Point],
    kind: FitKind = "polynomial",
    reading: Literal["volt", "siemens", "counts", "raw"] = "volt",
    order: int = 5,
    observations: Sequence[Observation] = (),
) -> Calibration:
    """Return the calibration of one kind that comes nearest to the points.

    Parameters
    ----------
    points : sequence of Point
        By rising load, as `calibration_points.points_of` makes them.
    kind : "polynomial", "isotonic", "sums" or "power"
    reading : str
        What was read.
    order : int
        Of the polynomial.
    observations : sequence of Observation
        What the points were made from; the fit by sums needs them.

    Raises
    ------
    DataError
        If there are too few loads for this kind, or the fit is not monotone.

    Notes
    -----
    Minimised is the sum of squares of: the relative error of load, for the polynomial (which goes
    through (0, 0)); that of ln load, for the power law; that of the reading, under the condition
    that it does not fall, for the isotonic lines; the relative error of each group's summed
    load, for the sums. The first three take a group's mean reading for that of its mean load. On
    uneven elements that is biased, as the law between them is curved; the sums are not.
    """
    _check_number(points, kind, order)
    load = np.array([p.load_g for p in points])
    read = np.array([p.reading for p in points])
    fit: Polynomial | Isotonic | PowerLaw
    if kind == "polynomial":
        fit = fit_polynomial(read, load, order)
    elif kind == "isotonic":
        fit = fit_isotonic(read, load, np.array([float(p.placements) for p in points]))
    elif kind == "sums":
        fit = fit_sums(observations, read)
    else:
        fit = fit_power(read, load)
    return Calibration(
        format=FORMAT,
        reading=reading,
        fit=fit,
        from_reading=float(read.min()),
        up_to=fit.points[-1][0] if isinstance(fit, Isotonic) else float(read.max()),
        quality=quality_of(fitted_g(fit, points, observations if kind == "sums" else ()), load),
        points=tuple(points),
        units=Units(UNITS[reading]),
    )


def _check_number(points: Sequence[Point], kind: FitKind, order: int) -> None:
    needed = order + 1 if kind == "polynomial" else LEAST_LOADS[kind]
    if len(points) < needed:
        what = f"a polynomial of order {order}" if kind == "polynomial" else f"the fit {kind}"
        raise DataError(
            WHERE, f"too few loads: {what} needs {needed} different ones, got {len(points)}"
        )


def fit_polynomial(reading: Array, load_g: Array, order: int) -> Polynomial:
    """Return grams as a polynomial of the reading, through (0, 0).

    Parameters
    ----------
    reading, load_g : ndarray, shape (n,)
    order : int

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
            WHERE,
            f"not monotone: the polynomial of order {order} falls between readings "
            f"{falling[0] * top:.4g} and {falling[-1] * top:.4g}, so one reading there would mean "
            "several loads; take fewer orders, other loads, or the isotonic fit",
        )
    coefficients = scaled / top ** np.arange(1.0, order + 1)
    return Polynomial("polynomial", (0.0, *map(float, coefficients)))


def fit_isotonic(reading: Array, load_g: Array, weights: Array) -> Isotonic:
    """Return the straight lines through the readings nearest to these that do not fall.

    Parameters
    ----------
    reading, load_g, weights : ndarray, shape (n,)
        By rising load.

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
        # a pooled mean of equals may come out a rounding apart
        while len(blocks) > 1 and blocks[-1][0] <= blocks[-2][0] * (1.0 + 1e-12):
            (r1, g1, w1), (r0, g0, w0) = blocks.pop(), blocks.pop()
            w = w0 + w1
            blocks.append(((r0 * w0 + r1 * w1) / w, (g0 * w0 + g1 * w1) / w, w))
    if len(blocks) < 2:
        raise DataError(WHERE, "not monotone: the readings do not rise with the loads at all")
    return Isotonic("isotonic", ((0.0, 0.0), *((r, g) for r, g, _ in blocks)))


def fit_sums(observations: Sequence[Observation], reading: Array) -> Isotonic:
    """Return rising straight lines whose grams, summed over each group, come nearest its weight.

    Parameters
    ----------
    observations : sequence of Observation
    reading : ndarray, shape (n,)
        Mean reading of each load: where lines may meet, besides the largest single reading.

    Raises
    ------
    DataError
        If no rising line explains the weights.

    Notes
    -----
    A load cell's way to calibrate an array: a sum of rises that are not negative is linear in
    them, so this is a non-negative least squares problem (Lawson and Hanson 1974). Lines meet at
    none of the single readings between, as these would put grams on the noise of idle elements.
    """
    from scipy.optimize import nnls

    if not observations:
        raise ValueError("the fit by sums needs the observations")
    largest = max(float(o.readings.max()) for o in observations)
    levels = np.unique(np.append(reading, max(largest, float(reading.max()))))
    if len(levels) > MOST_LINES:
        levels = np.quantile(levels, np.linspace(0.0, 1.0, MOST_LINES))
    nodes = np.append(0.0, levels)
    widths = np.diff(nodes)
    rises = [
        np.clip((o.readings[:, None] - nodes[:-1]) / widths, 0.0, 1.0).mean(axis=0) / o.load_g
        for o in observations
    ]
    found = nnls(np.array(rises), np.ones(len(rises)))[0]
    grams = np.append(0.0, np.cumsum(found))
    if grams[-1] <= 0.0:
        raise DataError(WHERE, "not monotone: no rising curve explains these loads")
    return Isotonic("isotonic", tuple(zip(nodes.tolist(), grams.tolist(), strict=True)))


def fit_power(reading: Array, load_g: Array) -> PowerLaw:
    """Return grams as a power of the reading.

    Parameters
    ----------
    reading, load_g : ndarray, shape (n,)

    Raises
    ------
    DataError
        If the power is not above 0.
    """
    unit = 1e-6 if reading.max() < 1e-2 else 1.0
    exponent, log_scale = np.polyfit(np.log(reading / unit), np.log(load_g), 1)
    if exponent <= 0.0:
        raise DataError(WHERE, f"not monotone: the loads go with reading^{exponent:.3g}, falling")
    return PowerLaw("power", float(np.exp(log_scale)), float(exponent), unit)


def fitted_g(
    fit: Polynomial | Isotonic | PowerLaw,
    points: Sequence[Point],
    observations: Sequence[Observation] = (),
) -> Array:
    """Return what a fit makes of each point, shape (n,).

    Parameters
    ----------
    fit : Polynomial, Isotonic or PowerLaw
    points : sequence of Point
    observations : sequence of Observation
        When given, single elements are turned into grams and averaged then.
    """
    top = fit.points[-1][0] if isinstance(fit, Isotonic) else np.inf
    if not observations:
        return fit.grams(np.minimum([p.reading for p in points], top))
    by_load: dict[float, list[float]] = {p.load_g: [] for p in points}
    for seen in observations:
        grams = fit.grams(np.clip(seen.readings, 0.0, top))
        by_load[float(seen.load_g)].append(float(grams.mean()))
    return np.array([np.mean(by_load[p.load_g]) for p in points])


def quality_of(found_g: Array, load_g: Array) -> Quality:
    """Return how far fitted loads are from the known ones.

    Parameters
    ----------
    found_g, load_g : ndarray, shape (n,)
    """
    off = found_g - load_g
    share = 100.0 * off / load_g
    spread = float(((load_g - load_g.mean()) ** 2).sum())
    return Quality(
        rms_g=float(np.sqrt((off**2).mean())),
        largest_g=float(abs(off).max()),
        rms_percent=float(np.sqrt((share**2).mean())),
        largest_percent=float(abs(share).max()),
        r_squared=float(1.0 - (off**2).sum() / spread) if spread > 0.0 else 0.0,
    )
