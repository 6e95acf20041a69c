"""The turn-on is where readings begin above a gap; where they come on slowly there is none."""

import numpy as np
import pytest

from tactile_graph_pads.learning.turn_on import turn_on_of


def loads(n=4000, seed=0):
    return 25.0 * np.exp(0.8 * np.random.default_rng(seed).standard_normal(n))


@pytest.mark.parametrize("turn_on", [5.0, 12.0, 30.0])
def test_where_readings_begin_is_found(turn_on):
    seen = loads()
    found = turn_on_of(seen[seen >= turn_on], 0.5, "gram")
    assert found is not None
    assert found.reading == pytest.approx(turn_on, rel=0.05)
    assert found.of == "gram"


def test_it_is_found_close_to_the_noise_and_under_some_strays():
    seen = loads()
    rng = np.random.default_rng(1)
    seen = np.concatenate([seen[seen >= 10.0], rng.uniform(6.0, 10.0, 8)])
    found = turn_on_of(seen, 6.0, "gram")
    assert found is not None
    assert found.reading == pytest.approx(10.0, rel=0.1)


def test_none_is_told_where_readings_run_into_the_noise_or_are_few():
    assert turn_on_of(loads(), 0.5, "gram") is None
    seen = loads()
    assert turn_on_of(seen[seen >= 12.0], 11.5, "raw") is None
    assert turn_on_of(loads(40) + 20.0, 0.5, "gram") is None
