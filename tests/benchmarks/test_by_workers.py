"""Benchmarks by several processes: what one process gives, in order."""

from __future__ import annotations

import argparse
import math
import sys
from functools import partial
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from by_workers import add_workers, in_order


@pytest.mark.slow
def test_several_workers_give_what_one_does() -> None:
    items = [math.e**k for k in range(20)]
    work = partial(math.atan2, 0.1)
    assert [*in_order(work, items, 2)] == [*in_order(work, items, 1)]


def test_one_worker_does_an_item_when_it_is_asked_for() -> None:
    done: list[int] = []
    came = in_order(done.append, range(9), 1)
    next(came)
    assert done == [0]


def test_the_command_takes_a_number_of_workers() -> None:
    parser = argparse.ArgumentParser()
    add_workers(parser)
    assert parser.parse_args([]).workers == 1
    assert parser.parse_args(["--workers", "3"]).workers == 3
