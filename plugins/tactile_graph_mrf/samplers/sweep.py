"""Kernels of the samplers: sweeps of the Gibbs sampler over cells and lines (section 5.2.3).

At infinite ``beta`` (temperature 0) a sweep is one of iterated conditional modes.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.line_rise import corner_codes, far_rise, line_rise, turn
from tactile_graph_mrf.energy.total import broken, total
from tactile_graph_mrf.samplers.draws import draw_cost, draw_line, draw_parabola


@compiled_as_is
def clique_costs(bare, weights, price, beta, costs):  # type: ignore[no-untyped-def]
    """Write each kind of clique's cost of each difference, its line summed out if at a price.

    Shape (K, 2 L - 1): difference d at L - 1 + d. A pair whose line is summed out costs
    -log(exp(-beta rho) + exp(-beta price)) / beta, at infinite beta the lesser of both.
    ``price`` is negative where lines are no matter of the pair.
    """
    last = len(bare) - 1
    for k in range(len(weights)):
        for d in range(last + 1):
            rho = weights[k] * bare[d]
            if price >= 0.0:
                line = weights[k] * price
                gap = abs(rho - line)
                rho = min(rho, line)
                if beta < math.inf and beta * gap < 40.0:
                    rho -= math.log1p(math.exp(-beta * gap)) / beta
            costs[k, last + d] = rho
            costs[k, last - d] = rho


@compiled_as_is
def sweep_cells(  # type: ignore[no-untyped-def]
    curvature, centre, table, row, offsets, costs, gaussian, cells, near, cut,
    beta, uniforms, labels, lines, across, down, buffer, kept,
):  # fmt: skip
    """Visit each cell once; return (whether any changed, whether none could).

    ``costs`` are those of `clique_costs`, ``cells``, ``near`` and ``cut`` those of `Layout`.
    """
    columns = labels.shape[1]
    flat, curvatures, centres = labels.reshape(-1), curvature.reshape(-1), centre.reshape(-1)
    rows_of = row.reshape(-1)
    n_levels = len(buffer)
    changed, certain = False, True
    for s in range(len(cells)):
        cell = cells[s]
        now = flat[cell]
        middle = centres[cell]
        sharpness = curvatures[cell]
        pull = sharpness * middle
        if not gaussian:
            own = table[rows_of[cell]]
            for x in range(n_levels):
                buffer[x] = sharpness * ((x - middle) * (x - middle)) + own[x]
        for q in range(near.shape[1]):
            other = near[s, q]
            if other < 0:
                continue
            if q < 4:
                if lines[cut[s, q]]:
                    continue
            else:
                base = other if q % 2 else cell
                di, dj = offsets[q // 2, 0], offsets[q // 2, 1]
                if broken(across, down, base // columns, base % columns, di, dj):
                    continue
            at = flat[other]
            if gaussian:
                weight = costs[q // 2, n_levels]
                sharpness += weight
                pull += weight * at
            else:
                first = n_levels - 1 - at
                tie = costs[q // 2, first : first + n_levels]
                for x in range(n_levels):
                    buffer[x] += tie[x]
        if not gaussian:
            label, sure = draw_cost(buffer, kept, beta, uniforms[s], now)
        elif sharpness > 0.0:
            mean = pull / sharpness
            label, sure = draw_parabola(sharpness, mean, n_levels, beta, uniforms[s])
        elif beta == math.inf:
            label, sure = now, True
        else:
            label, sure = int(uniforms[s] * n_levels), False
        certain = certain and sure
        if label != now:
            flat[cell] = label
            changed = True
    return changed, certain


@compiled_as_is
def sweep_lines(  # type: ignore[no-untyped-def]
    in_field, offsets, pattern, parallel, one, costs, sites, beta, uniforms,
    labels, lines, across, down, codes,
):  # fmt: skip
    """Visit each line site once; return (whether any changed, whether none could)."""
    columns = labels.shape[1]
    flat = labels.reshape(-1)
    last = costs.shape[1] // 2
    changed, certain = False, True
    for s in range(len(sites)):
        site = sites[s]
        standing = site[7] == 1
        cost = costs[0 if standing else 1, last + flat[site[1]] - flat[site[2]]]
        rise = line_rise(pattern, parallel, one, cost, site, lines, codes)
        if len(offsets) > 2:
            i, j = site[1] // columns, site[1] % columns
            rise += far_rise(in_field, costs, offsets, labels, across, down, standing, i, j)
        was = lines[site[0]]
        on, sure = draw_line(rise, beta, uniforms[s], was)
        certain = certain and sure
        if on != was:
            turn(site, on, lines, codes)
            changed = True
    return changed, certain


@compiled_as_is
def sweep(  # type: ignore[no-untyped-def]
    in_field, curvature, centre, table, row, offsets, pattern, parallel, one, costs, gaussian,
    cells, near, cut, sites, beta, uniforms, labels, lines, across, down, codes, buffer, kept,
):  # fmt: skip
    """Visit each cell, then each line, once; return (whether any changed, whether none could)."""
    n = len(cells)
    changed, certain = sweep_cells(
        curvature, centre, table, row, offsets, costs, gaussian, cells, near, cut,
        beta, uniforms[:n], labels, lines, across, down, buffer, kept,
    )  # fmt: skip
    if len(sites) > 0:
        turned, sure = sweep_lines(
            in_field, offsets, pattern, parallel, one, costs, sites, beta, uniforms[n:],
            labels, lines, across, down, codes,
        )  # fmt: skip
        changed, certain = changed or turned, certain and sure
    return changed, certain


@compiled_as_is
def anneal(  # type: ignore[no-untyped-def]
    in_field, curvature, centre, table, row, smooth, offsets, weights, pattern, parallel, one,
    bare, price, gaussian, cells, near, cut, sites, corners,
    betas, uniforms, labels, lines, across, down, trace,
):  # fmt: skip
    """Sweep at each of ``betas`` in turn; return how many sweeps were done and if all froze.

    Writes labels, lines and the energy after each sweep. Stops after a sweep that changed
    nothing and could have changed nothing: while ``betas`` do not fall, none ever will.
    """
    n_levels = len(bare)
    costs = np.empty((len(weights), 2 * n_levels - 1))
    buffer, kept = np.empty(n_levels), np.empty(n_levels, np.int64)
    codes = np.empty(corners.size, np.int64)
    corner_codes(across, down, corners, codes)
    for t in range(len(betas)):
        if t == 0 or price >= 0.0:
            clique_costs(bare, weights, price, betas[t], costs)
        changed, certain = sweep(
            in_field, curvature, centre, table, row, offsets, pattern, parallel, one, costs,
            gaussian, cells, near, cut, sites, betas[t], uniforms[t], labels, lines, across, down,
            codes, buffer, kept,
        )  # fmt: skip
        trace[t] = total(
            in_field, curvature, centre, table, row, smooth, offsets, weights, pattern, parallel,
            one, labels, across, down,
        )  # fmt: skip
        if certain and not changed:
            return t + 1, True
    return len(betas), False
