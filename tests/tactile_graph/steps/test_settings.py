"""Settings inside settings: every trouble names the field, and says what it may be."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import Annotated, Any, ClassVar, Literal, NotRequired

import numpy as np
import pytest
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray
from pydantic import AllowInfNan, BaseModel, field_validator
from typing_extensions import TypedDict

from tactile_graph.errors import shown
from tactile_graph.pipeline.plain import as_given
from tactile_graph.steps.inner import written_type
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
    note: NotRequired[str]


class Colour(Enum):
    RED = "red"
    BLUE = "blue"


def takes(
    image: int,
    *,
    model: Outer | None = None,
    typed: Typed | None = None,
    n: int = 3,
    colour: Colour = Colour.RED,
) -> int:
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
        (
            {"weight": 1, "inner": 3},
            "model.inner",
            "must be {depth: int, kind: 'soft' | 'hard'}, got 3",
        ),
    ],
)
def test_a_trouble_within_a_mapping_names_the_field(model, place, message) -> None:
    assert troubles(model=model) == {place: message}


def test_enums_and_fields_that_may_be_absent_are_told_as_a_file_gives_them() -> None:
    told = "must be one of 'red' | 'blue', got 'RED'; did you mean 'red'?"
    assert troubles(typed={"note": 4}, colour="RED") == {
        "typed.note": "must be a text, got 4",
        "colour": told,
    }
    assert written_type(list[Colour | None]) == "list['red' | 'blue' | None]"
    assert as_given([Colour.RED, Inner(2), {"a": (1,)}]) == [
        "red", {"depth": 2, "kind": "soft"}, {"a": [1]},
    ]  # fmt: skip


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


def holds(
    image: int,
    *,
    cells: list[tuple[int, int]] | None = None,
    rows: list[int] | None = None,
    factors: dict[str, float] | None = None,
    names: dict[int, str] | None = None,
    around: tuple[float, ...] = (),
    texts: list[str] | None = None,
    n: int = 3,
    state: Literal["on", "off"] = "on",
    order: Literal[3, 4] = 3,
    version: Literal["3", "4"] = "3",
    title: str = "",
) -> int:
    """Take settings."""
    return image


QUOTED = "got the text '2'; without the quotes it is a number"


@pytest.mark.parametrize(
    ("given", "place", "message"),
    [
        ({"cells": [[1, "a"]]}, "cells.0.1", "must be a whole number, got 'a'"),
        ({"cells": [[1, 2.5]]}, "cells.0.1", "must be a whole number, got 2.5"),
        ({"cells": [[1]]}, "cells.0", "2 items needed, got 1"),
        ({"cells": [[1, 2, 3]]}, "cells.0", "2 items needed, got 3"),
        ({"cells": [[1, "2"]]}, "cells.0.1", f"must be a whole number, {QUOTED}"),
        ({"cells": [[1, True]]}, "cells.0.1", "must be a whole number, got True"),
        ({"rows": [1, "2"]}, "rows.1", f"must be a whole number, {QUOTED}"),
        ({"around": ["2"]}, "around.0", f"must be a number, {QUOTED}"),
        ({"around": [True]}, "around.0", "must be a number, got True"),
        ({"factors": {"a": "b"}}, "factors.a", "must be a number, got 'b'"),
        ({"factors": {"a": "2"}}, "factors.a", f"must be a number, {QUOTED}"),
        ({"names": {"a": "b"}}, "names.a", "its key must be a whole number, got 'a'"),
        ({"texts": [2]}, "texts.0", "must be a text, got 2"),
    ],
)
def test_what_is_wrong_within_a_list_or_mapping_is_told_in_words(given, place, message) -> None:
    _, found = validate_settings(read_signature("holds", holds), given)
    assert {".".join(map(str, path)): told for path, told in found} == {place: message}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"n": "1e1"}, "must be a whole number, got '1e1'; write 10"),
        ({"n": "2.5e3"}, "must be a whole number, got '2.5e3'; write 2500"),
        ({"n": "1e-1"}, "must be a whole number, got '1e-1'"),
        ({"n": "1e400"}, "must be a whole number, got '1e400'"),
        ({"n": "0,5"}, "must be a whole number, got '0,5'"),
        ({"n": "0.5"}, "must be a whole number, got the text '0.5'"),
        ({"n": "1e1 mm"}, "got '1e1 mm'; a number stands without its unit: 10"),
        ({"state": True}, "must be 'on' | 'off', got True; put it in quotes: 'on'"),
        ({"state": False}, "must be 'on' | 'off', got False; put it in quotes: 'off'"),
        ({"title": False}, "must be a text, got False; a text stands in quotes"),
        ({"order": "3"}, "must be one of 3 | 4, got '3'; without the quotes it is one: 3"),
        ({"version": 3}, "must be one of '3' | '4', got 3; put it in quotes: '3'"),
    ],
)
def test_what_to_write_instead_is_told_where_it_is_known(given, message) -> None:
    _, found = validate_settings(read_signature("holds", holds), given)
    assert len(found) == 1
    assert found[0][1].endswith(message)


def test_texts_that_look_like_numbers_stay_texts_where_texts_are_meant() -> None:
    values, found = validate_settings(
        read_signature("holds", holds), {"texts": ["2"], "names": {1: "2"}, "cells": [[1, 2]]}
    )
    assert not found
    assert (values["texts"], values["names"], values["cells"]) == (["2"], {1: "2"}, [(1, 2)])


def floats(
    image: int,
    *,
    plain: float = 1.0,
    span: tuple[float, float] = (0.0, 1.0),
    model: Outer | None = None,
    few: Annotated[float, Le(5.0)] = 1.0,
    most: float | None = None,
    anything: Any = None,
    table: dict[str, Any] | float = 1.0,
    cells: np.ndarray | None = None,
    some: frozenset[float] = frozenset(),
    title: str = "",
    open_end: float = math.nan,
) -> int:
    """Take numbers."""
    return image


@pytest.mark.parametrize(
    ("given", "place", "message"),
    [
        ({"plain": math.nan}, "plain", "must be a number, got nan"),
        ({"plain": np.float32("nan")}, "plain", "must be a number, got nan"),
        ({"plain": "nan"}, "plain", "must be a number, got the text 'nan'"),
        ({"span": [0, math.nan]}, "span.1", "must be a number, got nan"),
        ({"model": {"weight": math.nan}}, "model.weight", "must be a number, got nan"),
        ({"few": math.nan}, "few", "must be a number, got nan"),
        ({"most": math.nan}, "most", "must be a number or null, got nan"),
        ({"cells": [math.nan]}, "cells.0", "must be a number, got nan"),
        ({"some": [math.nan]}, "some.0", "must be a number, got nan"),
        ({"title": math.nan}, "title", "must be a text, got nan"),
    ],
)
def test_nan_is_no_number_for_any_setting(given, place, message) -> None:
    _, found = validate_settings(read_signature("floats", floats), given)
    assert {".".join(map(str, path)): told for path, told in found} == {place: message}


def ends(image: int, *, most: Annotated[float, AllowInfNan(False)] | Literal["auto"] = 1.0) -> int:
    """Take a number that has an end."""
    return image


def test_infinity_is_no_number_for_a_setting_that_has_an_end() -> None:
    _, found = validate_settings(read_signature("ends", ends), {"most": math.inf})
    assert found == [(("most",), "must be a finite number, got inf")]


def test_no_limit_and_a_default_that_is_nan_may_be_given() -> None:
    given = {"plain": math.inf, "span": [-math.inf, 1], "open_end": math.nan, "title": "nan"}
    values, found = validate_settings(read_signature("floats", floats), given)
    assert not found
    assert (values["plain"], values["span"][0], values["title"]) == (math.inf, -math.inf, "nan")


@pytest.mark.parametrize(
    "given",
    [{"anything": math.nan}, {"anything": {"a": [1, math.nan]}}, {"table": {"a": math.nan}}],
)
def test_nan_may_stand_where_anything_may(given) -> None:
    values, found = validate_settings(read_signature("floats", floats), given)
    assert not found
    assert repr({name: values[name] for name in given}) == repr(given)


class Odd(BaseModel):
    size: int = 3

    @field_validator("size")
    @classmethod
    def odd(cls, size: int) -> int:
        if size % 2 == 0:
            raise ValueError("size must be odd")
        return size


def weighs(
    image: int,
    *,
    w: np.ndarray = np.ones(3),  # noqa: B008
    exact: NDArray[np.float64] | None = None,
    odd: Odd | None = None,
) -> int:
    """Take arrays."""
    return image


def test_a_list_of_numbers_is_taken_where_an_array_is_meant() -> None:
    given = {"w": [[1, 2], [3, 4]], "exact": [1, 2]}
    values, found = validate_settings(read_signature("weighs", weighs), given)
    assert not found
    assert (values["w"].shape, values["w"].dtype) == ((2, 2), np.int64)
    assert (values["exact"].tolist(), values["exact"].dtype) == ([1.0, 2.0], np.float64)
    assert not values["w"].flags.writeable
    mine = np.ones(2)
    assert validate_settings(read_signature("weighs", weighs), {"w": mine})[0]["w"] is mine


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"w": [1, "a"]}, "must be a list of numbers, got [1, 'a']"),
        ({"w": [[1], [1, 2]]}, "must be a list of numbers, got [[1], [1, 2]]"),
        ({"w": "a"}, "must be a list of numbers, got 'a'"),
        ({"exact": "a"}, "must be a list of numbers or null, got 'a'"),
        ({"odd": {"size": 4}}, "size must be odd, got 4"),
    ],
)
def test_what_was_got_is_told_of_arrays_and_of_a_models_own_rules(given, message) -> None:
    _, found = validate_settings(read_signature("weighs", weighs), given)
    assert [told for _, told in found] == [message]


def holds_arrays(
    image: int,
    *,
    whole: NDArray[np.int32] | None = None,
    tiny: NDArray[np.uint8] | None = None,
    short: NDArray[np.float32] | None = None,
    mask: NDArray[np.bool_] | None = None,
    free: np.ndarray | None = None,
) -> int:
    """Take arrays that say what they hold."""
    return image


@pytest.mark.parametrize(
    ("name", "given", "kept"),
    [
        ("whole", [-1, 2.0, "3e3"], [-1, 2, 3000]),
        ("tiny", [[1, 255]], [[1, 255]]),
        ("tiny", [], []),
        ("short", [0.1, math.inf, 2**64], [np.float32(0.1), math.inf, 2.0**64]),
        ("short", ["3.4028235e38"], [np.finfo(np.float32).max]),
        ("mask", [True, False], [True, False]),
        ("free", ["1e-2", 1], [0.01, 1.0]),
    ],
)
def test_an_array_holds_the_numbers_of_the_file_as_its_type_says(name, given, kept) -> None:
    kinds = {"whole": np.int32, "tiny": np.uint8, "short": np.float32, "mask": np.bool_}
    values, found = validate_settings(read_signature("holds", holds_arrays), {name: given})
    assert not found
    assert values[name].dtype == kinds.get(name, np.float64)
    assert values[name].tolist() == kept


INT32 = "whole numbers from -2147483648 to 2147483647 (int32)"


@pytest.mark.parametrize(
    ("name", "given", "message"),
    [
        ("whole", [1, 3000000000], f"{INT32}, got 3000000000"),
        ("whole", [1, 1.5], f"{INT32}, got 1.5"),
        ("tiny", [1, 300], "whole numbers from 0 to 255 (uint8), got 300"),
        ("tiny", [1, math.inf], "whole numbers from 0 to 255 (uint8), got inf"),
        ("short", [1, 1e39], "numbers up to 3.4e+38 (float32), got 1e+39"),
        ("short", [10**400], f"numbers up to 3.4e+38 (float32), got {shown(10**400)}"),
        ("short", [True, False], f"a list of numbers or null, got {shown([True, False])}"),
        ("mask", [1, 0], "a list of numbers or null, got [1, 0]"),
        ("free", [True, 2], f"a list of numbers or null, got {shown([True, 2])}"),
        ("free", ["0.2", 2], "a list of numbers or null, got ['0.2', 2]"),
    ],
)
def test_an_array_refuses_numbers_that_its_type_cannot_hold(name, given, message) -> None:
    _, found = validate_settings(read_signature("holds", holds_arrays), {name: given})
    assert found == [((name,), f"must be {message}")]
