"""``turn``: the exact sense in which three points turn; what every hull here stands on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of

SPLITTER = 134217729.0  # 2**27 + 1 cuts a double into halves whose products are exact
FILTER = 3.3306690738754716e-16  # (3 + 16 eps) eps with eps = 2**-53: Shewchuk's bound A
SECOND = 2.0e-31  # 16 eps**2: his bound C, raised for the plainer sum of the four leading terms
RESULT = 3.5e-16  # (3 + 8 eps) eps, rounded up
LARGEST, SMALLEST = 2.0**480, 2.0**-430  # sizes within which no product below under- or overflows


def _turn(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return the sense of a -> b -> c as seen: 1 counter-clockwise, -1 clockwise, 0 on one line.

    Exact for all finite coordinates: integers take over where rounding could decide. As y runs
    down, the sign is the opposite of the textbook determinant's.
    """
    left, right = (ay - cy) * (bx - cx), (ax - cx) * (by - cy)
    det = left - right
    # Below 1e-280 the products may have lost bits to underflow and the bound says nothing.
    if 1e300 > abs(det) > max(FILTER * (abs(left) + abs(right)), 1e-280):
        return 1 if det > 0.0 else -1
    ratios = [float(v).as_integer_ratio() for v in (ax, ay, bx, by, cx, cy)]
    unit = max(d for _, d in ratios)  # denominators are powers of two: the largest fits all
    iax, iay, ibx, iby, icx, icy = (n * (unit // d) for n, d in ratios)
    exact = (iay - icy) * (ibx - icx) - (iax - icx) * (iby - icy)
    return (exact > 0) - (exact < 0)


@compiled_later
def product_in_two(a: float, b: float) -> tuple[float, float]:
    """Return a * b rounded and its rounding error, exactly (Dekker 1971, Veltkamp's splitting)."""
    p = a * b
    wide = SPLITTER * a
    a_high = wide - (wide - a)
    a_low = a - a_high
    wide = SPLITTER * b
    b_high = wide - (wide - b)
    b_low = b - b_high
    return p, a_low * b_low - (((p - a_high * b_high) - a_low * b_high) - a_high * b_low)


@compiled_later
def difference_in_two(a: float, b: float) -> tuple[float, float]:
    """Return a - b rounded and its rounding error, exactly (Knuth's two-sum)."""
    d = a - b
    b_virtual = a - d
    a_virtual = d + b_virtual
    return d, (b_virtual - b) + (a - a_virtual)


@compiled_later
def sign_of_sum(terms: NDArray[np.float64]) -> int:
    """Return the exact sign of a sum, by growing an expansion in place (Shewchuk 1997, fig. 6)."""
    m = 0
    for i in range(terms.shape[0]):
        q = terms[i]
        kept = 0
        for k in range(m):
            q, error = difference_in_two(q, -terms[k])
            if error != 0.0:
                terms[kept] = error
                kept += 1
        if q != 0.0:
            terms[kept] = q
            kept += 1
        m = kept
    if m == 0:
        return 0
    return 1 if terms[m - 1] > 0.0 else -1


@compiled_twin_of(_turn)
def turn(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Do the same by J. R. Shewchuk's adaptive sums (1997, 10.1007/PL00009321, ``orient2d``).

    Coordinates must be 0 or of a size between `SMALLEST` and `LARGEST`.
    """
    left, right = (ay - cy) * (bx - cx), (ax - cx) * (by - cy)
    det = left - right
    total = abs(left) + abs(right)
    if abs(det) > FILTER * total:
        return 1 if det > 0.0 else -1
    if total == 0.0:
        return 0
    u, u_tail = difference_in_two(ay, cy)
    v, v_tail = difference_in_two(bx, cx)
    s, s_tail = difference_in_two(ax, cx)
    t, t_tail = difference_in_two(by, cy)
    left, left_tail = product_in_two(u, v)
    right, right_tail = product_in_two(s, t)
    head = (left - right) + (left_tail - right_tail)
    det = head + ((u * v_tail + v * u_tail) - (s * t_tail + t * s_tail))
    if abs(det) > SECOND * total + RESULT * abs(det):
        return 1 if det > 0.0 else -1
    terms = np.empty(16)
    terms[0], terms[1] = product_in_two(u_tail, v_tail)
    terms[2], terms[3] = product_in_two(-s_tail, t_tail)
    terms[4], terms[5] = product_in_two(u, v_tail)
    terms[6], terms[7] = product_in_two(u_tail, v)
    terms[8], terms[9] = product_in_two(-s, t_tail)
    terms[10], terms[11] = product_in_two(-s_tail, t)
    terms[12], terms[13] = left_tail, -right_tail
    terms[14], terms[15] = left, -right
    return sign_of_sum(terms)
