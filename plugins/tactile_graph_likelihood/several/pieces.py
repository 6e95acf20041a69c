"""One outline fitted to a piece of the touched elements, beside outlines that stay as they are."""

from __future__ import annotations

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.several.joint_posterior import WIDTH
from tactile_graph_likelihood.several.maximise_jointly import climbed_softly, climbed_together
from tactile_graph_likelihood.single.element_terms import States
from tactile_graph_likelihood.single.problem import Places, problem_of
from tactile_graph_likelihood.single.search import begun

ROUNDS = 25
ENOUGH = 0.2


@compiled_as_is
def fitted(
    kind: int,
    corners: int,
    grid: Values,
    logs: Values,
    piece: States,
    load: Values,
    share: Values,
    states: States,
    noise: Values,
    prior: Values,
    table: Values,
    tries: int,
) -> tuple[Values, float]:
    """Return an outline's point, shape (6,), and its log posterior given others.

    Parameters
    ----------
    kind, corners, grid, logs, noise, prior
        As in `log_posterior`.
    piece : ndarray of uint8
        States of the elements, in which only the piece's own are on: where the search begins.
    load, share
        What the others bring, as in `several_posterior.gain`.
    states : ndarray of uint8
        The states that the outline has to explain in the end.
    table, tries : ndarray, shape (N, 6), and int
        As in `search.begun`.
    """
    first = unknowns(kind, corners)
    start = np.zeros(first + 1)
    begun(problem_of(kind, corners, grid, logs, piece, noise, prior), table, tries, start)
    kinds, sides, points = np.empty(1, np.int64), np.empty(1, np.int64), np.zeros((1, WIDTH))
    kinds[0], sides[0] = kind, corners
    points[0, : first + 1] = start
    bare = np.zeros(piece.shape)
    climbed_softly(
        kinds, sides, points, bare, bare, grid, logs, piece, noise, prior, ROUNDS
    )  # fmt: skip
    top = climbed_together(
        kinds, sides, points, load, share, grid, logs, states, noise, prior, ROUNDS, ENOUGH
    )
    return points[0].copy(), top


@compiled_as_is
def piece_states(states: States, labels: Places, own: int, around: States) -> None:
    """Write states in which only one piece's elements are on.

    Parameters
    ----------
    states : ndarray of uint8
        Of the whole image.
    labels : ndarray of int64, the same shape
        Which piece each touched element belongs to.
    own : int
        The piece.
    around : ndarray of uint8
        Written: other pieces' elements are unknown next to the piece's own, off elsewhere.
    """
    rows, cols = states.shape
    for i in range(rows):
        for j in range(cols):
            around[i, j] = states[i, j]
            if states[i, j] != 1 or labels[i, j] == own:
                continue
            near = False
            for y in range(max(i - 1, 0), min(i + 2, rows)):
                for x in range(max(j - 1, 0), min(j + 2, cols)):
                    near = near or (states[y, x] == 1 and labels[y, x] == own)
            around[i, j] = 2 if near else 0
