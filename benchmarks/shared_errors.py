"""How much of the errors at the contacts of `panel` all localisers share, and what that adds.

What is fitted is fitted on every second recording and measured on the others, as in `panel`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from panel import CELLS, PITCH_CM, Seen, unknowns

Reals = NDArray[np.float64]
CERTAIN = 0.9


def left_over(seen: Seen, at: Reals, more: list[Reals]) -> Reals:
    """Return errors in cells, (n, 2): affine and leaning, and ``more`` that is fitted."""
    moves = np.stack([*unknowns(at, "affine"), -seen.skewness, *more], axis=2)
    left = seen.true - at
    for half in (0, 1):
        tested = seen.recording % 2 == half
        a, b = moves[~tested], (seen.true - at)[~tested]
        fitted = np.linalg.lstsq(a.reshape(-1, a.shape[2]), b.ravel(), rcond=None)[0]
        left[tested] -= moves[tested] @ fitted
    cells: Reals = left / PITCH_CM
    return cells


def bends(at: Reals) -> list[Reals]:
    """Return what each of six more numbers, of second order, does to each place."""
    x, y = (at / PITCH_CM / CELLS - 0.5).T
    none = np.zeros(len(at))
    both = [(np.column_stack([v, none]), np.column_stack([none, v])) for v in (x * x, x * y, y * y)]
    return [move for pair in both for move in pair]


def told_alike(seen: dict[str, Seen], peer: str) -> None:
    """Print how alike the errors of localisers are that all answer the same contacts."""
    left = {name: left_over(its, its.centres[name], []) for name, its in seen.items()}
    print(f"\naffine, leaning: correlation of the errors with those of '{peer}'; distance of both")
    print("centres, cells, root mean square; median error where the grids may bend too")
    for name, its in seen.items():
        correlation = np.corrcoef(left[name].ravel(), left[peer].ravel())[0, 1]
        apart = np.sqrt(((left[name] - left[peer]) ** 2).sum(axis=1).mean())
        bent = np.hypot(*left_over(its, its.centres[name], bends(its.centres[name])).T)
        print(f"  {name:28s} {correlation:5.2f} {apart:6.3f} {np.median(bent):6.3f}")
    base = seen[peer].centres[peer]
    others = [its.centres[name] - base for name, its in seen.items() if name != peer]
    off = np.hypot(*left_over(seen[peer], base, others).T)
    print(f"  all, mixed as suits the other half best: median error {np.median(off):.3f}")


def added(seen: Seen, off: Reals, std: Reals) -> tuple[float, float, float]:
    """Return what stated deviations of the centre lack, and how they do once it is added.

    Parameters
    ----------
    seen : Seen
    off, std : ndarray, shape (n,)
        Error and stated deviation of each contact, in cells.

    Returns
    -------
    (float, float, float)
        The part that all contacts share, in cells, as one half of the recordings has it; on the
        other half the error over both parts together, root mean square, and the share of errors
        within 90 % of the normal distribution that they make.
    """
    half = seen.recording % 2
    shared = np.array([max(float(np.mean((off**2 - std**2)[half != k])), 0.0) for k in (0, 1)])
    squares = off**2 / (std**2 + shared[half])
    within = float(np.mean(squares < -np.log(1.0 - CERTAIN)))
    return float(np.sqrt(shared.mean())), float(np.sqrt(squares.mean())), within
