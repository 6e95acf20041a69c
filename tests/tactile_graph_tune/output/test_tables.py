"""What tuning found, told to people."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from tactile_graph_tune.output.tables import doubt
from tactile_graph_tune.split import Interval
from tactile_graph_tune.tuned import ALWAYS, CHOSEN, GIVEN, Weight


def weight(time_us: float) -> Weight:
    return Weight(*(Interval(mean, mean, mean) for mean in (time_us, 0.0, 0.0, 0.0)))


@pytest.mark.parametrize(("predicted_us", "told"), [(90.0, ""), (4420.0, "as given was predicted")])
def test_times_that_were_disturbed_are_doubted(predicted_us: float, told: str) -> None:
    point = SimpleNamespace(weight=weight(predicted_us), rerun=weight(100.0))
    tuned = SimpleNamespace(points=dict.fromkeys((GIVEN, ALWAYS, CHOSEN), point))
    assert doubt(tuned).startswith(told)
    assert bool(doubt(tuned)) == bool(told)
