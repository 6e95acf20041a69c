"""A step whose defaults or rules contradict it is refused, with what is wrong and what is near."""

from __future__ import annotations

import dataclasses
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, TypedDict

import pytest
from annotated_types import Ge, Len, Lt, MinLen, MultipleOf
from pydantic import Field, StringConstraints
from typing_extensions import TypedDict as ExtendedTypedDict

from helpers_graphs import registry
from tactile_graph import Circle, Frame, Image, Mask, loads
from tactile_graph.errors import PipelineError, PluginError
from tactile_graph.plugins.registry import installed
from tactile_graph.schema import pipeline_schema
from tactile_graph.steps import Grid, Quantity
from tactile_graph.steps.checks import check_signature
from tactile_graph.steps.signature import read_signature
from tactile_graph.steps.stacked import stacked_kinds
from tactile_graph.wires.stacks import Stack


def below(image: Image, *, level: Annotated[int, Ge(3)] = 1) -> Image:
    return image


def inside_union(image: Image, *, level: Annotated[float, Lt(1)] | None = 1.5) -> Image:
    return image


def around_union(image: Image, *, level: Annotated[float | None, Lt(1)] = 1.5) -> Image:
    return image


def odd(image: Image, *, level: Annotated[int, MultipleOf(2), Ge(0)] = 3) -> Image:
    return image


def field(image: Image, *, level: Annotated[float, Field(gt=0)] = -1.0) -> Image:
    return image


def single(
    image: Image,
    *,
    both: Annotated[list[float], Len(2, 2)] = [1.0],  # noqa: B006
) -> Image:
    return image


def short(image: Image, *, name: Annotated[str, MinLen(3)] = "a") -> Image:
    return image


def pattern(image: Image, *, name: Annotated[str, StringConstraints(pattern="b+")] = "a") -> Image:
    return image


def text(image: Image, *, level: int = "x") -> Image:  # type: ignore[assignment]
    return image


def yes(image: Image, *, level: float = True) -> Image:
    return image


def none(image: Image, *, level: float = None) -> Image:  # type: ignore[assignment] # noqa: RUF013
    return image


def choice(image: Image, *, mode: Literal["a", "b"] = "c") -> Image:  # type: ignore[assignment]
    return image


def quantity(image: Image) -> Annotated[Image, Quantity.like("img")]:
    return image


def grid(image: Image, *, factor: int = 2) -> Annotated[Image, Grid.like("image", "factr")]:
    return image


def setting(
    image: Image, *, level_v: Annotated[float, Quantity("volt", of="picture")] = 1.0
) -> Image:
    return image


def port(image: Image, mask: Annotated[Mask, Grid.like("pad")]) -> Image:
    return image


def misspelt(image: Annotated[Image, Quantity("volts")]) -> Image:
    return image


def maybe(image: Image) -> Circle | None:
    return None


def returned(*, n: int = 3) -> Iterator[Frame]:
    return iter([])


@pytest.mark.parametrize(
    ("target", "message"),
    [
        (below, "step 'x': default of setting 'level' must be >= 3, got 1"),
        (inside_union, "step 'x': default of setting 'level' must be < 1, got 1.5"),
        (around_union, "step 'x': default of setting 'level' must be < 1, got 1.5"),
        (odd, "step 'x': default of setting 'level' must be a multiple of 2, got 3"),
        (field, "step 'x': default of setting 'level' must be > 0.0, got -1.0"),
        (single, "default of setting 'both' list should have at least 2 items"),
        (short, "default of setting 'name' must be a text, got 'a' (String should have at least 3"),
        (pattern, "default of setting 'name' must be a text, got 'a' (String should match"),
        (text, "step 'x': default of setting 'level' must be int, got 'x'"),
        (yes, "step 'x': default of setting 'level' must be float, got True"),
        (none, "'level' must be float, or the annotation float | None, got None"),
        (choice, "default of setting 'mode' must be one of 'a' | 'b', got 'c'"),
        (
            quantity,
            "the Quantity of the return names 'img', which is no port; did you mean 'image'?",
        ),
        (grid, "names 'factr', which is no setting; did you mean 'factor'?"),
        (setting, "the Quantity of setting 'level_v' names 'picture', which is no port"),
        (port, "the Grid of port 'mask' names 'pad', which is no port; ports: image, mask"),
        (
            misspelt,
            "step 'x': port 'image': unknown quantity 'volts'; did you mean 'volt'?",
        ),
        (maybe, "it may return None (Circle | None): where there is no answer, raise Degenerate"),
        (returned, "it promises frames, but is no generator function: yield them"),
    ],
    ids=lambda v: getattr(v, "__name__", ""),
)
def test_what_contradicts_itself_is_told(target: Callable[..., Any], message: str) -> None:
    with pytest.raises(PluginError) as caught:
        check_signature(read_signature("x", target))
    assert message in str(caught.value)


def fine(
    image: Image,
    *,
    whole: float = 1,
    level: Annotated[float, Ge(0)] | None = None,
    place: tuple[float, float] | None = None,
    path: Path = Path("x"),
    anything: Any = None,
    mode: Literal["a", 3] = 3,
    factor: Annotated[int, Ge(1)] = 2,
    even: Annotated[int, MultipleOf(2)] | None = None,
    names: Annotated[tuple[str, ...], MinLen(1)] = ("a",),
) -> Annotated[Image, Quantity.like("image"), Grid.like("image", finer_by="factor")]:
    return image


def sink(image: Image) -> None: ...


@pytest.mark.parametrize("target", [fine, sink])
def test_what_holds_together_is_let_through(target: Callable[..., Any]) -> None:
    check_signature(read_signature("x", target))


def test_every_installed_step_holds_together() -> None:
    found = installed()
    assert [found.step(name).name for name in found.names("steps")] == found.names("steps")


class Bare(TypedDict, total=False):
    level: float


class Fit(ExtendedTypedDict, total=False):
    level: float


def with_bare(image: Image, *, named: dict[str, list[Bare]] = {}) -> Image:  # noqa: B006
    return image


def with_fit(image: Image, *, level: Fit = {}) -> Image:  # noqa: B006
    return image


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="Python 3.12 has what is needed of it")
def test_a_typed_dict_that_cannot_be_checked_is_told_to_the_author() -> None:
    told = r"^step 'x': setting 'named': Bare is a typing.TypedDict, .* TypedDict of typing_ext"
    with pytest.raises(PluginError, match=told):
        check_signature(read_signature("x", with_bare))
    check_signature(read_signature("x", with_fit))


def plain_form(image):  # type: ignore[no-untyped-def]
    return image


def frames_form(image: list[Image]) -> Any:
    return image


def absent_form(image: Absent) -> Any:  # type: ignore[name-defined]  # noqa: F821
    return image


def any_form(image: Any) -> Any:
    return image


@pytest.mark.parametrize(
    ("form", "message"),
    [
        (plain_form, "its stacked form must annotate each port with the stack it takes: 'image'"),
        (frames_form, r"its stacked form: port 'image' is list\[Image\], which is no type of"),
        (absent_form, "its stacked form has no annotations that can be read: name 'Absent'"),
    ],
)
def test_a_stacked_form_must_say_which_stacks_it_takes(form: Any, message: str) -> None:
    def largest(image: Image) -> float:
        return float(image.values.max())

    largest.stacked = form  # type: ignore[attr-defined]
    with pytest.raises(PluginError, match=f"step 'x': {message}"):
        check_signature(read_signature("x", largest))


@pytest.mark.parametrize("own", [False, 3, "wide"])
def test_an_attribute_of_a_plugins_own_is_no_stacked_form(own: Any) -> None:
    class Largest:
        stacked = own

        def __call__(self, image: Image) -> float:
            return float(image.values.max())

    signature = read_signature("x", Largest)
    check_signature(signature)
    assert stacked_kinds(signature) is None


def test_a_stacked_form_that_takes_anything_takes_any_stack() -> None:
    def largest(image: Image) -> float:
        return float(image.values.max())

    largest.stacked = any_form  # type: ignore[attr-defined]
    assert stacked_kinds(read_signature("x", largest)) == {"image": Stack}


@dataclasses.dataclass
class Lacking:
    x_cm: float
    columns_shown: ClassVar[tuple[str, ...]] = ("x_cm", "x_mm")


@dataclasses.dataclass
class Whole(Lacking):
    @property
    def x_mm(self) -> float:
        return 10.0 * self.x_cm


class Told:
    @property
    def columns_shown(self) -> tuple[str, ...]:
        return ("x_cm",)


def test_columns_that_are_no_names_are_told_to_the_author() -> None:
    def gives(image: Image) -> list[Told]:
        return []

    text = "pipeline: p\nnodes: {a: {step: gives, in: frame}}\noutputs: [a]"
    told = (
        "step 'gives': its answer Told has a property as its columns_shown: it must be a tuple "
        r"of names, the class's own \(plugin 'test', package test-package\)"
    )
    found = registry({"gives": gives})
    with pytest.raises(PipelineError, match=told):
        loads(text, "p.yaml", found)
    _, troubles = pipeline_schema(found)
    assert len(troubles) == 1
    assert re.fullmatch(told, troubles[0])


def test_a_dataclass_has_the_columns_it_shows() -> None:
    def lacks(image: Image) -> list[Lacking]:
        return []

    def has(image: Image) -> Whole:
        return Whole(1.0)

    check_signature(read_signature("x", has))
    told = "its answer Lacking lacks 'x_mm' of its columns_shown; did you mean 'x_cm'"
    with pytest.raises(PluginError, match=told):
        check_signature(read_signature("x", lacks))
