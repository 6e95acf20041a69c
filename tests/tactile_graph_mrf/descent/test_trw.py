import numpy as np
import pytest

from helpers_modes import plainly
from helpers_restorers import least_energy, square, tiny, tiny_model
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_mrf.descent.tree_bound import Grid, chain_bound, lower_bound, trw_sweep
from tactile_graph_mrf.descent.trw import trw
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare

pytestmark = pytest.mark.slow  # much is compiled, which no shipped pipeline uses


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", ["quadratic", "truncated_quadratic", "geman_mcclure"])
@pytest.mark.parametrize("n_sweeps", [1, 30])
def test_the_bound_is_never_above_the_least_energy_of_all(seed, kind, n_sweeps):
    model = tiny_model(smoothness=kind)
    found = lower_bound(prepare(model, tiny(seed)), n_sweeps)
    least = least_energy(model, seed)
    assert found.bound <= least + 1e-9
    assert found.energy >= least - 1e-9
    if n_sweeps == 30 and kind == "quadratic":  # convex: the relaxation is exact
        assert found.bound == pytest.approx(least, rel=2e-2)


def test_more_sweeps_raise_the_bound():
    problem = prepare(Model(n_levels=30, lines="marginal", truncation=4.0), square(30.0, 8))
    bounds = [lower_bound(problem, n).bound for n in (1, 4, 16)]
    assert bounds == sorted(bounds)
    assert bounds[0] < bounds[-1]


def test_missing_cells_break_no_chain_twice():
    """A hole in the image leaves the bound a bound: at most the energy reached."""
    noisy = square(10.0, 8)
    valid = np.ones(noisy.shape, bool)
    valid[3, :] = False
    image = Image(np.where(valid, noisy.values, 0.0), valid=valid)
    proof = trw(image, model=Model(n_levels=30, lines="marginal", lambda_d=0.0))
    problem = prepare(Model(n_levels=30, lines="marginal", lambda_d=0.0), image)
    assert not problem.in_field[3].any()
    assert proof.bound == pytest.approx(proof.energy)


def test_messages_are_the_same_compiled_and_plain():
    pytest.importorskip("numba")
    problem = prepare(tiny_model(), tiny(1))
    pairwise = problem.pairwise
    grid = Grid(problem.in_field, problem.own_costs(), pairwise.smooth, pairwise.weights, 4)
    kept = []
    for kernels in (plainly, lambda k: k.compiled):
        messages, labels = np.zeros((4, 3, 3, 4)), np.zeros((3, 3), np.int64)
        for forth in (True, False, True):
            kernels(trw_sweep)(grid, forth, messages, labels)
        kept.append((messages, labels, kernels(chain_bound)(grid, messages)))
    np.testing.assert_allclose(kept[0][0], kept[1][0])
    assert np.array_equal(kept[0][1], kept[1][1])
    assert kept[0][2] == pytest.approx(kept[1][2])


def test_explicit_lines_and_higher_orders_are_refused():
    with pytest.raises(ValueError, match="needs order 1 and lines none or marginal, got order 1"):
        trw(square(), model=Model())
    with pytest.raises(ValueError, match="got order 2 and lines none"):
        trw(square(), model=Model(order=2, lines="none"))


def test_what_would_not_fit_is_refused_before_it_is_tried():
    with pytest.raises(Degenerate, match="messages of 65536 cells and 200 levels would not fit"):
        trw(square(size=256))
