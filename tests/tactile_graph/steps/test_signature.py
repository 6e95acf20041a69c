"""What a step needs and gives is read from its signature; what is no step is told why."""

from __future__ import annotations

import functools
from collections.abc import AsyncIterator, Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Optional

import numpy as np
import pytest
from annotated_types import Gt

from tactile_graph import Circle, Frame, Image, Mask
from tactile_graph.errors import PluginError
from tactile_graph.steps import Grid, Quantity, Report, TimeGap
from tactile_graph.steps.signature import Kind, list_item, read_signature, type_name

if TYPE_CHECKING:
    from decimal import Decimal


class Two(NamedTuple):
    mask: Mask
    count: int


def function(
    image: Annotated[Image, Quantity("volt"), Grid(min_rows=3)],
    masks: list[Mask],
    other: Annotated[Mask, Grid.like("image")] | None = None,
    *,
    level_v: Annotated[float | None, Gt(0), Quantity("volt", of="image")] = None,
    name: str,
    rng: np.random.Generator,
) -> Annotated[Image, Quantity.like("image"), Grid.like("image", finer_by=2)]:
    """Say what comes out,
    in one sentence.

    And more.
    """
    raise NotImplementedError


def test_a_functions_ports_settings_and_output_are_read() -> None:
    s = read_signature("function", function)
    assert (s.kind, s.stateful, s.rng, s.report, s.gap) == (Kind.FUNCTION, False, "rng", "", "")
    assert [(p.name, p.required, p.item) for p in s.ports] == [
        ("image", True, None),
        ("masks", True, Mask),
        ("other", False, None),
    ]
    assert s.ports[0].type is Image
    assert s.ports[0].quantity == Quantity("volt")
    assert s.ports[0].grid == Grid(min_rows=3)
    assert [(x.name, x.required) for x in s.settings] == [("level_v", False), ("name", True)]
    assert s.settings[0].quantity == Quantity("volt", of="image")
    assert (s.output, s.output_quantity) == (Image, Quantity.like("image"))
    assert s.output_grid == Grid.like("image", finer_by=2)
    assert s.summary == "Say what comes out, in one sentence."
    assert s.doc.endswith("And more.")
    assert s.port("masks") is s.ports[1]
    assert s.port("nope") is None


def test_a_rule_inside_an_optional_port_is_found() -> None:
    assert read_signature("function", function).ports[2].grid == Grid.like("image")


def test_a_namedtuple_gives_named_outputs() -> None:
    def split(image: Image) -> Two:
        raise NotImplementedError

    assert read_signature("split", split).fields == ("mask", "count")


def test_a_class_takes_settings_at_init_and_ports_at_call() -> None:
    class Smooth:
        """Smooth frames."""

        def __init__(self, *, n: int = 3, rng: np.random.Generator) -> None: ...

        def __call__(self, image: Image, *, gap: TimeGap) -> Image:
            return image

    s = read_signature("smooth", Smooth)
    assert (s.kind, s.stateful, s.gap, s.rng, s.rng_at_init) == (
        Kind.CLASS,
        True,
        "gap",
        "rng",
        True,
    )
    assert [p.name for p in s.ports] == ["image"]
    assert [x.name for x in s.settings] == ["n"]
    assert s.output is Image


def test_only_a_methods_instance_is_no_parameter_whatever_it_is_called() -> None:
    def step(image: Image, *, self: float = 1.0) -> float:
        return self

    class This:
        def __init__(this, *, n: int = 3) -> None: ...  # noqa: N805

        def __call__(this, image: Image) -> float:  # noqa: N805
            return 1.0

    assert [s.name for s in read_signature("step", step).settings] == ["self"]
    this = read_signature("this", This)
    assert ([p.name for p in this.ports], [s.name for s in this.settings]) == (["image"], ["n"])


def test_a_class_without_init_or_with_a_dataclasses_init_is_fine() -> None:
    class Bare:
        def __call__(self, image: Image) -> int:
            return 1

    assert read_signature("bare", Bare).settings == ()
    assert read_signature("rich", Rich).settings[0].name == "n"


@dataclass
class Rich:
    n: int = 1

    def __call__(self, image: Image) -> int:
        return self.n


@pytest.mark.parametrize("takes", ["nothing", "gap", "rng"])
def test_a_stateless_class_keeps_a_state_all_the_same_if_it_asks_for_one(takes: str) -> None:
    class Plain:
        stateless = True

        def __call__(self, image: Image) -> int:
            return 1

    class Gap:
        stateless = True

        def __call__(self, image: Image, *, gap: TimeGap) -> int:
            return 1

    class Rng:
        stateless = True

        def __init__(self, *, rng: np.random.Generator) -> None: ...

        def __call__(self, image: Image) -> int:
            return 1

    kinds = {"nothing": Plain, "gap": Gap, "rng": Rng}
    assert read_signature("x", kinds[takes]).stateful is (takes != "nothing")


@pytest.mark.parametrize("form", [Iterator[Frame], Generator[Frame, None, None]])
def test_a_generator_function_is_a_source(form: Any) -> None:
    def frames(*, n: int = 1, report: Report, rng: np.random.Generator):  # type: ignore[no-untyped-def]
        yield Frame.of(np.ones((1, 1)))

    frames.__annotations__["return"] = Annotated[form, Quantity("volt")]
    s = read_signature("frames", frames)
    assert (s.kind, s.report, s.rng) == (Kind.SOURCE, "report", "rng")
    assert (s.output, s.output_quantity) == (Frame, Quantity("volt"))


def test_a_wrapped_function_is_read_through_its_wrapper() -> None:
    @functools.wraps(function)
    def wrapper(*args: Any, **kwargs: Any) -> Any:
        return function(*args, **kwargs)

    assert read_signature("w", wrapper).ports == read_signature("f", function).ports


# -- what is no step ---------------------------------------------------------------------------


def unannotated(image) -> Image:  # type: ignore[no-untyped-def]
    return image  # type: ignore[no-any-return]


def no_return(image: Image):  # type: ignore[no-untyped-def]
    return image


def star(*images: Image) -> Image:
    return images[0]


def stars(image: Image, **rest: Any) -> Image:
    return image


def positional(image: Image, /) -> Image:
    return image


def hidden_type(image: Image, *, n: Decimal) -> Image:
    return image


def misspelt(image: Imgae) -> Image:  # type: ignore[name-defined]  # noqa: F821
    return image  # type: ignore[no-any-return]


def source_with_port(image: Image) -> Iterator[Frame]:
    yield Frame(image)


def source_of_nothing(*, n: int = 1) -> list[Frame]:
    yield Frame.of(np.ones((1, 1)))  # type: ignore[misc]


def gap_in_function(image: Image, *, gap: TimeGap) -> Image:
    return image


async def coroutine(image: Image) -> Image:
    return image


async def async_source() -> AsyncIterator[Frame]:
    yield Frame.of(np.ones((1, 1)))


class NoCall:
    pass


class SettingAtCall:
    def __call__(self, image: Image, *, n: int) -> Image:
        return image


class ReportInClass:
    def __init__(self, *, report: Report) -> None: ...

    def __call__(self, image: Image) -> Image:
        return image


class GapAtInit:
    def __init__(self, *, gap: TimeGap) -> None: ...

    def __call__(self, image: Image) -> Image:
        return image


class StarInit:
    def __init__(self, **rest: int) -> None: ...

    def __call__(self, image: Image) -> Image:
        return image


@pytest.mark.parametrize(
    ("target", "message"),
    [
        (3, "step 'x': 3 is not a function or class"),
        (unannotated, "step 'x': parameter 'image' has no annotation"),
        (no_return, "step 'x': it has no return annotation"),
        (star, r"step 'x': \*args and \*\*kwargs cannot be wired; name each parameter"),
        (stars, r"\*args and \*\*kwargs cannot be wired"),
        (positional, "step 'x': 'image' is wired by name; take the '/' away"),
        (hidden_type, "step 'x': its annotations cannot be read: name 'Decimal' is not defined"),
        (misspelt, "its annotations cannot be read: name 'Imgae' is not defined"),
        (source_with_port, "step 'x': a source takes no ports, but 'image' is positional"),
        (source_of_nothing, r"step 'x': a source returns Iterator\[Frame\]"),
        (gap_in_function, "step 'x': only a class's __call__ can take a TimeGap"),
        (coroutine, "step 'x': an 'async' function cannot be a step"),
        (async_source, "step 'x': an 'async' function cannot be a step"),
        (NoCall, "step 'x': class NoCall has no __call__ for its ports"),
        (SettingAtCall, "step 'x': setting 'n' belongs into __init__, not __call__"),
        (ReportInClass, "a TimeGap goes to __call__, a Report only to a source"),
        (GapAtInit, "a TimeGap goes to __call__, a Report only to a source"),
        (StarInit, r"\*args and \*\*kwargs cannot be wired"),
        (print, "step 'x': "),
        (max, "step 'x': "),
        (int, "step 'x': class int has no __call__"),
        (functools.partial(function), r"step 'x': functools\.partial.* write one around it"),
    ],
    ids=lambda v: getattr(v, "__name__", None) or type(v).__name__,
)
def test_what_is_no_step_is_told_why(target: Any, message: str) -> None:
    with pytest.raises(PluginError, match=message):
        read_signature("x", target)


# -- types -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "item"),
    [
        (list[Mask], Mask),
        (tuple[Mask, ...], Mask),
        (Sequence[Mask], Mask),
        (list[Mask] | None, Mask),
        (tuple[Mask, int], None),
        (Mask, None),
        (dict[str, Mask], None),
        (Two, None),
        (list, None),
    ],
)
def test_list_ports_are_told_by_their_item(kind: Any, item: Any) -> None:
    assert list_item(kind) is item


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        (list[Circle], "list[Circle]"),
        (Image | Mask, "Image | Mask"),
        (Optional[int], "int | None"),  # noqa: UP045
        (Literal["a", 1], "'a' | 1"),
        (Annotated[float, Gt(0)], "float"),
        (tuple[int, ...], "tuple[int, ...]"),
        (dict[str, list[int]], "dict[str, list[int]]"),
        (type(None), "None"),
        (Any, "Any"),
    ],
)
def test_types_are_named_as_a_person_would(kind: Any, name: str) -> None:
    assert type_name(kind) == name
