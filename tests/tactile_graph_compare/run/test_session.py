"""Orders of variants are balanced: that is what makes their times comparable."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest

from tactile_graph_compare.run.session import balanced_orders


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 6, 7])
def test_each_comes_at_each_place_and_behind_each_other_equally_often(n: int) -> None:
    rows = balanced_orders(n, 100)
    assert all(sorted(row) == list(range(n)) for row in rows)
    places = Counter((place, k) for row in rows for place, k in enumerate(row))
    assert len(places) == n * n
    assert len(set(places.values())) == 1
    behind = Counter(pair for row in rows for pair in pairwise(row))
    assert len(behind) == n * (n - 1)
    assert len(set(behind.values())) <= 1


def test_of_many_variants_eight_different_ones_come_first() -> None:
    assert len({row[0] for row in balanced_orders(20, 8)}) == 8
