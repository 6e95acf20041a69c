"""What a step's notice says, and what is said of one that breaks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from helpers_graphs import frame, registry
from tactile_graph import Image, loads

TEXT = "pipeline: p\nnodes:\n  a: {step: s, in: frame}\noutputs: [a]\n"


def notice_of(notice: Callable[..., Any]) -> str:
    def step(image: Image) -> int:
        return int(image.values[0, 0])

    step.notice = notice  # type: ignore[attr-defined]
    result = loads(TEXT, "p.yaml", registry({"s": step})).runner()(frame(3))
    assert result.outcome("a") == 3
    return result.notices.get("a", "")


def crash(image: Image) -> str:
    raise ValueError("no\n  voice")


@pytest.mark.parametrize(
    ("notice", "told"),
    [
        (lambda image, value: f"{value} of {image.peak:g}", "3 of 3"),
        (lambda value: "", ""),
        (lambda value: None, ""),
        (lambda other: "of a port that is not there", ""),
        (lambda value: value, "its notice breaks: TypeError: it must return a text, got 3"),
        (crash, "its notice breaks: ValueError: no voice ("),
        ("text", "its notice breaks: TypeError: 'text' is not a callable object"),
    ],
)
def test_each_notice_is_told_whatever_it_is(notice: Any, told: str) -> None:
    assert notice_of(notice)[: len(told) or None] == told


def test_one_that_breaks_is_told_with_its_line() -> None:
    assert "test_notices.py" in notice_of(crash)
