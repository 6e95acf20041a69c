"""``Inverse``: conductances found behind a frame, and how far they can be trusted."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Inverse(NamedTuple):
    """What a circuit's inverse answers.

    Parameters
    ----------
    siemens : ndarray of float64, shape (rows, columns)
        Conductance of each element; 0 where not valid.
    valid : ndarray of bool, shape (rows, columns)
        False where no conductances could have given these data.
    residual : float
        Largest relative misfit between the data and what the answer would measure as, over
        the valid elements; exactly 0 for a closed form.
    iterations : int
        Steps taken; 0 for a closed form.
    """

    siemens: NDArray[np.float64]
    valid: NDArray[np.bool_]
    residual: float = 0.0
    iterations: int = 0
