"""Trust: when a phase is doubted, what ends the doubt, and when nothing is learned."""

from __future__ import annotations

import pytest

from tactile_graph_sources.devices.trust import (
    ALONE_FOR,
    EARNED_AFTER,
    HELD_FOR,
    Trust,
    Verdict,
)


def trusted() -> Trust:
    trust = Trust()
    trust.lock(doubtful=False, wary=False)
    trust.pass_clear(EARNED_AFTER)
    return trust


def weigh(trust: Trust, verdict: Verdict, n: int = 1, wary: bool = False) -> None:
    for _ in range(n):
        trust.weigh(verdict, rivals_about=verdict is not Verdict.ALONE, wary=wary)


def test_a_header_that_comes_with_a_scene_is_doubted_until_it_holds_once() -> None:
    trust = trusted()
    weigh(trust, Verdict.NEW)
    assert trust.doubt
    assert not trust.strict
    weigh(trust, Verdict.HOLDS)
    assert not trust.doubt


def test_a_header_that_comes_right_after_a_lock_is_doubted_as_after_a_loss() -> None:
    trust = Trust()
    trust.lock(doubtful=False, wary=False)
    weigh(trust, Verdict.NEW)
    assert trust.strict


def test_a_doubt_that_came_with_a_loss_ends_after_many_units_in_a_row_that_hold() -> None:
    trust = Trust()
    trust.lock(doubtful=True, wary=False)
    weigh(trust, Verdict.HOLDS, HELD_FOR - 1)
    weigh(trust, Verdict.NEW)
    weigh(trust, Verdict.HOLDS, HELD_FOR - 1)
    assert trust.strict
    weigh(trust, Verdict.HOLDS)
    assert not trust.doubt


def test_a_doubt_outlives_another_loss() -> None:
    trust = Trust()
    trust.lock(doubtful=True, wary=False)
    trust.lock(doubtful=False, wary=False)
    assert trust.strict


@pytest.mark.parametrize("doubtful", [False, True])
def test_a_doubt_is_over_when_there_is_no_rival_for_long(doubtful: bool) -> None:
    trust = Trust()
    trust.lock(doubtful=doubtful, wary=True)
    weigh(trust, Verdict.ALONE, ALONE_FOR - 1, wary=True)
    assert trust.doubt
    weigh(trust, Verdict.ALONE, wary=True)
    assert not trust.doubt


def test_what_looks_the_same_from_each_is_doubted_as_after_a_loss() -> None:
    trust = trusted()
    weigh(trust, Verdict.HOLDS, 20)
    weigh(trust, Verdict.EITHER)
    assert trust.strict
