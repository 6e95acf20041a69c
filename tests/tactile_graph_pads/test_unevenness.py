"""Bumps, valleys and voids have the spread and the reach they are given."""

import numpy as np
import pytest

from tactile_graph_pads.geometry import Geometry
from tactile_graph_pads.unevenness import Bump, Unevenness

BIG = Geometry(120, 120)


def gains(uneven, geometry=BIG, seed=0):
    rng = np.random.default_rng(seed)
    return uneven.gains(uneven.draw(geometry, rng), uneven.draw(geometry, rng))


@pytest.mark.parametrize("fixed", [0.0, 0.5, 1.0])
def test_the_logarithm_of_the_gain_spreads_by_sigma(fixed):
    logs = np.log(gains(Unevenness(sigma=0.5, fixed=fixed)))
    assert logs.std() == pytest.approx(0.5, rel=0.03)
    assert logs.mean() == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize(("voids", "correlation_cm"), [(0.1, 0.0), (0.3, 0.0), (0.2, 2.0)])
def test_the_share_of_voids_is_as_asked(voids, correlation_cm):
    got = gains(Unevenness(sigma=0.5, voids=voids, correlation_cm=correlation_cm))
    assert (got == 0.0).mean() == pytest.approx(voids, abs=0.02)


def test_no_voids_and_only_voids_are_exact():
    assert (gains(Unevenness(voids=0.0)) == 1.0).all()
    assert (gains(Unevenness(voids=1.0)) == 0.0).all()


def test_neighbours_are_alike_within_the_correlation_length():
    logs = np.log(gains(Unevenness(sigma=1.0, correlation_cm=2.6)))
    at_two = np.corrcoef(logs[:, :-2].ravel(), logs[:, 2:].ravel())[0, 1]
    assert at_two == pytest.approx(np.exp(-0.5), abs=0.08)
    assert logs.std() == pytest.approx(1.0, rel=0.1)
    alone = np.log(gains(Unevenness(sigma=1.0)))
    assert abs(np.corrcoef(alone[:, :-1].ravel(), alone[:, 1:].ravel())[0, 1]) < 0.03


def test_what_is_fixed_stays_from_placement_to_placement():
    rng = np.random.default_rng(0)
    for fixed, low, high in ((1.0, 0.999, 1.001), (0.5, 0.45, 0.55), (0.0, -0.05, 0.05)):
        uneven = Unevenness(sigma=0.5, fixed=fixed)
        of_pad = uneven.draw(BIG, rng)
        one, other = (np.log(uneven.gains(of_pad, uneven.draw(BIG, rng))) for _ in range(2))
        assert low < np.corrcoef(one.ravel(), other.ravel())[0, 1] < high


def test_a_known_bump_stands_out():
    got = gains(Unevenness(bumps=(Bump(3, 4, 8.0), Bump(5, 5, 0.0))), Geometry())
    assert got[3, 4] == 8.0
    assert got[5, 5] == 0.0
    assert got.sum() == 254.0 + 8.0


def test_strays_lie_where_nothing_covers_and_are_as_many_as_asked():
    covered = np.zeros(BIG.shape)
    covered[:40] = 0.3
    got = Unevenness(strays=0.05, stray_g=12.0).strays_g(covered, np.random.default_rng(0))
    assert (got[:40] == 0.0).all()
    assert set(np.unique(got)) == {0.0, 12.0}
    assert (got[40:] > 0.0).mean() == pytest.approx(0.05, abs=0.01)
    assert not Unevenness().strays_g(covered, np.random.default_rng(0)).any()
