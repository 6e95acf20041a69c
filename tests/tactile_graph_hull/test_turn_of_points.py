"""The exact predicate, twin and plain, against fractions."""

import numpy as np
import pytest

from helpers_hulls import exact_turn
from tactile_graph_hull.turn_of_points import sign_of_sum, turn

FORMS = [turn.reference, turn.compiled]
form = pytest.mark.parametrize("form", FORMS, ids=["plain", "compiled"][: len(FORMS)])


@form
def test_turns_as_seen_have_the_sign_of_their_sense(form):
    """y runs down: from (0, 0) right to (1, 0), then up to (1, -1) is counter-clockwise."""
    assert form(0.0, 0.0, 1.0, 0.0, 1.0, -1.0) == 1
    assert form(0.0, 0.0, 1.0, 0.0, 1.0, 1.0) == -1
    assert form(0.0, 0.0, 1.0, 0.0, 7.0, 0.0) == 0
    assert form(2.0, 3.0, 2.0, 3.0, 2.0, 3.0) == 0


@form
def test_neighbouring_doubles_on_the_diagonal_are_told_apart(form):
    """Kettner et al. 2008: there plain floating point errs in patterns."""
    for i in range(24):
        for k in range(24):
            a = (0.5 + i * 2.0**-53, 0.5 + k * 2.0**-53)
            assert form(*a, 12.0, 12.0, 24.0, 24.0) == exact_turn(a, (12.0, 12.0), (24.0, 24.0))


@pytest.mark.slow
@form
def test_nearly_and_exactly_collinear_triples_are_exact(form):
    rng = np.random.default_rng(5)
    for _ in range(3000):
        a, step = rng.random(2) * 10.0 ** rng.uniform(-6, 6), rng.standard_normal(2)
        s, t = rng.integers(-9, 9, 2) * 0.1
        triple = [a, a + s * step, a + t * step]
        if rng.random() < 0.3:  # on x = y exactly, with differences that are not
            triple = [np.full(2, p[0]) for p in triple]
        a, b, c = ([float(v) for v in p] for p in triple)
        assert form(*a, *b, *c) == exact_turn(a, b, c)


@form
@pytest.mark.parametrize("power", [-420, -300, 300, 470])
def test_sizes_near_the_ends_of_the_range_are_exact(form, power):
    rng = np.random.default_rng(power % 97)
    for _ in range(200):
        x = rng.random(3) * 2.0**power
        a, b, c = ([float(v), float(np.nextafter(v, np.inf))] for v in x)
        assert form(*a, *b, *c) == exact_turn(a, b, c)


def test_plain_form_is_exact_beyond_all_range():
    assert turn.reference(0.0, 0.0, 5e-324, 5e-324, 1e-323, 5e-324) == 1
    assert turn.reference(-1.7e308, 0.0, 1.7e308, 0.0, 0.0, 5e-324) == -1


def test_sign_of_a_sum_is_exact_where_floats_cancel():
    assert sign_of_sum.reference(np.array([1e100, 1.0, -1e100, 1e-100, -1.0])) == 1
    assert sign_of_sum.reference(np.array([1e16, 1.0, -1e16, -1.0])) == 0
    assert sign_of_sum.reference(np.array([-1e30, 1e30, -1e-30])) == -1
