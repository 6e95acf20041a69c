"""Values as plain data: in full, and what a line a frame tells of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pytest

from tactile_graph.engine.tables.rows import MOST_NUMBERS, as_data
from tactile_graph.errors import PluginError

BIG = np.zeros((MOST_NUMBERS + 1, 2))


@dataclass
class Fitted:
    """A result without a summary of its own."""

    x_cm: float = 1.0
    covariance: Any = None
    points: Any = None
    _whole: int = 2
    columns_shown: ClassVar[tuple[str, ...]] = ("x_cm", "rms_cm")

    @property
    def rms_cm(self) -> float:
        return 0.5


@dataclass
class Summed:
    """A result with one."""

    points: Any
    told: Any

    def summary(self) -> Any:
        return self.told


class Named(NamedTuple):
    fit: Any
    summary: str


def test_private_fields_of_records_are_not_written():
    assert "_whole" not in as_data(Fitted())


def test_a_record_is_told_by_its_small_fields_its_columns_and_the_shape_of_big_arrays():
    fitted = Fitted(1.0, np.eye(2), BIG)
    assert as_data(fitted, full=False) == {
        "x_cm": 1.0,
        "covariance": [[1.0, 0.0], [0.0, 1.0]],
        "points": {"shape": [MOST_NUMBERS + 1, 2]},
        "rms_cm": 0.5,
    }
    assert as_data(fitted)["points"] == BIG.tolist()


def test_a_record_with_a_summary_of_its_own_is_told_by_it_wherever_it_stands():
    summed = Summed(BIG, {"radius_cm": np.float64(2.0), "points": BIG, "inner": Fitted()})
    told = {
        "radius_cm": 2.0,
        "points": {"shape": [MOST_NUMBERS + 1, 2]},
        "inner": {"x_cm": 1.0, "covariance": None, "points": None, "rms_cm": 0.5},
    }
    assert as_data([Named(summed, "words")], full=False) == [{"fit": told, "summary": "words"}]
    assert set(as_data(summed)) == {"points", "told"}


def test_long_lists_of_numbers_are_told_by_their_length_and_lists_of_records_whole():
    n = MOST_NUMBERS + 1
    assert as_data([1.0] * n, full=False) == {"shape": [n]}
    assert as_data([(1.0, 2.0)] * n, full=False) == {"shape": [n]}
    assert len(as_data([Fitted()] * n, full=False)) == n
    assert as_data([1.0] * MOST_NUMBERS, full=False) == as_data([1.0] * MOST_NUMBERS)


def test_a_summary_that_is_no_mapping_is_refused():
    with pytest.raises(PluginError, match=r"Summed\.summary\(\) must return a mapping, got list"):
        as_data(Summed(None, [1.0]), full=False)


def test_sets_are_told_in_one_order() -> None:
    assert as_data({30, 4, 100}) == [4, 30, 100]
    assert as_data(frozenset({"b", "a"})) == ["a", "b"]
    assert as_data({2, "a"}) in ([2, "a"], ["a", 2])
    assert as_data({2, "a"}) == as_data({"a", 2})
