import itertools
import sys

import numpy as np
import pytest

from helpers_modes import plainly
from helpers_restorers import never_rises, square, tiny, tiny_model
from tactile_graph.errors import DataError
from tactile_graph_mrf.descent.graph_cuts import graph_cuts
from tactile_graph_mrf.descent.swap_moves import Bonds, swap_cycle
from tactile_graph_mrf.descent.trw import trw
from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.potentials import Unary
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy


def model(kind, **changes):
    return Model(
        **{"n_levels": 20, "smoothness": kind, "truncation": 4.0, "lines": "none", **changes}
    )


def test_moves_that_no_cut_can_find_are_refused_with_those_that_fit():
    pytest.importorskip("maxflow")
    with pytest.raises(ValueError, match=r"'expansion' is not submodular .* take swap"):
        graph_cuts(square(), model=model("truncated_quadratic"), moves="expansion")
    with pytest.raises(ValueError, match=r"'jump' is not submodular .*, with lines, so"):
        graph_cuts(
            square(), model=model("quadratic", lines="marginal", lambda_l=10.0), moves="jump"
        )
    with pytest.raises(ValueError, match=r"'expansion' is not submodular .* take jump or swap"):
        graph_cuts(square(), model=model("quadratic"), moves="expansion")


@pytest.mark.slow
def test_jumps_end_at_the_least_energy_of_a_convex_model():
    pytest.importorskip("maxflow")
    for kind in ("quadratic", "absolute", "huber"):
        reached = graph_cuts(square(20.0, 8), model=model(kind, lambda_d=2.0))
        proof = trw(square(20.0, 8), model=model(kind, lambda_d=2.0), n_sweeps=100)
        assert reached.energy <= proof.energy + 1e-9
        assert reached.energy == pytest.approx(proof.bound, rel=1e-4)


@pytest.mark.parametrize(
    ("kind", "moves"),
    [("truncated_absolute", "expansion"), ("truncated_quadratic", "swap"), ("huber", "jump")],
)
@pytest.mark.slow
def test_no_cycle_of_moves_raises_the_energy(kind, moves):
    pytest.importorskip("maxflow")
    restored = graph_cuts(square(20.0, 8), model=model(kind, lambda_d=3.0), moves=moves)
    assert never_rises(restored.trace)
    assert restored.trace[-1] < restored.trace[0]


@pytest.mark.parametrize("order", [2, 3])
def test_far_pairs_are_cut_too(order):
    pytest.importorskip("maxflow")
    restored = graph_cuts(square(20.0, 8), model=model("absolute", order=order, lambda_d=3.0))
    assert never_rises(restored.trace)


def test_a_missing_library_is_named_with_its_remedy(monkeypatch):
    monkeypatch.setitem(sys.modules, "maxflow", None)
    with pytest.raises(DataError, match=r"needs PyMaxflow: .*tactile-graph\[graphcut\]"):
        graph_cuts(square(), model=model("absolute"))


@pytest.mark.slow
def test_swaps_need_no_library(monkeypatch):
    monkeypatch.setitem(sys.modules, "maxflow", None)
    restored = graph_cuts(square(20.0, 8), model=model("truncated_quadratic", lambda_d=3.0))
    assert restored.trace[-1] < restored.trace[0]


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("seed", range(4))
def test_after_swaps_no_trade_of_two_labels_lowers_the_energy(order, seed):
    """Against every way to share out two labels among the cells that have them."""
    chosen = tiny_model(smoothness="truncated_quadratic", order=order)
    problem = prepare(chosen, tiny(seed))
    restored = graph_cuts(tiny(seed), model=chosen, moves="swap", n_cycles=50)
    labels = np.rint((restored.image.values - problem.low) / problem.step).astype(np.int64)
    for alpha, beta in itertools.combinations(np.unique(labels).tolist(), 2):
        cells = np.flatnonzero(np.isin(labels, (alpha, beta)))
        for choice in itertools.product((alpha, beta), repeat=len(cells)):
            traded = labels.copy()
            traded.ravel()[cells] = choice
            assert energy(problem, traded) >= restored.energy - 1e-9


@pytest.mark.slow
def test_a_cycle_of_swaps_is_the_same_compiled():
    pytest.importorskip("numba")
    problem = prepare(model("truncated_quadratic", lambda_d=3.0), square(20.0, 8))
    unary = Unary(*(x.ravel() if x.shape == (8, 8) else x for x in problem.unary))
    bonds = Bonds(problem.pairwise.smooth, problem.pairwise.weights)
    ends = []
    for kernel in (plainly(swap_cycle), swap_cycle.compiled):
        labels = problem.start().ravel().copy()
        kernel(unary, bonds, layout(problem), labels)
        ends.append(labels)
    assert np.array_equal(*ends)
    assert energy(problem, ends[0].reshape(8, 8)) < energy(problem, problem.start())
