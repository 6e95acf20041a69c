"""Where the kernels find neighbours, lines and corners: index tables, made once per field."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.potentials import OFFSETS
from tactile_graph_mrf.energy.problem import Problem

Indices = NDArray[np.int64]


class Layout(NamedTuple):
    """Index tables of a field; -1 stands for what is not there. Cells and lines count in a row.

    Parameters
    ----------
    cells : ndarray, shape (N,)
        The cells of the field, one colour class after the other: no two cells of a class are in
        one clique, so that a class may be visited in any order. 2, 4 and 5 classes for the
        orders 1, 2 and 3.
    near : ndarray, shape (N, 2 K)
        The other cell of each pair clique of a cell: forth and back along each offset.
    cut : ndarray, shape (N, 4)
        The line between a cell and its four nearest, in the order of ``near``.
    sites : ndarray, shape (M, 8)
        Each line site: its line, the cells on both its sides, the corners at its ends (the
        later one first), the lines beside it (earlier, later), and whether it is vertical. By
        colour classes too.
    corners : ndarray, shape (rows - 1, columns - 1)
        Whether all four cells that meet are in the field.
    """

    cells: Indices
    near: Indices
    cut: Indices
    sites: Indices
    corners: NDArray[np.bool_]


def layout(problem: Problem) -> Layout:
    """Return the index tables of a problem; those of whole images are kept for the next one."""
    order, explicit = problem.model.order, problem.model.lines == "explicit"
    field = problem.in_field
    if field.all():
        return _whole(problem.shape, order, explicit)
    return _made(field, order, problem.pairwise.offsets, explicit)


class Neighbours(NamedTuple):
    """The same by cell: ``near`` and ``cut`` have a row for each cell of the grid."""

    cells: Indices
    near: Indices
    cut: Indices


@compiled_as_is
def by_cell(layout: Layout, size: int) -> Neighbours:
    """Return the cells of the field and who is beside each of ``size`` cells; -1 off the field."""
    cells = layout.cells
    near, cut = np.full((size, layout.near.shape[1]), -1), np.full((size, 4), -1)
    for s in range(len(cells)):
        near[cells[s]], cut[cells[s]] = layout.near[s], layout.cut[s]
    return Neighbours(cells, near, cut)


@lru_cache(maxsize=8)
def _whole(shape: tuple[int, int], order: int, explicit: bool) -> Layout:
    return _made(np.ones(shape, np.bool_), order, OFFSETS[: 2 * order], explicit)


def _made(field: NDArray[np.bool_], order: int, offsets: Indices, explicit: bool) -> Layout:
    i, j = np.nonzero(field)
    colour = ((i + j) % 2, 2 * (i % 2) + j % 2, (i + 2 * j) % 5)[order - 1]
    at = np.argsort(colour, kind="stable")
    i, j = i[at], j[at]
    columns = field.shape[1]
    ids = _padded(np.where(field, np.arange(field.size).reshape(field.shape), -1))
    near = [_at(ids, i + s * di, j + s * dj) for di, dj in offsets.tolist() for s in (1, -1)]
    across, down = _line_ids(field)
    a, d = _padded(across), _padded(down)
    cut = [_at(d, i, j), _at(d, i, j - 1), _at(a, i, j), _at(a, i - 1, j)]
    corners = field[:-1, :-1] & field[:-1, 1:] & field[1:, :-1] & field[1:, 1:]
    sites = _sites(field, across, down, corners) if explicit else np.zeros((0, 8), np.int64)
    made = Layout(
        np.ascontiguousarray(i * columns + j),
        np.ascontiguousarray(np.stack(near, 1)),
        np.ascontiguousarray(np.stack(cut, 1)),
        np.ascontiguousarray(sites),
        corners,
    )
    for table in made:
        table.setflags(write=False)
    return made


def _line_ids(field: NDArray[np.bool_]) -> tuple[Indices, Indices]:
    rows, columns = field.shape
    n = (rows - 1) * columns
    across = np.arange(n).reshape(rows - 1, columns)
    down = n + np.arange(rows * (columns - 1)).reshape(rows, columns - 1)
    return (
        np.where(field[:-1] & field[1:], across, -1),
        np.where(field[:, :-1] & field[:, 1:], down, -1),
    )


def _sites(
    field: NDArray[np.bool_], across: Indices, down: Indices, corners: NDArray[np.bool_]
) -> Indices:
    columns = field.shape[1]
    ids = np.where(corners, np.arange(corners.size).reshape(corners.shape), -1)
    a, d, c = _padded(across), _padded(down), _padded(ids)
    i, j = np.nonzero(across >= 0)
    cell = i * columns + j
    lying = [
        *(across[i, j], cell, cell + columns, _at(c, i, j), _at(c, i, j - 1)),
        *(_at(a, i - 1, j), _at(a, i + 1, j), 0 * i),
    ]
    m, n = np.nonzero(down >= 0)
    cell = m * columns + n
    standing = [
        *(down[m, n], cell, cell + 1, _at(c, m, n), _at(c, m - 1, n)),
        *(_at(d, m, n - 1), _at(d, m, n + 1), 0 * m + 1),
    ]
    colour = np.concatenate([(i + j) % 2, 2 + (m + n) % 2])
    sites = np.concatenate([np.stack(lying, 1), np.stack(standing, 1)])
    return np.asarray(sites[np.argsort(colour, kind="stable")])


def _padded(ids: Indices) -> Indices:
    return np.pad(ids, 2, constant_values=-1)


def _at(padded: Indices, i: Indices, j: Indices) -> Indices:
    return np.asarray(padded[i + 2, j + 2])
