import numpy as np
import pytest

from helpers_modes import answered_by
from helpers_restorers import square
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.gnc import gnc
from tactile_graph_mrf.descent.graduate import (
    Relaxation,
    graduated,
    influence,
    round_all,
    rounded,
    rounded_energies,
)
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy

pytestmark = pytest.mark.slow


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


@pytest.mark.parametrize("lines", ["none", "explicit", "marginal"])
def test_the_energies_of_graduations_are_those_of_their_roundings(lines, monkeypatch):
    valid = np.ones((6, 7), bool)
    valid[2, 3] = False
    values = np.random.default_rng(0).integers(0, 200, (6, 7)).astype(float)
    region = Mask(np.arange(42).reshape(6, 7) > 8)
    problem = prepare(Model(lines=lines), Image(values, valid=valid), region)
    stages = graduated(problem, influence(problem.model, 6, 2.0), Relaxation(6, 1.5))
    wanted = [energy(problem, *rounded(problem, levels)) for levels in stages]
    for code in (round_all.reference, round_all.compiled):
        monkeypatch.setattr(round_all, "call", code)
        assert rounded_energies(problem, stages) == wanted


def test_steps_stay_sharp_and_noise_goes():
    """A square of 120 levels under noise of 10: few levels are left between its two sides."""
    restored = gnc(square(10.0), model=Model(lines="marginal")).image.values
    truth = np.full((16, 16), 40.0)
    truth[4:12, 4:12] = 160.0
    assert np.sqrt(np.mean((restored - truth) ** 2)) < 4.5


def relaxed_all_at_once(problem, influences, relaxation):
    """The levels after the sweeps with each row of ``influences``, a colour at a time.

    Each cell goes ``over`` times the way to the minimum of the parabola that touches its
    conditional energy from above (half-quadratic majorisation).
    """
    in_field, curvature, centre, table, row = problem.unary
    _, _, _, offsets, weights = problem.pairwise
    observed, levels = problem.observed, problem.observed.copy()
    sweeps, over, still = relaxation
    n_colours = 2 if problem.model.order == 1 else 9
    levels[~problem.has_data] = levels[problem.has_data].mean()
    out = np.empty((len(influences), *levels.shape))
    rows, columns = levels.shape
    i, j = np.indices(levels.shape)
    colour = (i + j) % 2 if n_colours == 2 else i % 3 * 3 + j % 3
    inside = np.pad(in_field, 2)
    top = table.shape[1] - 1
    still = still * top
    for k, influence_k in enumerate(influences):
        awake = in_field.copy()
        for c in [c for _ in range(sweeps) for c in range(n_colours)]:
            if awake.any():
                own = curvature + own_weight(levels, observed, table, row)
                pull, mass = own * (np.where(curvature > 0, centre, observed) - levels), own
                padded = np.pad(levels, 2)
                for (di, dj), weight in zip(offsets.tolist(), weights.tolist(), strict=True):
                    for m, n in ((2 + di, 2 + dj), (2 - di, 2 - dj)):
                        window = np.s_[m : m + rows, n : n + columns]
                        step = padded[window] - levels
                        bend = weight * bent(influence_k, np.abs(step))
                        w = np.where(inside[window], bend, 0.0)
                        pull, mass = pull + w * step, mass + w
                visited = awake & (colour == c)
                moved = visited & (mass > 0)
                np.divide(over * pull, mass, out=pull, where=moved)
                after = np.where(moved, np.clip(levels + pull, 0.0, top), levels)
                far = np.pad(np.abs(after - levels) >= still, 2)
                levels[...] = after
                awake[visited] = False
                for di, dj in [(0, 0), *offsets.tolist(), *(-offsets).tolist()]:
                    awake |= far[2 + di : 2 + di + rows, 2 + dj : 2 + dj + columns]
                awake &= in_field
        out[k] = levels
    return out


def bent(influence, d):
    d = np.minimum(d, len(influence) - 2)
    whole = d.astype(np.int64)
    low, high = influence[whole], influence[whole + 1]
    return np.asarray(low + (d - whole) * (high - low))


def own_weight(levels, observed, table, row):
    top = table.shape[1] - 1
    x = np.clip(np.rint(levels), 1, top - 1).astype(np.int64) if top > 1 else row * 0
    away = levels - observed
    slope = 0.5 * (table[row, np.minimum(x + 1, top)] - table[row, np.maximum(x - 1, 0)])
    near = np.abs(away) < 1.0
    return np.where(row > 0, np.abs(slope) / (2.0 * np.where(near, 1.0, np.abs(away))), 0.0)


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("noise", ["gaussian", "student_t"])
def test_cell_by_cell_is_as_all_cells_of_a_colour_at_once(order, noise):
    pytest.importorskip("numba")
    model = Model(noise=noise, order=order, lines="marginal")
    valid = np.ones((6, 7), bool)
    valid[2, 3] = False
    values = np.where(valid, np.random.default_rng(0).integers(0, 200, (6, 7)).astype(float), 0.0)
    p = prepare(model, Image(values, valid=valid))
    bends, relaxation = influence(model, 4, 2.0), Relaxation(6, 1.5, 0.1 / 199)
    wanted = relaxed_all_at_once(p, bends, relaxation)
    for mode in ("plain", "compiled"):
        with answered_by(mode):
            found = graduated(p, bends, relaxation)
        np.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-9)


def test_cells_at_rest_are_left_out_and_little_is_lost_by_it():
    pytest.importorskip("numba")
    problem = prepare(Model(smoothness="truncated_quadratic", lines="none"), square(20.0))
    bends = influence(problem.model, 12, 1.5)
    thorough = graduated(problem, bends, Relaxation(400, 1.6, 0.0))[-1]
    assert np.abs(graduated(problem, bends, Relaxation(400, 1.6))[-1] - thorough).max() < 0.02
    assert np.abs(graduated(problem, bends, Relaxation(400, 1.6, 5e-4))[-1] - thorough).mean() < 0.2


def test_beyond_both_ends_of_the_scale_the_influence_is_that_of_the_ends():
    table = influence(Model(n_levels=12, lambda_d=1.0, lines="none"), 3, 2.0)
    assert table.shape == (3, 13)
    np.testing.assert_allclose(table[:, 1:11], 1.0)  # 2 d / 2 d, but for the last, one-sided step
    np.testing.assert_array_equal(table[:, 0], table[:, 1])
    np.testing.assert_array_equal(table[:, -1], table[:, -2])
    assert (table[:, -1] < 1.0).all()


def test_without_a_sweep_levels_are_the_data_and_their_mean_where_there_are_none():
    valid = np.ones((4, 5), bool)
    valid[2, 3] = valid[0, 0] = False
    values = np.random.default_rng(0).integers(0, 200, (4, 5)).astype(float)
    for known in (valid, np.ones_like(valid)):
        problem = prepare(Model(lines="none"), Image(values, valid=known))
        (start,) = graduated(problem, influence(problem.model, 1, 2.0), Relaxation(0, 1.5))
        mean = problem.observed[known].mean()
        assert start == pytest.approx(np.where(known, problem.observed, mean))
