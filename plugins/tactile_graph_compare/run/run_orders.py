"""Orders in which variants run, so that none always finds the processor's caches cold."""

from __future__ import annotations


def orders(n: int, most: int) -> list[tuple[int, ...]]:
    """Return orders of ``n`` variants in which none is favoured.

    Parameters
    ----------
    n : int
    most : int
        So many orders at most.

    Returns
    -------
    list of tuples of int
        Each comes at each place, and behind each other, equally often: a Latin square for an even
        number, two for an odd one (Williams 1949). Beyond ``most`` some of them, evenly taken.
    """
    zigzag = [0, *(k for pair in zip(range(1, n), range(n - 1, 0, -1), strict=True) for k in pair)]
    rows = [tuple((z + k) % n for z in zigzag[:n]) for k in range(n)]
    if n % 2 and n > 1:
        rows += [row[::-1] for row in rows]
    return [rows[round(i * len(rows) / most)] for i in range(most)] if len(rows) > most else rows
