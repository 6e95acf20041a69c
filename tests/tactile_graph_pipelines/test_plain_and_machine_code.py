"""Whichever code answers, a pipeline's answers are the same to the last bit.

A run on an empty cache is answered by plain loops at first, and by machine code as soon as that is
there: when, is a matter of the clock, so the answers must not be.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame, load
from tactile_graph.compiled import answered_meanwhile, kernel, meanwhile

FRAMES = 2
PIPELINES = (
    "adaptive", "bayes-circle", "bayes-lines", "bayes-objects", "bayes-rectangle", "bayes-smooth",
    "circle-by-order", "circle-followed", "circle-full", "circle-likelihood", "circle-restored",
    "identify-likelihood", "identify-reliefs", "locate", "locate-circle", "locate-contacts",
    "locate-objects", "locate-rectangle", "object-likelihood", "objects-likelihood",
    "rectangle-likelihood", "rectangle-straight", "thesis-lines", "thesis-smooth",
)  # fmt: skip


class Working:
    """Stands for a process that compiles and never ends."""

    stdin = None
    pid = 1
    returncode = None

    def poll(self) -> None:
        return None

    def terminate(self) -> None: ...

    def wait(self) -> None: ...


@pytest.fixture
def never_compiled(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.delenv("TACTILE_GRAPH_KERNELS", raising=False)
    monkeypatch.setattr(meanwhile.os, "cpu_count", lambda: 2)
    monkeypatch.setattr(meanwhile, "_process", Working)
    monkeypatch.setattr(meanwhile, "PATIENCE_S", 1e9)
    monkeypatch.setattr(meanwhile.Call, "on_disk", lambda call: False)
    yield
    kernel._reset_all()


def answers(name: str, frames: list[Frame]) -> list[str]:
    """Return all outputs of frames with all digits."""
    pipeline: Any = load(name)
    with np.printoptions(threshold=10**9, floatmode="unique"):
        return [
            repr([result.outcome(output) for output in pipeline.outputs])
            for result in pipeline.stream(frames)
        ]


@pytest.mark.slow
@pytest.mark.usefixtures("never_compiled")
@pytest.mark.parametrize("name", PIPELINES)
def test_plain_loops_answer_as_machine_code_does(name: str) -> None:
    frames = list(islice(load(name).frames(), FRAMES))
    kernel._reset_all()
    with answered_meanwhile():
        plain = answers(name, frames)
    kernel._reset_all()
    assert plain == answers(name, frames)
