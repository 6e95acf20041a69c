"""Pairs are most in number, then least in sum, as an exhaustive search finds them."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from tactile_graph_compare.score.pairing import paired


@pytest.mark.parametrize("seed", range(40))
def test_pairs_are_as_many_as_can_be_within_the_gate_and_then_the_nearest(seed):
    rng = np.random.default_rng(seed)
    n_true, n_found = map(int, rng.integers(0, 5, 2))
    off = rng.uniform(0, 4, (n_true, n_found))
    pairs = paired(off, 2.0)
    got = (len(pairs), -sum(off[i, j] for i, j in pairs))
    assert all(off[i, j] <= 2.0 for i, j in pairs)
    assert len({j for _, j in pairs}) == len({i for i, _ in pairs}) == len(pairs)
    places = [*range(n_found), *[None] * n_true]
    best = max(
        (len(kept), -sum(off[i, j] for i, j in kept))
        for chosen in permutations(places, n_true)
        if (kept := [(i, j) for i, j in enumerate(chosen) if j is not None and off[i, j] <= 2.0])
        is not None
    )
    assert got == pytest.approx(best)
