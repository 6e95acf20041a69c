"""References to arrays are counted in machine code itself, and none is lost or kept."""

from __future__ import annotations

import sys
import threading
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from numba.core import config
from numba.core.runtime import _nrt_python, rtsys

import helpers_kernels
from tactile_graph.compiled import whole
from tactile_graph.compiled.counted import are_its_own

TABLE = np.arange(600.0).reshape(100, 6)
pytestmark = pytest.mark.slow


@pytest.fixture
def entry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return loops over rows, compiled anew."""
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    return whole.entry_of(helpers_kernels.of_rows.loops)


def made_of(entry: Any) -> str:
    (result,) = entry.overloads.values()
    text: str = result.library.get_llvm_str()
    return text


def test_rows_are_counted_without_a_call(entry: Any) -> None:
    rows, total = entry(TABLE, 3)
    assert (rows.tolist(), total) == (TABLE[:3].tolist(), TABLE[:3].sum())
    assert "@NRT_decref" not in made_of(entry)
    assert "atomicrmw" not in made_of(entry)
    assert "@NRT_MemInfo_call_dtor" in made_of(entry)  # it counts, and frees what it made


def test_what_others_may_share_is_counted_under_a_lock(entry: Any) -> None:
    shared = numba.typed.List(list(TABLE))
    assert entry(shared, 100)[1] == TABLE.sum()
    assert "atomicrmw" in made_of(entry)


def test_no_array_is_kept_and_none_freed_twice(entry: Any) -> None:
    entry(TABLE, 3)
    held = sys.getrefcount(TABLE)
    _nrt_python.memsys_enable_stats()
    try:
        before = rtsys.get_allocation_stats()
        for n in range(2000):
            rows, _ = entry(TABLE, n % 100)
            assert rows.shape == (n % 100, 6)
        del rows
        after = rtsys.get_allocation_stats()
    finally:
        _nrt_python.memsys_disable_stats()
    assert after.alloc - before.alloc == after.free - before.free > 2000
    assert after.mi_alloc - before.mi_alloc == after.mi_free - before.mi_free > 2000
    assert sys.getrefcount(TABLE) == held


def test_threads_that_read_one_array_leave_its_count_as_it_was(entry: Any) -> None:
    entry(TABLE, 100)
    held, sums = sys.getrefcount(TABLE), []

    def read() -> None:
        sums.extend(entry(TABLE, 100)[1] for _ in range(3000))

    threads = [threading.Thread(target=read) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sums == [TABLE.sum()] * 12_000
    assert sys.getrefcount(TABLE) == held


def test_arrays_numbers_and_tuples_of_them_are_an_entrys_own() -> None:
    array = numba.typeof(TABLE)
    pair = numba.types.UniTuple(array, 2)
    assert are_its_own([array, numba.int64, numba.boolean, pair, numba.types.none])
    assert not are_its_own([array, numba.types.ListType(numba.float64)])
    assert not are_its_own([numba.types.Tuple([array, numba.types.unicode_type])])
