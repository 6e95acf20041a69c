"""Iterated conditional modes: what is tied stays as it is."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_mrf.descent.modes import settle
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.state import State
from tactile_graph_mrf.energy.total import energy


@pytest.mark.slow
@pytest.mark.parametrize("label", range(4))
def test_a_label_that_costs_no_more_than_others_stays(label):
    """Between 0 and 3 all labels cost the same, if the cell itself has no datum."""
    model = Model(n_levels=4, noise="laplace", smoothness="absolute", lambda_d=1.0, lines="none")
    problem = prepare(model, Image(np.array([[0.0, np.nan, 3.0]])))
    state = State(np.array([[0, label, 3]]), np.zeros((0, 3), bool), np.zeros((1, 2), bool))
    assert len(settle(problem, state, 5)) == 1
    assert state.labels.tolist() == [[0, label, 3]]


@pytest.mark.slow
@pytest.mark.parametrize("on", [False, True])
def test_a_line_that_costs_nothing_stays(on):
    model = Model(n_levels=4, lambda_d=0.0, lambda_l=0.0)
    problem = prepare(model, Image(np.array([[0.0, 1.0, 3.0]])))
    state = State(np.array([[0, 1, 3]]), np.zeros((0, 3), bool), np.array([[on, not on]]))
    settle(problem, state, 5)
    assert state.down.tolist() == [[on, not on]]


@pytest.mark.usefixtures("plain_kernels")
def test_cheaper_labels_are_taken_whatever_the_start():
    model = Model(n_levels=4, noise="laplace", lambda_d=0.0, lines="none")
    problem = prepare(model, Image(np.array([[0.0, 1.0, 3.0]])))
    state = State(np.array([[3, 3, 0]]), np.zeros((0, 3), bool), np.zeros((1, 2), bool))
    assert settle(problem, state, 5)[-1] == 0.0
    assert state.labels.tolist() == [[0, 1, 3]]


@pytest.mark.usefixtures("plain_kernels")
def test_no_more_sweeps_are_made_than_asked_for():
    """A label that goes from cell to cell, one more each sweep against the way of visiting."""
    values = np.array([[9.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
    problem = prepare(Model(n_levels=10, lambda_d=3.0, lines="none"), Image(values))
    start = np.array([[0, 9, 9, 9, 9, 9]])
    traces = []
    for most in (1, 2, 3, 50):
        state = State(start.copy(), np.zeros((0, 6), bool), np.zeros((1, 5), bool))
        traces.append(settle(problem, state, most))
        assert len(traces[-1]) <= most
        assert traces[-1][-1] == pytest.approx(energy(problem, *state))
    assert len(traces[3]) > 3
    assert traces[:3] == [traces[3][:k] for k in (1, 2, 3)]
