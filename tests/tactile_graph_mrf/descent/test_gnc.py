import numpy as np
import pytest

from helpers_restorers import square
from tactile_graph.wires import Image
from tactile_graph_mrf.descent.gnc import gnc
from tactile_graph_mrf.descent.graduate import _relax_plain, colours, graduated, influence, relax
from tactile_graph_mrf.energy.model import Model


def test_the_graduated_cost_of_a_truncated_parabola_is_blake_and_zissermans():
    """Parabola to q, concave of curvature c to r, flat beyond; r² = cap (2 / c + 1 / lambda)."""
    model = Model(smoothness="truncated_quadratic", lines="none", n_levels=400)
    lam, cap = 4.0, 3600.0
    for k, weights in enumerate(influence(model, 8, 2.0)):
        c = 0.25 * 2.0**k
        r = np.sqrt(cap * (2.0 / c + 1.0 / lam))
        q = cap / (lam * r)
        d = np.arange(1.0, 399.0)
        wanted = np.where(d < q, lam, np.where(d < r, c * (r - d) / (2.0 * d), 0.0))
        inner = (np.abs(d - q) > 1.5) & (np.abs(d - r) > 1.5)
        np.testing.assert_allclose(weights[1:-2][inner], wanted[inner], atol=0.05, err_msg=f"{k}")


def test_a_convex_smoothness_is_not_graduated():
    stages = influence(Model(lines="none"), 5, 2.0)
    np.testing.assert_allclose(stages[:, 1:-2], 4.0)


def test_each_graduation_is_an_energy_of_the_trace():
    restored = gnc(square(), model=Model(lines="marginal"), n_steps=7)
    assert len(restored.trace) == 7
    assert restored.energy == pytest.approx(min(restored.trace))


def test_steps_stay_sharp_and_noise_goes():
    """A square of 120 levels under noise of 10: few levels are left between its two sides."""
    restored = gnc(square(10.0), model=Model(lines="marginal")).image.values
    truth = np.full((16, 16), 40.0)
    truth[4:12, 4:12] = 160.0
    assert np.sqrt(np.mean((restored - truth) ** 2)) < 4.5


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("noise", ["gaussian", "student_t"])
def test_relaxation_is_the_same_compiled_and_plain(order, noise):
    pytest.importorskip("numba")
    model = Model(noise=noise, order=order, lines="marginal")
    valid = np.ones((6, 7), bool)
    valid[2, 3] = False
    values = np.where(valid, np.random.default_rng(0).integers(0, 200, (6, 7)).astype(float), 0.0)
    p = model.prepare(Image(values, valid=valid))
    results = []
    for kernel in (_relax_plain, relax.compiled):
        levels, out = p.observed.copy(), np.empty((4, 6, 7))
        kernel(
            *(p.in_field, p.curvature, p.centre, p.table, p.row, p.observed),
            *(influence(model, 4, 2.0), p.offsets, p.weights, colours(order), 6, 1.5),
            *(0.1, levels, out),
        )
        results.append(out)
    np.testing.assert_allclose(results[0], results[1], rtol=1e-9, atol=1e-9)


def test_cells_at_rest_are_left_out_and_little_is_lost_by_it():
    pytest.importorskip("numba")
    problem = Model(smoothness="truncated_quadratic", lines="none").prepare(square(20.0))
    bends = influence(problem.model, 12, 1.5)
    thorough = graduated(problem, bends, 400, 1.6, 0.0)[-1]
    assert np.abs(graduated(problem, bends, 400, 1.6)[-1] - thorough).max() < 0.02
    assert np.abs(graduated(problem, bends, 400, 1.6, 5e-4)[-1] - thorough).mean() < 0.2
