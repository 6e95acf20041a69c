import gc
import sys
from collections.abc import Iterator
from types import ModuleType

import pytest

from tactile_graph_live.bench.settled import Settled

NEW = "a_module_that_a_step_loads"


@pytest.fixture(autouse=True)
def as_before() -> Iterator[None]:
    yield
    sys.modules.pop(NEW, None)
    gc.unfreeze()


@pytest.mark.slow
def test_what_is_there_is_frozen_once() -> None:
    settled = Settled()
    settled()
    frozen = gc.get_freeze_count()
    assert frozen > 1000
    kept = [[k] for k in range(500)]
    settled()
    assert gc.get_freeze_count() <= frozen
    assert len(kept) == 500


@pytest.mark.slow
def test_what_was_loaded_since_is_frozen_too() -> None:
    settled = Settled()
    settled()
    frozen = gc.get_freeze_count()
    sys.modules[NEW] = ModuleType(NEW)
    kept = [[k] for k in range(500)]
    settled()
    assert gc.get_freeze_count() > frozen + 400
    assert len(kept) == 500
