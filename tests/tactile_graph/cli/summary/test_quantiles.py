"""Numbers in any amount: exact while they are few, near by rank however many and in any order."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.cli.summary.quantiles import EXACT, Numbers

SHARES = (0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0)


def of(values: np.ndarray, chunk: int) -> Numbers:
    found = Numbers()
    for start in range(0, values.size, chunk):
        found.add(values[start : start + chunk])
    return found


def test_few_numbers_have_their_exact_quantiles() -> None:
    values = np.random.default_rng(1).normal(size=EXACT)
    found = of(values, 100)
    assert np.array_equal(found.quantiles(SHARES), np.quantile(values, SHARES))
    assert found.mean == pytest.approx(values.mean())


@pytest.mark.parametrize("order", ["as drawn", "rising", "falling", "in two heaps"])
@pytest.mark.parametrize("law", ["normal", "heavy tails", "few values"])
def test_many_numbers_have_quantiles_near_by_rank(order: str, law: str) -> None:
    rng = np.random.default_rng(2)
    draw = {
        "normal": lambda: rng.normal(size=30_000),
        "heavy tails": lambda: rng.standard_cauchy(30_000),
        "few values": lambda: rng.integers(0, 5, 30_000).astype(float),
    }
    values = draw[law]()
    values = {"rising": np.sort, "falling": lambda v: np.sort(v)[::-1],
              "in two heaps": lambda v: np.concatenate([np.sort(v)[::2], np.sort(v)[1::2]]),
              "as drawn": lambda v: v}[order](values)  # fmt: skip
    found = of(values, 3000)
    ordered = np.sort(values)
    for share, value in zip(SHARES, found.quantiles(SHARES), strict=True):
        low = np.searchsorted(ordered, value - 1e-9) / values.size
        high = np.searchsorted(ordered, value + 1e-9, "right") / values.size
        # Between two of a few values a mean of both may stand: that is no rank's fault.
        assert low - 0.005 <= share <= high + 0.005
    assert (found.least, found.most, found.n) == (values.min(), values.max(), values.size)


@pytest.mark.parametrize(
    "sizes", [(100, 300), (20_000, 300), (300, 20_000), (9000, 20_000), (0, 9)]
)
def test_numbers_of_two_kinds_come_to_what_they_do_together(sizes: tuple[int, int]) -> None:
    rng = np.random.default_rng(4)
    values = [rng.normal(2.0 * k, 1.0, n) for k, n in enumerate(sizes)]
    found, other = of(values[0], 1000), of(values[1], 1000)
    found.take(other)
    found.add([np.nan])
    both = np.sort(np.concatenate(values))
    assert (found.n, found.n_not_finite, found.least, found.most) == (
        both.size, 1, both[0], both[-1]
    )  # fmt: skip
    assert found.mean == pytest.approx(both.mean())
    for share, value in zip(SHARES[1:-1], found.quantiles(SHARES[1:-1]), strict=True):
        assert abs(np.searchsorted(both, value) / both.size - share) < 0.006 + 1.0 / both.size


def test_compressed_numbers_stay_near_and_take_more() -> None:
    rng = np.random.default_rng(3)
    first, second = rng.normal(size=2000), rng.normal(3.0, size=2000)
    found = of(first, 500)
    found.compress()
    found.add(second)
    both = np.sort(np.concatenate([first, second]))
    for share, value in zip(SHARES, found.quantiles(SHARES), strict=True):
        assert abs(np.searchsorted(both, value) / both.size - share) < 0.012


def test_what_is_no_number_is_counted_alone_and_nothing_has_no_quantile() -> None:
    found = of(np.array([1.0, np.inf, np.nan, 3.0]), 4)
    assert (found.n, found.n_not_finite, found.mean) == (2, 2, 2.0)
    assert np.isnan(Numbers().quantiles(0.5))
    assert np.isnan(Numbers().mean)
