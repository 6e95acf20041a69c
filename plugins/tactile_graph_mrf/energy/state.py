"""``State``: labels and lines as restorers change them: where they start, what is given back."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_mrf.energy.line_field import LineField, Restored, no_lines
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.total import energy


class State(NamedTuple):
    """Labels and lines.

    Parameters
    ----------
    labels : ndarray of int64, shape (rows, columns)
        0 off the field.
    across, down : ndarray of bool, shape (rows - 1, columns) and (rows, columns - 1)
        Horizontal and vertical lines as in `LineField`; off where there is no site.
    """

    labels: NDArray[np.int64]
    across: NDArray[np.bool_]
    down: NDArray[np.bool_]


class Sites(NamedTuple):
    """A state as kernels visit it, site by site; they write into it.

    Parameters
    ----------
    labels : ndarray of int64, shape (rows, columns)
    lines : ndarray of bool, shape (M,)
        All lines in a row, as `Layout` counts them.
    across, down : ndarray of bool
        The same lines as grids: views of ``lines``.
    codes : ndarray of int64, shape ((rows - 1) (columns - 1),)
        The pattern of lines on at each corner, as `pattern_costs` has it.
    """

    labels: NDArray[np.int64]
    lines: NDArray[np.bool_]
    across: NDArray[np.bool_]
    down: NDArray[np.bool_]
    codes: NDArray[np.int64]


def sites_of(state: State) -> Sites:
    """Return a state as sites; the labels are the state's own, the lines copies."""
    _, across, down = state
    lines = np.concatenate([across.reshape(-1), down.reshape(-1)])
    n = across.size
    across, down = lines[:n].reshape(across.shape), lines[n:].reshape(down.shape)
    codes = 1 * down[:-1] + 2 * down[1:] + 4 * across[:, :-1] + 8 * across[:, 1:]
    return Sites(state.labels, lines, across, down, codes.reshape(-1))


def random_state(problem: Problem, rng: np.random.Generator) -> State:
    """Return X(0) of section 5.2.3: any label, and any line where lines are explicit."""
    labels = rng.integers(0, problem.n_levels, problem.shape)
    state = State(np.where(problem.in_field, labels, 0), *no_lines(problem.shape))
    if problem.model.lines == "explicit":
        for lines, sites in zip(state[1:], problem.sites, strict=True):
            lines[...] = sites & (rng.random(lines.shape) < 0.5)
    return state


def observed_state(problem: Problem) -> State:
    """Return the observations, with those lines on that pay by themselves."""
    return with_lines(problem, np.where(problem.in_field, problem.start(), 0))


def with_lines(problem: Problem, labels: NDArray[np.int64]) -> State:
    """Return labels with those lines on that pay by themselves, if lines are explicit."""
    explicit = problem.model.lines == "explicit"
    return State(labels, *(problem.lines_of(labels) if explicit else no_lines(problem.shape)))


def minimised(
    problem: Problem, minimise: Callable[[Problem], tuple[State, list[float]]]
) -> Restored:
    """Return what a restorer gives: the state it ends with, and its trace of energies.

    What leaves nothing to restore is given back as it is, with no line on.
    """
    if problem.idle:
        return outcome(problem, nothing(problem), [])
    return outcome(problem, *minimise(problem))


def nothing(problem: Problem) -> State:
    """Return the state of an image that leaves nothing to restore."""
    return State(np.zeros(problem.shape, np.int64), *no_lines(problem.shape))


def outcome(problem: Problem, state: State, trace: list[float]) -> Restored:
    """Return labels and lines as images and lines on the pad, with their energy."""
    across, down = state.across, state.down
    if problem.model.lines == "marginal":
        across, down = problem.lines_of(state.labels)
    return Restored(
        problem.restored(state.labels),
        LineField.of(problem.image, across, down),
        energy(problem, state.labels, across, down),
        tuple(trace),
        len(trace),
    )
