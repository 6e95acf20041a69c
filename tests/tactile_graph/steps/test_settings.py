"""Settings inside settings: every trouble names the field, and says what it may be."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, Literal

import pytest
from annotated_types import Ge, Gt
from typing_extensions import TypedDict

from tactile_graph.steps.settings import spelled, validate_settings
from tactile_graph.steps.signature import read_signature


@dataclass(frozen=True)
class Inner:
    depth: Annotated[int, Ge(1)] = 1
    kind: Literal["soft", "hard"] = "soft"


@dataclass(frozen=True)
class Outer:
    weight: Annotated[float, Gt(0)]
    inner: Inner = field(default_factory=Inner)
    steps: list[int] = field(default_factory=list)
    sure: bool = False
    __pydantic_config__: ClassVar[Any] = {"extra": "forbid"}


class Typed(TypedDict, total=False):
    gain: Annotated[float, Ge(0)]


def takes(image: int, *, model: Outer | None = None, typed: Typed | None = None, n: int = 3) -> int:
    """Take settings."""
    return image


def troubles(**given: Any) -> dict[str, str]:
    _, found = validate_settings(read_signature("takes", takes), given)
    return {".".join(map(str, path)): message for path, message in found}


@pytest.mark.parametrize(
    ("model", "place", "message"),
    [
        ({"weight": -2}, "model.weight", "must be > 0.0, got -2"),
        ({"weight": "a"}, "model.weight", "must be a number, got 'a'"),
        ({"weight": True}, "model.weight", "must be a number, got True"),
        ({"weight": 1, "inner": {"depth": 0}}, "model.inner.depth", "must be >= 1, got 0"),
        (
            {"weight": 1, "inner": {"kind": "hrd"}},
            "model.inner.kind",
            "must be one of 'soft' | 'hard', got 'hrd'; did you mean 'hard'?",
        ),
        ({"weight": 1, "steps": [1, "x"]}, "model.steps.1", "must be a whole number, got 'x'"),
        (
            {"weight": 1, "wight": 1},
            "model.wight",
            "unknown setting 'wight'; did you mean 'weight'?",
        ),
        ({"weight": 1, "sure": "perhaps"}, "model.sure", "must be true or false, got 'perhaps'"),
        ({}, "model", "'weight' is missing (a number)"),
        ({"weight": 1, "inner": 3}, "model.inner", "must be Inner, got 3"),
    ],
)
def test_a_trouble_within_a_mapping_names_the_field(model, place, message) -> None:
    assert troubles(model=model) == {place: message}


def test_an_unknown_field_unlike_any_other_is_answered_with_all_there_are() -> None:
    found = troubles(model={"weight": 1, "qq": 1})
    assert list(found) == ["model.qq"]
    assert found["model.qq"].endswith("takes: inner, steps, sure, weight")


def test_everything_wrong_is_told_at_once() -> None:
    model = {"weight": -1, "inner": {"depth": True, "kind": 7}, "steps": ["y"]}
    assert list(troubles(model=model, typed={"gain": -1}, n="x")) == [
        "model.weight",
        "model.inner.kind",
        "model.steps.0",
        "model.inner.depth",
        "typed.gain",
        "n",
    ]


def test_fields_that_may_be_true_or_false_take_it() -> None:
    values, found = validate_settings(
        read_signature("takes", takes), {"model": {"weight": 2, "sure": True}}
    )
    assert not found
    assert values["model"] == Outer(2.0, sure=True)


def test_a_path_is_spelled_with_its_names_only() -> None:
    assert spelled(("model", "steps", 1)) == "model.steps"
    assert spelled(("table",)) == "table"
