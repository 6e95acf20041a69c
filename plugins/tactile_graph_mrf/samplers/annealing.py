"""Run the sweeps of a sampler over a prepared problem and give the outcome all restorers share."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.line_field import LineField, Restored, no_lines
from tactile_graph_mrf.energy.model import Problem, energy, terms
from tactile_graph_mrf.samplers.sweep import anneal
from tactile_graph_mrf.samplers.visits import fit_for

BLOCK = 1 << 20
"""Uniform numbers drawn at once at most, unless one sweep takes more."""


class State(NamedTuple):
    """Labels and lines that sweeps write into."""

    labels: NDArray[np.int64]
    across: NDArray[np.bool_]
    down: NDArray[np.bool_]


def random_state(problem: Problem, rng: np.random.Generator) -> State:
    """Return X(0) of section 5.2.3: any label, and any line where lines are explicit."""
    labels = rng.integers(0, problem.n_levels, problem.shape)
    state = State(np.where(problem.in_field, labels, 0), *no_lines(problem.shape))
    if problem.model.lines == "explicit":
        for lines, sites in zip(state[1:], problem.sites(), strict=True):
            lines[...] = sites & (rng.random(lines.shape) < 0.5)
    return state


def observed_state(problem: Problem) -> State:
    """Return the observations, with those lines on that pay by themselves."""
    state = State(np.where(problem.in_field, problem.start(), 0), *no_lines(problem.shape))
    if problem.model.lines == "explicit":
        for lines, sites in zip(state[1:], problem.lines_of(state.labels), strict=True):
            lines[...] = sites
    return state


def kernel_terms(problem: Problem) -> tuple[object, ...]:
    """Return what `anneal` takes before the tables of `layout`."""
    marginal = problem.model.lines == "marginal"
    price = problem.model.line_price if marginal else -1.0
    return (*terms(problem), problem.bare_smooth, price, problem.gaussian)


def run(
    problem: Problem,
    state: State,
    betas: NDArray[np.float64],
    rng: np.random.Generator | None,
) -> list[float]:
    """Sweep at each inverse temperature in turn; write into ``state``, return the energies.

    Stops early when nothing can change any more; ``betas`` must not fall. Without ``rng`` all
    must be infinite. Numbers are drawn block by block, in the order of the visits.
    """
    tables = layout(problem)
    visits = len(tables.cells) + len(tables.sites)
    kernel = fit_for(anneal, visits * len(betas) * problem.levels_per_draw)
    fixed = kernel_terms(problem)
    per_block = max(1, BLOCK // max(visits, 1))
    lines, across, down = in_one(state)
    trace: list[float] = []
    for start in range(0, len(betas), per_block):
        block = np.ascontiguousarray(betas[start : start + per_block])
        shape = (len(block), visits)
        uniforms = np.zeros(shape) if rng is None else rng.random(shape)
        energies = np.empty(len(block))
        now = (state.labels, lines, across, down, energies)
        done, frozen = kernel(*fixed, *tables, block, uniforms, *now)
        trace += energies[:done].tolist()
        if frozen:
            break
    state.across[...], state.down[...] = across, down
    return trace


def in_one(state: State) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """Return all lines of a state in a row, and its horizontal and vertical part as grids."""
    lines = np.concatenate([state.across.reshape(-1), state.down.reshape(-1)])
    n = state.across.size
    return lines, lines[:n].reshape(state.across.shape), lines[n:].reshape(state.down.shape)


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


def unswept(problem: Problem) -> Restored:
    """Return an image that leaves nothing to restore as it is, with no line on."""
    state = State(np.zeros(problem.shape, np.int64), *no_lines(problem.shape))
    return outcome(problem, state, [])
