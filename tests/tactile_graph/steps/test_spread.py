"""Settings that steps share: a dataclass of them, flat in YAML, whole in the step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np
import pytest
from annotated_types import Ge

from tactile_graph import Frame
from tactile_graph.engine.calls.sources import open_source
from tactile_graph.errors import Mark, PluginError
from tactile_graph.pipeline.graph import Source
from tactile_graph.steps import Report, Spread
from tactile_graph.steps.settings import validate_settings
from tactile_graph.steps.signature import read_signature


@dataclass(frozen=True)
class Common:
    """What both take.

    Parameters
    ----------
    level : float
        From which a cell counts.
    names : list of str
        Which cells.
    """

    level: Annotated[float, Ge(0)] = 0.5
    names: list[str] = field(default_factory=list)
    reach: int = 1

    def __post_init__(self) -> None:
        if self.reach > 9:
            raise ValueError(f"reach: must be at most 9, got {self.reach}")


@dataclass(frozen=True)
class Wider(Common):
    """The same, reaching farther.

    Parameters
    ----------
    reach : int
        In cells.
    """

    reach: int = 3


ROUGH = Common(level=0.9, reach=2)


def whole(number: int, *, own: int = 7, common: Annotated[Common, Spread()] = Common()) -> int:
    """Return a sum."""
    return number + own + int(10 * common.level) + 100 * common.reach


class Part:
    """Keep two of them."""

    def __init__(
        self, *, common: Annotated[Common, Spread("reach", "level")] = ROUGH, own: int = 7
    ) -> None:
        self.common, self.own = common, own

    def __call__(self, number: int) -> float:
        """Return the level."""
        return self.common.level


def source(*, common: Annotated[Wider, Spread("reach")]) -> Iterator[Frame]:
    """Yield a frame."""
    yield Frame.of(np.full((1, 1), common.reach), (1.0, 1.0), (0.0, 0.0), "raw", index=0)


def test_the_fields_are_settings_where_the_dataclass_stands() -> None:
    settings = read_signature("whole", whole).settings
    assert [s.name for s in settings] == ["own", "level", "names", "reach"]
    assert [s.default for s in settings] == [7, 0.5, [], 1]
    assert settings[1].annotation == Annotated[float, Ge(0)]


def test_those_named_are_settings_in_that_order_with_the_defaults_of_the_step() -> None:
    settings = read_signature("part", Part).settings
    assert [(s.name, s.default) for s in settings] == [("reach", 2), ("level", 0.9), ("own", 7)]


def test_the_docstring_of_the_dataclass_says_what_they_mean() -> None:
    meanings = {s.name: s.meaning for s in read_signature("whole", whole).settings}
    assert meanings == {
        "own": "", "level": "From which a cell counts.", "names": "Which cells.", "reach": ""
    }  # fmt: skip
    (wider,) = read_signature("source", source).settings
    assert wider.meaning == "In cells."


def test_the_step_is_handed_the_dataclass() -> None:
    signature = read_signature("part", Part)
    arguments = signature.arguments({"reach": 5, "own": 1})
    assert arguments == {"own": 1, "common": Common(level=0.9, reach=5)}
    assert Part(**arguments)(3) == 0.9


def test_ranges_and_unknown_names_are_told_as_of_any_setting() -> None:
    signature = read_signature("whole", whole)
    _, troubles = validate_settings(signature, {"level": -1.0, "rech": 1})
    words = [text for _, text in troubles]
    assert words[0].startswith("unknown setting 'rech'")
    assert "reach" in words[0]
    assert words[1] == "must be >= 0.0, got -1.0"


def test_a_source_takes_them_too() -> None:
    declared = Source(read_signature("source", source), {"reach": 4}, Mark("", 0, 0))
    (frame,) = open_source(declared, 0, Report())
    assert frame.image.values == [[4]]


def test_what_the_dataclass_refuses_is_refused() -> None:
    signature = read_signature("whole", whole)
    with pytest.raises(ValueError, match="reach: must be at most 9, got 10"):
        signature.arguments({"reach": 10})


def bare(*, common: Annotated[int, Spread()] = 1) -> int:
    """Return nothing of use."""
    return common


def lost(*, common: Annotated[Common, Spread("reech")] = ROUGH) -> int:
    """Return nothing of use."""
    return common.reach


def twice(*, reach: int = 1, common: Annotated[Common, Spread()] = ROUGH) -> int:
    """Return nothing of use."""
    return reach + common.reach


@pytest.mark.parametrize(
    ("target", "what"),
    [
        (bare, "'common' is spread, but its type is no dataclass"),
        (lost, "'common' spreads 'reech', which Common has not"),
        (twice, "it has two settings named 'reach'"),
    ],
)
def test_what_cannot_be_spread_is_refused(target: object, what: str) -> None:
    with pytest.raises(PluginError, match=what):
        read_signature("step", target)  # type: ignore[arg-type]
