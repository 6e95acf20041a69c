"""A key that no field has is refused at any depth, unless its type says what becomes of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import pytest
from pydantic import BaseModel, ConfigDict, Field, model_validator
from typing_extensions import TypedDict

from tactile_graph.steps.settings import adapter, validate_settings
from tactile_graph.steps.signature import read_signature


@dataclass
class Plain:
    a: int
    b: list[float] = field(default_factory=list)


@dataclass
class Other:
    a: int
    c: int = 0


class Model(BaseModel):
    size: int = 1
    plain: Plain | None = None
    default: Plain | None = None


class Typed(TypedDict, total=False):
    gain: float


class Point(NamedTuple):
    x_cm: float
    y_cm: float = 0.0


class Open(BaseModel):
    model_config = ConfigDict(extra="allow")
    size: int = 1


class Ignoring(BaseModel):
    model_config = ConfigDict(extra="ignore")
    size: int = 1


class Alias(BaseModel):
    size: int = Field(1, alias="n")


class Older(BaseModel):
    size: int = 1

    @model_validator(mode="before")
    @classmethod
    def _renamed(cls, data: Any) -> Any:
        return {"size" if key == "length" else key: value for key, value in data.items()}


def takes(
    image: int,
    *,
    plain: Plain = Plain(1),  # noqa: B008
    model: Model = Model(),  # noqa: B008
    typed: Typed | None = None,
    point: Point | None = None,
    listed: list[Model] | None = None,
    named: dict[str, list[Plain]] | None = None,
    either: Plain | Other | None = None,
    any_of: Plain | dict[str, float] | None = None,
    open_: Open | None = None,
    ignoring: Ignoring | None = None,
    alias: Alias | None = None,
    older: Older | None = None,
) -> int:
    """Take settings."""
    return image


SIGNATURE = read_signature("takes", takes)


def troubles(**given: Any) -> dict[str, str]:
    _, found = validate_settings(SIGNATURE, given)
    return {".".join(map(str, path)): message for path, message in found}


@pytest.mark.parametrize(
    ("given", "place", "near"),
    [
        ({"plain": {"a": 1, "bb": [2.0]}}, "plain.bb", "did you mean 'b'?"),
        ({"model": {"siz": 1}}, "model.siz", "did you mean 'size'?"),
        ({"model": {"plain": {"a": 1, "bb": []}}}, "model.plain.bb", "did you mean 'b'?"),
        ({"model": {"default": {"a": 1, "bb": []}}}, "model.default.bb", "did you mean 'b'?"),
        ({"typed": {"gian": 1}}, "typed.gian", "did you mean 'gain'?"),
        ({"point": {"x_cm": 1, "y": 1}}, "point.y", "takes: x_cm, y_cm"),
        ({"listed": [{}, {"siz": 1}]}, "listed.1.siz", "did you mean 'size'?"),
        ({"named": {"k": [{"a": 1, "bb": 1}]}}, "named.k.0.bb", "did you mean 'b'?"),
        ({"either": {"a": 1, "cc": 1}}, "either.cc", "did you mean 'c'?"),
        ({"alias": {"nn": 1}}, "alias.nn", "did you mean 'n'?"),
        ({"older": {"lenth": 1}}, "older.lenth", "takes: size"),
    ],
)
def test_a_misspelt_key_is_told_with_its_place(given: Any, place: str, near: str) -> None:
    found = troubles(**given)
    assert list(found) == [place]
    assert found[place].startswith("unknown setting ")
    assert found[place].endswith(near)


def test_keys_of_two_types_of_which_one_may_stand_do_not_go_together() -> None:
    found = troubles(either={"a": 1, "b": [1], "c": 2})
    assert set(found) == {"either.b", "either.c"}
    assert found["either.c"] == "setting 'c' does not go with the others given here"


@pytest.mark.parametrize(
    "given",
    [
        {"either": {"a": 1, "c": 2}},
        {"any_of": {"a": 1, "bb": 2}},
        {"open_": {"siz": 1}},
        {"ignoring": {"siz": 1}},
        {"alias": {"n": 2}},
        {"older": {"length": 2}},
    ],
)
def test_what_a_type_takes_goes_on_to_work(given: Any) -> None:
    assert troubles(**given) == {}


def test_a_model_used_elsewhere_is_left_as_it_is() -> None:
    troubles(listed=[{"siz": 1}])
    assert Model.model_validate({"siz": 1}) == Model()


def test_editors_learn_it_too() -> None:
    plain = next(s for s in SIGNATURE.settings if s.name == "plain")
    assert adapter(plain).json_schema()["additionalProperties"] is False
