"""What machine code gives back is whole, whenever a signal comes."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from helpers_kernels import Inner, nested

INTERRUPTED = """
import signal, time
from helpers_kernels import nested

class Stop(KeyboardInterrupt):
    pass

def stop(*_):
    raise Stop

nested.call(1.0)
signal.signal(signal.SIGALRM, stop)
stopped, end = 0, time.monotonic() + 2.0
while time.monotonic() < end:
    try:
        signal.setitimer(signal.ITIMER_REAL, 2e-5)
        for _ in range(10_000):
            nested.call(2.0)
    except Stop:
        stopped += 1
signal.setitimer(signal.ITIMER_REAL, 0.0)
print(stopped)
"""


@pytest.mark.slow
def test_named_tuples_and_arrays_are_those_of_plain_loops() -> None:
    for answer in (nested.loops, nested.compiled):
        found = answer(2.0)
        assert type(found.left) is type(found.right) is Inner
        assert (found.left.number, found.n) == (2.0, 3)
        assert found.left.values.tolist() == [2.0, 2.0]
        assert found.right.values.tolist() == [[4.0, 4.0, 4.0]]
        assert type(found.left.values) is np.ndarray
        assert found.left.values.flags.writeable


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="Windows has no timer that signals")
def test_a_signal_while_an_answer_is_given_back_ends_no_process() -> None:
    """Some tens of thousands come, most of them there; each must be Python's own exception."""
    got = subprocess.run(
        [sys.executable, "-c", INTERRUPTED], cwd=Path(__file__).parents[2], capture_output=True
    )
    assert (got.returncode, got.stderr) == (0, b"")
    assert int(got.stdout) > 1000
