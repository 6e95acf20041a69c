"""How many independent samples a run of a Markov chain is worth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def effective_size(samples: NDArray[np.float64]) -> float:
    """Return the effective sample size of the worst column that varies at all.

    Parameters
    ----------
    samples : ndarray of float64, shape (n, quantities)
        In the order in which they were drawn.

    Returns
    -------
    float
        Between 1 and n; n if nothing varies.

    Notes
    -----
    n over the sum of the autocorrelations, cut off by the initial monotone sequence of Geyer
    (1992), DOI 10.1214/ss/1177011137. Columns that anticorrelate count as n.
    """
    n = len(samples)
    moved = np.ptp(samples, axis=0) > 0
    if not moved.any() or n < 4:
        return float(n)
    centred = samples[:, moved] - samples[:, moved].mean(axis=0)
    centred /= np.abs(centred).max(axis=0)  # squares of huge energies would overflow
    spectrum = np.fft.rfft(centred, 2 * n, axis=0)
    covariance = np.fft.irfft(np.abs(spectrum) ** 2, axis=0)[:n]
    correlation = covariance / covariance[0]
    even = n - n % 2
    pairs = correlation[0:even:2] + correlation[1:even:2]
    falling = np.minimum.accumulate(pairs, axis=0)
    kept = np.where(falling > 0, falling, 0.0)
    time = np.maximum(2.0 * kept.sum(axis=0) - 1.0, 1.0)
    return float(n / min(time.max(), n))
