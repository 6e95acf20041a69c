"""What a call hands in beside frames is told in words where it is of the wrong type."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from helpers_graphs import STEPS, registry
from tactile_graph import Pipeline, loads
from tactile_graph.errors import UsageError

TEXT = "pipeline: p\nnodes: {a: {step: constant}, b: {step: add1, in: a}}\noutputs: [a, b]\n"
FRAME = np.ones((2, 2))


def pipeline() -> Pipeline:
    return loads(TEXT, "p.yaml", registry(STEPS))


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda p: loads(None), r"loads\(\) takes a pipeline's YAML as text, got NoneType"),
        (lambda p: loads({"a": 1}), r"as text, got dict; yaml.safe_dump\(\) makes text of it"),
        (lambda p: loads(b""), r"as text, got bytes; .decode\(\) makes text of it"),
        (lambda p: p.with_settings(None), "settings must be a mapping .* got None"),
        (lambda p: p.with_settings("a.value=1"), "settings must be a mapping .* got 'a.value=1'"),
        (lambda p: p.with_settings({1: 2}), "settings: names are texts, 'node.setting', got 1"),
        (lambda p: p.with_source(3), "a source is named by a text, got 3"),
        (lambda p: p.run(FRAME, only=[1]), "only: names are texts, got 1"),
        (lambda p: p.run(FRAME, only=5), "only: names of nodes or outputs are needed, got 5"),
        (lambda p: p.stream([FRAME], only=[["a"]]), r"only: names are texts, got \['a'\]"),
        (lambda p: p.run(FRAME, seed=None), "seed: must be a whole number >= 0, got None"),
        (lambda p: p.run(FRAME, seed="a"), "seed: must be a whole number >= 0, got 'a'"),
        (lambda p: p.run(FRAME, seed=[1]), r"seed: must be a whole number >= 0, got \[1\]"),
        (lambda p: (p.run(FRAME, seed=1), p.run(FRAME, seed=1.0)), "whole number >= 0, got 1.0"),
        (lambda p: p.runner(seed=1.5), "seed: must be a whole number >= 0, got 1.5"),
        (lambda p: p.live("my.npy"), "frames are needed, got a path or text, 'my.npy'; with_sou"),
        (lambda p: p.live(3), "frames are needed, got int"),
    ],
)
def test_what_is_of_the_wrong_type_is_told(call: Callable[[Pipeline], Any], told: str) -> None:
    with pytest.raises(UsageError, match=told):
        call(pipeline())


def test_names_and_seeds_are_taken_as_they_come() -> None:
    p = pipeline()
    assert list(p.run(FRAME, only="b")) == ["b"]
    assert sorted(p.run(FRAME, only={"a", "b"})) == ["a", "b"]  # type: ignore[arg-type]
    assert list(p.run(FRAME, only=["b", "b"], seed=np.int64(3))) == ["b"]  # type: ignore[arg-type]
