import sys

import pytest

from helpers_restorers import never_rises, square
from tactile_graph.errors import DataError
from tactile_graph_mrf.graph_cuts import graph_cuts
from tactile_graph_mrf.model import Model
from tactile_graph_mrf.trw import trw


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
    with pytest.raises(DataError, match=r"needs PyMaxflow, .*tactile-graph\[graphcut\]"):
        graph_cuts(square(), model=model("absolute"))
