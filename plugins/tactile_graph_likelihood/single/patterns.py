"""Patterns in an image's residuals that the model has no name for; normal where there are none."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, squared_length
from tactile_graph_likelihood.geometry.outlines import Values

FEWEST = 8  # residuals, for a trend
RIM = 0.15  # pressure squared at the rim: the outermost elements are covered in part only


@compiled_as_is
def neighbours_alike(residuals: Values) -> float:
    """Return the correlation of neighbours' residuals, in its standard deviations.

    Parameters
    ----------
    residuals : ndarray, shape (rows, columns)
        Normal under the model; 0 where there is none.
    """
    rows, columns = residuals.shape
    pairs = product = count = squares = 0.0
    for i in range(rows):
        for j in range(columns):
            here = residuals[i, j]
            if here == 0.0:
                continue
            count += 1.0
            squares += here * here
            if i + 1 < rows and residuals[i + 1, j] != 0.0:
                pairs += 1.0
                product += here * residuals[i + 1, j]
            if j + 1 < columns and residuals[i, j + 1] != 0.0:
                pairs += 1.0
                product += here * residuals[i, j + 1]
    return product * count / (math.sqrt(pairs) * squares) if pairs > 0.0 else 0.0


@compiled_as_is
def dome(share: Values) -> Values:
    """Return the logarithm of the pressure under a ball that covers what an outline covers.

    Parameters
    ----------
    share : ndarray, shape (rows, columns)
        Of each element that is covered.

    Notes
    -----
    The pressure is ``sqrt(1 - 0.85 r**2)``; r is the distance from the middle in terms of the
    share's second moments, so 1 at the rim of a disc or ellipse.
    """
    rows, columns = share.shape
    total = y = x = yy = xy = xx = 0.0
    for i in range(rows):
        for j in range(columns):
            c = share[i, j]
            total += c
            y += c * i
            x += c * j
            yy += c * i * i
            xy += c * i * j
            xx += c * j * j
    out = np.zeros(share.shape)
    if total <= 0.0:
        return out
    y, x = y / total, x / total
    yy, xy, xx = yy / total - y * y, xy / total - x * y, xx / total - x * x
    area = yy * xx - xy * xy
    if area < 1e-3:
        return out
    for i in range(rows):
        for j in range(columns):
            u, v = i - y, j - x
            squared = 0.25 * (xx * u * u - 2.0 * xy * u * v + yy * v * v) / area
            out[i, j] = 0.5 * math.log(max(1.0 - (1.0 - RIM) * squared, 0.5 * RIM))
    return out


@compiled_as_is
def trend(residuals: Values, row: int, column: int, domes: Values) -> tuple[float, float]:
    """Return how much residuals lean to a side, and fall to the rim, in standard deviations.

    Parameters
    ----------
    residuals : ndarray, shape (all rows, all columns)
        Of mean 0 and equal variance under the model; 0 where there is none.
    row, column : int
        Where the window of ``domes`` begins.
    domes : ndarray, shape (rows, columns)
        As `dome` gives it.

    Notes
    -----
    Residuals are regressed on row and column, and on what these leave of the dome: score tests of
    a load that leans, and of one that falls or rises towards the rim. For the lean, the number of
    residuals times the explained share of their squares, s, is chi squared with 2 degrees of
    freedom, and ``sqrt(2 s) - sqrt(3)`` nearly normal (R. A. Fisher).
    """
    means, values = np.zeros(4), np.empty(4)
    matrix, right, root = np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3))
    count = squares = 0.0
    for turn in range(2):
        for i in range(domes.shape[0]):
            for j in range(domes.shape[1]):
                here = residuals[row + i, column + j]
                if here == 0.0:
                    continue
                values[0], values[1], values[2], values[3] = i, j, domes[i, j], here
                if turn == 0:
                    count += 1.0
                    for k in range(4):
                        means[k] += values[k]
                    continue
                for k in range(4):
                    values[k] -= means[k]
                squares += values[3] * values[3]
                for k in range(3):
                    right[k] += values[k] * values[3]
                    for m in range(k + 1):
                        matrix[k, m] += values[k] * values[m]
        if turn == 0:
            if count < FEWEST:
                return 0.0, 0.0
            means /= count
    if squares <= 0.0 or not cholesky(matrix, root):
        return 0.0, 0.0
    squared_length(root, right, values)
    scale = 2.0 * count / squares
    tilt = math.sqrt(scale * (values[0] * values[0] + values[1] * values[1])) - math.sqrt(3.0)
    return tilt, math.sqrt(0.5 * scale) * values[2]
