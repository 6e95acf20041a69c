"""What is made once is told apart from what is done each time."""

from __future__ import annotations

import sys
import types
from typing import Any

import numpy as np
import pytest

import helpers_kernels
from tactile_graph.compiled import Kernel, made_so_far, once_made
from tactile_graph.compiled.preparing import preparing


def test_a_run_in_which_nothing_was_made_is_the_only_one() -> None:
    runs: list[int] = []
    assert once_made(lambda: runs.append(1) or len(runs)) == 1


@pytest.mark.parametrize(("n_making", "runs"), [(1, 2), (2, 3), (9, 3)])
def test_a_run_in_which_something_was_made_is_run_again_but_not_for_ever(
    n_making: int, runs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(preparing, "n_made", 0)
    n = 0

    def run() -> int:
        nonlocal n
        n += 1
        preparing.n_made += n <= n_making
        return n

    assert once_made(run) == runs


def test_a_module_that_is_imported_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    before = made_so_far()
    monkeypatch.setitem(sys.modules, "never_seen_before", types.ModuleType("never_seen_before"))
    assert made_so_far() != before


@pytest.mark.slow
@pytest.mark.parametrize("tried", [("0.0",), None])
def test_machine_code_that_is_compiled_or_loaded_counts(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any, tried: tuple[str, ...] | None
) -> None:
    from numba.core import config

    from tactile_graph.compiled import machine_code

    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    if tried is not None:
        monkeypatch.setattr(machine_code, "TRIED", tried)
    old = helpers_kernels.summed
    counted = []
    for _ in ("compiled", "loaded"):
        kernel = Kernel(old.loops, old.reference, plain_first=False)
        before = preparing.n_made
        kernel.compiled(np.ones(3))
        after = preparing.n_made
        kernel.compiled(np.ones(3))
        assert preparing.n_made == after
        counted.append(after > before)
    assert counted == [True, tried is None]  # of what numba itself loads it tells nothing
