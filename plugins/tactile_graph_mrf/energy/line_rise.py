"""The kernels of a line's conditional: what turning one line on adds to the energy."""

from __future__ import annotations

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.total import broken


@compiled_as_is
def line_rise(pattern, parallel, one, cost, site, lines, codes):  # type: ignore[no-untyped-def]
    """Return the energy with a line on less that with it off (Eq. 5.20 to 5.22).

    ``cost`` is that of the pair it parts, ``site`` its row of `Layout.sites`; ``codes`` hold
    the pattern of lines on at each corner.
    """
    rise = one - cost
    # Bits of `pattern_costs`: a vertical line is the upper one at its lower end, and so on.
    bit = 1 if site[7] == 1 else 4
    for end in range(3, 5):
        if site[end] >= 0:
            code = codes[site[end]]
            off = code & ~bit
            rise += pattern[off | bit] - pattern[off]
        bit *= 2
    for beside in range(5, 7):
        if site[beside] >= 0 and lines[site[beside]]:
            rise += parallel
    return rise


@compiled_as_is
def turn(site, on, lines, codes):  # type: ignore[no-untyped-def]
    """Turn a line on or off, in ``lines`` and in the patterns of the corners at its ends."""
    lines[site[0]] = on
    bit = 1 if site[7] == 1 else 4
    for end in range(3, 5):
        if site[end] >= 0:
            codes[site[end]] = (codes[site[end]] | bit) if on else (codes[site[end]] & ~bit)
        bit *= 2


@compiled_as_is
def corner_codes(across, down, corners, codes):  # type: ignore[no-untyped-def]
    """Write the pattern of lines on at each corner, a row of corners after the other."""
    for i in range(corners.shape[0]):
        for j in range(corners.shape[1]):
            codes[i * corners.shape[1] + j] = (
                1 * down[i, j] + 2 * down[i + 1, j] + 4 * across[i, j] + 8 * across[i, j + 1]
            )


@compiled_as_is
def far_rise(  # type: ignore[no-untyped-def]
    in_field, costs, offsets, labels, across, down, standing, i, j,
):  # fmt: skip
    """Return what pairs of orders 2 and 3 add to `line_rise` of the line at (i, j)."""
    rows, columns = in_field.shape
    lines = down if standing else across
    now = lines[i, j]
    rise = 0.0
    for a in range(max(i - 1, 0), i + 1):
        for b in range(max(j - 1, 0), min(j + 2, columns)):
            if not in_field[a, b]:
                continue
            for k in range(2, len(offsets)):
                di, dj = offsets[k, 0], offsets[k, 1]
                m, n = a + di, b + dj
                if m >= rows or n >= columns or n < 0 or not in_field[m, n]:
                    continue
                lines[i, j] = True
                cut = broken(across, down, a, b, di, dj)
                lines[i, j] = False
                if cut and not broken(across, down, a, b, di, dj):
                    rise -= costs[k, costs.shape[1] // 2 + labels[a, b] - labels[m, n]]
    lines[i, j] = now
    return rise
