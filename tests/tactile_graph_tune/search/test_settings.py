"""Values of free settings that come to the same."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.search.settings import best_of_each, settled, told_from

SETTINGS = [{}, *({"a.x": x} for x in (1, 2, 3, 4))]
EACH = {k: Choice(k, (), {}) for k in range(5)}


@pytest.mark.parametrize(
    ("as_good", "taken"),
    [({0, 1, 2}, 0), ({1, 2, 3}, 2), ({3}, 3), ({2, 4}, 2)],
    ids=["given", "middle", "only", "nearest below the middle"],
)
def test_the_given_value_stays_where_it_is_as_good_and_else_the_middle_is_taken(
    as_good: set[int], taken: int
) -> None:
    chosen, found = settled(EACH, SETTINGS, {"a.x": 2.5}, lambda c: c.variant in as_good)
    assert chosen == EACH[taken]
    assert found == {"a.x": tuple(SETTINGS[k].get("a.x", 2.5) for k in sorted(as_good))}


def test_of_several_settings_each_that_can_stays() -> None:
    settings = [{}, *({"a.x": x, "b.y": y} for x in (1, 2) for y in (5, 6))]
    chosen, found = settled(EACH, settings, {"a.x": 1, "b.y": 7}, lambda c: c.variant in (1, 2, 3))
    assert settings[chosen.variant] == {"a.x": 1, "b.y": 5}
    assert found == {"a.x": (1, 2), "b.y": (5, 6)}


def test_as_good_is_what_is_not_clearly_more() -> None:
    rng = np.random.default_rng(0)
    least = rng.uniform(5.0, 6.0, 200)
    more = {0: 0.0, 1: rng.normal(0.05, 1.0, 200), 2: 0.2, 3: 0.01}

    def sought(choice: Choice) -> tuple[np.ndarray, np.ndarray]:
        return least + more[choice.variant], np.ones(200)

    as_good = told_from(EACH[0], sought, np.arange(200), 0)
    assert [as_good(EACH[k]) for k in range(4)] == [True, True, False, True]


def test_what_one_variant_asks_is_tried_with_every_other() -> None:
    chosen, other = Choice(1, ("quick",), {}), Choice(2, (), {})
    found = best_of_each(chosen, [other], 4, lambda c: c.variant != 3, lambda c: -len(c.order))
    assert found == {k: Choice(k, ("quick",), {}) for k in range(3)}
