"""The second process takes what the first would wait for, and nothing it has sooner itself."""

from __future__ import annotations

from tactile_graph.compiled.race import Race

LONG = {"search": 60_000}
APART = {"polish": 20_000}
ALIKE = {"search": 40_000, "sample": 12_000}
SMALL = {"count": 500}


def order(race: Race, elapsed_s: float = 1.0) -> list[int]:
    found: list[int] = []
    while (i := race.next(elapsed_s)) is not None:
        found.append(i)
    return found


def test_the_kernel_the_other_is_at_is_left_to_it() -> None:
    assert order(Race([LONG])) == []
    assert 0 not in order(Race([LONG, APART, ALIKE]))


def test_what_saves_most_comes_first() -> None:
    assert Race([LONG, ALIKE, APART]).next(1.0) == 2
    assert Race([LONG, APART, ALIKE]).next(1.0) == 1


def test_what_the_other_has_sooner_by_what_it_shares_is_left_to_it() -> None:
    assert order(Race([LONG, ALIKE]), elapsed_s=14.0) == []
    assert order(Race([LONG, ALIKE]), elapsed_s=1.0) == [1]


def test_small_work_is_not_worth_a_processor() -> None:
    assert order(Race([LONG, SMALL])) == []
    assert order(Race([])) == []
