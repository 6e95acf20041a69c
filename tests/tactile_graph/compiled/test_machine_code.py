"""Machine code agrees with plain code, whichever way numba makes it, and is kept on disk."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from numba.core import config

import helpers_kernels
from tactile_graph import locks
from tactile_graph.compiled import Kernel, compiled_as_is, machine_code, preparing, whole
from tactile_graph.compiled.preparing import told_by

VALUES = np.array([3.0, 1.0, 4.0, 1.0, 5.0])
KERNELS = ("doubled", "summed", "spread", "total")


@pytest.fixture
def fresh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that makes the small kernels anew, as another run would find them."""
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))

    def make() -> Any:
        for name in KERNELS:
            old = getattr(helpers_kernels, name)
            new = Kernel(old.loops, old.reference, plain_first=False)
            monkeypatch.setattr(helpers_kernels, name, new)
        return helpers_kernels

    return make


def kept(folder: Path) -> set[str]:
    return {path.name.split("-")[0] for path in folder.rglob("*.nbc")}


@pytest.mark.slow
@pytest.mark.parametrize("tried", [("0.0",), machine_code.TRIED])
def test_machine_code_answers_as_plain_code_does(
    fresh: Any, monkeypatch: pytest.MonkeyPatch, tried: tuple[str, ...]
) -> None:
    monkeypatch.setattr(machine_code, "TRIED", tried)
    kernels = fresh()
    assert kernels.total.compiled(3.0, 4) == kernels.total.reference(3.0, 4) == 12.0
    assert kernels.spread.compiled(VALUES) == kernels.spread.loops(VALUES) == 3.0
    with pytest.raises(ValueError, match="too many values"):
        kernels.spread.compiled(np.ones(helpers_kernels.MOST + 2))


def test_this_numba_is_one_that_was_tried() -> None:
    assert machine_code.whole()


@pytest.mark.slow
def test_only_what_python_calls_is_kept_on_disk(fresh: Any, tmp_path: Path) -> None:
    fresh().spread.compiled(VALUES)
    assert kept(tmp_path) == {"helpers_kernels.spread"}


@pytest.mark.slow
def test_a_kernel_serves_python_and_other_kernels_alike(fresh: Any, tmp_path: Path) -> None:
    kernels = fresh()
    assert kernels.spread.compiled(VALUES) == 3.0
    assert kernels.summed.compiled(VALUES) == 31.0
    assert kept(tmp_path) == {"helpers_kernels.spread", "helpers_kernels.summed"}


@pytest.mark.slow
def test_the_next_run_loads_what_was_kept_and_can_raise(fresh: Any) -> None:
    fresh().spread.compiled(VALUES)
    again = fresh().spread.compiled
    assert again(VALUES) == 3.0
    assert (sum(again.stats.cache_hits.values()), len(again.stats.cache_misses)) == (1, 0)
    with pytest.raises(ValueError, match="too many values"):
        again(np.ones(helpers_kernels.MOST + 2))


@pytest.mark.slow
def test_what_was_kept_runs_without_the_compiler(tmp_path: Path) -> None:
    """A process of its own: this one has loaded the compiler long since."""
    code = """
import sys
import numpy as np
from helpers_kernels import doubled, hashed
print(hashed.compiled("pad") == hash("pad"), doubled.compiled(np.arange(5.0), 3))
print("numba.np.arraymath" in sys.modules)
"""
    environment = {
        **os.environ, "NUMBA_CACHE_DIR": str(tmp_path),
        "PYTHONPATH": str(Path(helpers_kernels.__file__).parent),
    }  # fmt: skip
    said = [
        subprocess.run(
            [sys.executable, "-c", code], env=environment, capture_output=True, text=True,
            check=True,
        ).stdout.split()
        for _ in range(2)
    ]  # fmt: skip
    assert said == [["True", "6.0", "True"], ["True", "6.0", "False"]]


@pytest.mark.slow
def test_a_change_beneath_outdates_what_was_kept(
    fresh: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    fresh().spread.compiled(VALUES)
    monkeypatch.setattr(helpers_kernels, "MOST", 2)
    again = fresh().spread.compiled
    with pytest.raises(ValueError, match="too many values"):
        again(VALUES)


@pytest.mark.slow
def test_a_function_that_numba_alone_compiles_may_call_kernels(fresh: Any) -> None:
    kernels = fresh()
    summed = kernels.summed
    kernels.spread.compiled(VALUES)

    @numba.njit
    def twice(values: Any) -> float:
        return 2.0 * summed(values)

    assert twice(VALUES) == 62.0
    with pytest.raises(ValueError, match="too many values"):
        twice(np.ones(helpers_kernels.MOST + 2))


@pytest.mark.slow
def test_what_another_process_makes_is_waited_for_and_loaded(
    fresh: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(preparing, "WORTH_A_LINE_S", -1.0)
    theirs = whole.entry_of(fresh().spread.loops)
    mine = whole.entry_of(helpers_kernels.spread.loops)
    assert theirs._cache._claim.take()
    made: list[float] = []
    with told_by(preparing.Line()):
        waiting = threading.Thread(target=lambda: made.append(mine(VALUES)))
        waiting.start()
        while "another process compiles spread" not in capsys.readouterr().err:
            time.sleep(0.01)
        assert not made
        theirs._cache._claim.release()
        waiting.join()
    assert made == [3.0]


@pytest.mark.slow
def test_who_finds_it_made_meanwhile_does_not_make_it_again(fresh: Any) -> None:
    first, second = (whole.entry_of(fresh().spread.loops) for _ in range(2))
    assert first(VALUES) == second(VALUES) == 3.0
    assert [sum(d.stats.cache_hits.values()) for d in (first, second)] == [0, 1]


@pytest.mark.slow
def test_what_another_process_makes_is_not_made_ahead(fresh: Any, tmp_path: Path) -> None:
    loops, types = fresh().spread.loops, (numba.typeof(VALUES),)
    other = whole.entry_of(loops)
    assert other._cache._claim.take()
    machine_code.make_ahead(loops, types)
    assert kept(tmp_path) == set()
    other._cache.let_go()
    machine_code.make_ahead(loops, types)
    assert kept(tmp_path) == {"helpers_kernels.spread"}


@pytest.mark.slow
def test_loops_that_cannot_be_compiled_leave_no_claim(fresh: Any) -> None:
    entry = whole.entry_of(fresh().spread.loops)
    for _ in range(2):
        with pytest.raises(numba.TypingError):
            entry("no array")
    assert not entry._cache._claim.held


@pytest.mark.slow
def test_a_folder_without_locks_serves(fresh: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_locks(*_: object) -> None:
        raise OSError(errno.ENOLCK, "no locks available")

    monkeypatch.setattr(locks, "_lock", no_locks)
    assert fresh().spread.compiled(VALUES) == 3.0


@compiled_as_is
def assigned(values: Any, n: int) -> float:
    """Sort a copy and write it over another: functions and an error of numba's own."""
    copy = np.zeros(n)
    copy[:] = np.sort(values)
    return float(copy[0])


@pytest.mark.slow
@pytest.mark.parametrize("tried", [("0.0",), machine_code.TRIED])
def test_other_threads_run_while_machine_code_does(
    fresh: Any, monkeypatch: pytest.MonkeyPatch, tried: tuple[str, ...]
) -> None:
    monkeypatch.setattr(machine_code, "TRIED", tried)
    total = fresh().total
    assert total.compiled(1.0, 1) == 1.0
    worker = threading.Thread(target=total.compiled, args=(1.0, 400_000_000))
    worker.start()
    stamps = [time.perf_counter()]
    while worker.is_alive():
        time.sleep(0.001)
        stamps.append(time.perf_counter())
    assert max(np.diff(stamps)) < 0.5 * (stamps[-1] - stamps[0])


@pytest.mark.slow
def test_numbas_own_functions_serve_entries_and_others_alike() -> None:
    entry = whole.entry_of(assigned.loops)
    assert entry(VALUES, 5) == 1.0
    with pytest.raises(ValueError, match="cannot assign to a slice what has another shape"):
        entry(VALUES, 4)

    @numba.njit
    def alone(values: Any) -> float:
        copy = np.zeros(5)
        copy[:] = np.sort(values)
        return float(copy[-1])

    assert alone(VALUES) == 5.0
    with pytest.raises(ValueError, match=r"shape \(5,\) from input of shape \(3,\)"):
        alone(VALUES[:3])


@pytest.mark.slow
def test_direct_calls_answer_as_calls_do_before_and_after_machine_code(
    fresh: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    kernel = fresh().doubled
    answers = [kernel.direct(VALUES, i) for i in range(3)]
    assert answers == [6.0, 2.0, 8.0]
    assert kernel.direct is not kernel.call  # nobody looks at its arguments any more
    with pytest.raises(ValueError, match="too many"):
        kernel.direct(VALUES, helpers_kernels.MOST + 1)
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", "plain")
    kernel.reset()
    assert kernel.direct(VALUES, 1) == 2.0
    assert kernel.direct == kernel._first_direct


@pytest.mark.slow
def test_an_array_of_another_kind_is_refused_by_machine_code_called_directly(fresh: Any) -> None:
    spread = fresh().spread
    spread.compiled(VALUES)
    call = machine_code.entry_point(spread.compiled, (VALUES,))
    assert call is not spread.compiled
    assert call(VALUES) == call(VALUES[:5]) == 3.0
    wrong: list[Any] = [
        np.zeros((2, 2)), np.zeros((2,) * 30), np.float64(1.0), VALUES[::2], VALUES[::-1],
        VALUES.astype(int), [1.0], None, object(),
    ]  # fmt: skip
    before = [sys.getrefcount(value) for value in wrong]
    for value in wrong:
        with pytest.raises(TypeError):
            call(value)
    del value
    assert [sys.getrefcount(value) for value in wrong] == before
    with pytest.raises(TypeError):
        call(VALUES.astype("f4"))


@pytest.mark.slow
def test_numbers_in_another_byte_order_are_refused_and_never_taken_as_they_lie(fresh: Any) -> None:
    """numba finds the code of read-only arrays by their type's number, whatever the order."""
    spread = fresh().spread
    usual, foreign = VALUES.copy(), VALUES.astype(VALUES.dtype.newbyteorder())
    usual.setflags(write=False)
    foreign.setflags(write=False)
    assert spread.compiled(usual) == 3.0
    direct = machine_code.entry_point(spread.compiled, (usual,))
    for call in (spread.compiled, direct):
        with pytest.raises(TypeError, match=r"float64 .*byte order"):
            call(foreign)
    assert direct(usual) == 3.0
