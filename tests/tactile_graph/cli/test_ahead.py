"""The process beside finds out by plain code what a command will need, and stops when of no use."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tactile_graph import load
from tactile_graph.cli import ahead
from tactile_graph.compiled import machine_code
from tactile_graph.plugins import registry


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the names of the kernels that would be compiled."""
    names: list[str] = []

    def make_ahead(loops: Any, types: tuple[Any, ...]) -> None:
        assert len(types) == loops.__code__.co_argcount
        names.append(loops.__name__)

    monkeypatch.setattr(machine_code, "make_ahead", make_ahead)
    return names


@pytest.mark.slow
def test_the_kernels_of_a_frame_are_compiled_but_for_the_first(made: list[str]) -> None:
    ahead.compile_ahead([load("circle-full")])
    assert "polish_all" in made
    assert "unknowns" not in made
    assert len(made) == len(set(made))


def test_it_ends_with_the_first_frame_that_needs_nothing(
    made: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    frames: list[int] = []
    pipeline = load("circle-3")
    stream = pipeline.stream

    def counted() -> Any:
        for result in stream():
            frames.append(result.frame.index)
            yield result

    monkeypatch.setattr(type(pipeline), "stream", lambda _, **kept: counted())
    ahead.compile_ahead([pipeline])
    assert (made, frames) == ([], [0])


def test_what_cannot_be_opened_is_left_out(made: list[str]) -> None:
    said = {"pipelines": ["no such", "circle-1"], "settings": [], "recordings": [],
            "plugins": registry.selected(), "warm": False}  # fmt: skip
    ahead.main(json.dumps(said))
    assert made == []
