"""What a source raises is told by its own line."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from helpers_graphs import registry
from tactile_graph import Frame, loads
from tactile_graph.errors import DataError


def exhausted() -> Iterator[Frame]:
    yield next(iter([]))


def test_a_source_that_asks_for_more_than_there_is_is_told_by_its_line() -> None:
    text = "pipeline: p\nsource: {step: s}\nnodes:\n  a: {step: r, in: frame}\noutputs: [a]\n"

    def read(frame: Frame) -> float:
        return frame.time_s

    pipeline = loads(text, "p.yaml", registry({"s": exhausted, "r": read}))
    line = exhausted.__code__.co_firstlineno + 1
    with pytest.raises(DataError, match=rf"test_sources\.py:{line} in exhausted"):
        next(pipeline.frames())
