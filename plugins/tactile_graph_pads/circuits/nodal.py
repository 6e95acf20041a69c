"""Nodal analysis of any resistor network: the slow reference the circuits are tested against.

Works in any kind of number: with `fractions.Fraction` its answers are exact.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple


def node_voltages(
    n_nodes: int,
    conductances: Sequence[tuple[int, int, Any]],
    fixed: Mapping[int, Any],
) -> list[Any]:
    """Return the voltage of every node; a node without a way to a fixed one is at 0.

    Parameters
    ----------
    n_nodes : int
        Nodes are numbered from 0.
    conductances : sequence of (int, int, number)
        Between two nodes; several between the same two add up.
    fixed : mapping of int to number
        Nodes held at a voltage: sources, ground, virtual grounds.

    Notes
    -----
    Kirchhoff's current law at each free node, solved by eliminating each as a star that becomes
    a mesh, then going back. A zero conductance may be left out.
    """
    zero = 0 * next(iter(fixed.values()))
    weight: list[dict[int, Any]] = [{} for _ in range(n_nodes)]
    for a, b, g in conductances:
        if a != b and g:
            weight[a][b] = weight[a].get(b, zero) + g
            weight[b][a] = weight[b].get(a, zero) + g
    free = [k for k in range(n_nodes) if k not in fixed]
    stars = []
    for k in free:
        star = weight[k]
        total = sum(star.values(), zero)
        stars.append((k, star, total))
        _star_to_mesh(weight, k, star, total)
    voltage = [fixed.get(k, zero) for k in range(n_nodes)]
    for k, star, total in reversed(stars):
        if star:
            voltage[k] = sum((g * voltage[b] for b, g in star.items()), zero) / total
    return voltage


def _star_to_mesh(weight: list[dict[int, Any]], k: int, star: dict[int, Any], total: Any) -> None:
    for a, g_a in star.items():
        del weight[a][k]
        for b, g_b in star.items():
            if a != b:
                weight[a][b] = weight[a].get(b, 0 * total) + g_a * g_b / total


class _Scan(NamedTuple):
    """A circuit and the conductances it scans; see `measured_ratio`."""

    kind: str
    siemens: Sequence[Sequence[Any]]
    bias_ohm: Any
    driver_ohm: Any
    mux_ohm: Any


def measured_ratio(kind: str, siemens: Sequence[Sequence[Any]], bias_ohm: Any, driver_ohm: Any,
                   mux_ohm: Any) -> list[list[Any]]:  # fmt: skip
    """Return what a scan measures in shares of the supply, one network solved per element.

    Parameters
    ----------
    kind : str
        ``divider``, ``floating`` or ``feedback``.
    siemens : sequence of sequences of numbers
        Conductances, rows by columns.
    bias_ohm, driver_ohm, mux_ohm : number
        As the circuits take them; ``mux_ohm`` does not apply to ``feedback``.
    """
    scan = _Scan(kind, siemens, bias_ohm, driver_ohm, mux_ohm)
    rows, columns = len(siemens), len(siemens[0])
    return [[_one(scan, i, j) for j in range(columns)] for i in range(rows)]


def _one(scan: _Scan, i: int, j: int) -> Any:
    """Return what is measured at row i and column j."""
    kind, siemens, bias, driver, mux = scan
    rows, columns = len(siemens), len(siemens[0])
    n = rows + columns
    ground, supply, tap = n, n + 1, n + 2
    one = 1 + 0 * bias
    nets = [(a, rows + b, siemens[a][b]) for a in range(rows) for b in range(columns)]
    fixed = {ground: 0 * one, supply: one}
    for a in range(rows):
        if a != i and kind == "floating":
            continue
        source = supply if a == i else ground
        if driver:
            nets.append((a, source, one / driver))
        else:
            fixed[a] = fixed[source]
    if kind == "feedback":
        fixed |= {rows + b: 0 * one for b in range(columns)}
        voltage = node_voltages(n + 2, nets, fixed)
        return bias * sum((siemens[a][j] * voltage[a] for a in range(rows)), 0 * one)
    read = rows + j
    if mux:
        nets += [(read, tap, one / mux), (tap, ground, one / bias)]
    else:
        nets.append((read, ground, one / bias))
    return node_voltages(n + 3, nets, fixed)[tap if mux else read]
