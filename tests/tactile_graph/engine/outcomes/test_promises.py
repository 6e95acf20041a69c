"""A step that gives something else than it promises is told so at once, with node and plugin."""

from __future__ import annotations

import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import pytest

from tactile_graph import Circle, Degenerate, Ellipse, Frame, Image, Mask, hookimpl, loads
from tactile_graph.engine.outcomes.promises import misfit
from tactile_graph.errors import PluginError
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps import Grid, Quantity

CIRCLE = Circle(1.0, 2.0, 3.0)
MASK = Mask(np.ones((2, 3), dtype=bool))


class Two(NamedTuple):
    mask: Mask
    level: float | None


def wrong(image: Image) -> Circle:
    return image  # type: ignore[return-value]


def later(image: Image) -> Circle:
    if image.peak == 0.0:
        raise Degenerate("nothing there")
    return image  # type: ignore[return-value]


def smaller(image: Image) -> Annotated[Image, Grid.like("image")]:
    return Image(np.ones((1, 1)))


def finer(
    image: Image, *, factor: int = 2
) -> Annotated[Image, Grid.like("image", finer_by="factor")]:
    return image


def heavier(image: Image) -> Annotated[Image, Quantity.like("image")]:
    return image.with_values(image.values, quantity="gram")


def volts(image: Image) -> Annotated[Image, Quantity("volt", "siemens")]:
    return image


def flat(image: Image) -> Image:
    return image.with_values(image.values.ravel())


def objects(image: Image) -> Image:
    return image.with_values(image.values.astype(object))


def each(level: float) -> float:
    return "x"  # type: ignore[return-value]


def right(image: Image) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    return image


def numbers(image: Image) -> list[float]:
    return [1.0, 2.0]


class Lacking:
    columns_shown = ("x_cm", "y_mm")

    def __init__(self) -> None:
        self.x_cm, self.y_cm = 1.0, 2.0


def lacking(image: Image) -> list[Lacking]:
    return [Lacking()]


class Told:
    @property
    def columns_shown(self) -> tuple[str, ...]:
        return ("x_cm",)


def odd(image: Image) -> Any:
    return Told()


def source() -> Iterator[Frame]:
    yield Frame.of(np.ones((2, 2)), quantity="volt")


STEPS = {
    f.__name__: f
    for f in (
        *(wrong, later, smaller, finer, heavier, volts, flat, objects, each, right),
        *(numbers, lacking, odd, source),
    )
}


@pytest.fixture
def registry() -> Registry:
    module = types.ModuleType("promising")

    @hookimpl
    def tactile_graph_steps() -> Mapping[str, Callable[..., Any]]:
        return STEPS

    module.tactile_graph_steps = tactile_graph_steps  # type: ignore[attr-defined]
    return Registry([("mine", "my-package", "1", lambda: module)])


def text(step: str) -> str:
    return f"{{pipeline: p, nodes: {{a: {{step: {step}, in: frame}}}}, outputs: [a]}}"


@pytest.mark.parametrize(
    ("step", "message"),
    [
        ("wrong", "promises Circle, but gave Image of 2 x 3"),
        ("smaller", "promises 2 x 3 cells, but gave 1 x 1"),
        ("finer", "promises 4 x 6 cells, but gave 2 x 3"),
        ("heavier", "promises raw, but gave gram"),
        ("volts", "promises volt or siemens, but gave raw"),
        ("flat", r"gave values of shape \(6,\), not \(rows, columns\)"),
        ("objects", "gave values of type object, not numbers"),
        ("lacking", "gave Lacking, which lacks 'y_mm' of its columns_shown; did you mean 'y_cm'"),
        ("odd", "gave Told, which has a property as its columns_shown: it must be a tuple of"),
    ],
)
def test_a_broken_promise_names_node_step_plugin_and_place(
    registry: Registry, step: str, message: str
) -> None:
    pipeline = loads(text(step), "p.yaml", registry)
    place = rf"^node 'a': step '{step}' of plugin 'mine' \(package my-package\) \(.*\.py:\d+\) "
    for _ in range(2):  # the first telling changes nothing
        with pytest.raises(PluginError, match=place + message):
            pipeline.run(np.ones((2, 3)))
    with pytest.raises(PluginError, match=message):
        next(iter(pipeline.stream([np.ones((2, 3))])))


def test_a_promise_is_held_to_the_first_value_whenever_it_comes(registry: Registry) -> None:
    results = loads(text("later"), "p.yaml", registry).stream([np.zeros((2, 2)), np.ones((2, 2))])
    assert not next(results).ok
    with pytest.raises(PluginError, match="promises Circle, but gave Image"):
        next(results)


def test_a_kept_promise_is_not_looked_at_again(registry: Registry) -> None:
    pipeline = loads(text("right"), "p.yaml", registry)
    pipeline.run(np.ones((2, 2)))
    assert pipeline.promises.waiting == []


def test_each_item_of_a_list_is_promised(registry: Registry) -> None:
    nodes = "{n: {step: numbers, in: frame}, a: {step: each, in: n, each: true}}"
    pipeline = loads(f"{{pipeline: p, nodes: {nodes}, outputs: [a]}}", "p.yaml", registry)
    with pytest.raises(PluginError, match=r"promises list\[float\], but gave a tuple of str"):
        pipeline.run(np.ones((2, 2)))


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (np.float32(1.0), float), (3, float), (np.int64(3), int), (np.True_, bool), ("a", str),
        ((CIRCLE,), list[Circle]), ([CIRCLE], tuple[Circle, ...]), ((), Sequence[Circle]),
        (np.ones(3), Sequence[float]), ((1, "a"), tuple[int, str]), (None, None),
        (CIRCLE, Circle | Ellipse), ("b", Literal["a", "b"]), ({"a": 1}, dict[str, int]),
        (Two(MASK, None), Two), (CIRCLE, Any), (np.ones(3), np.ndarray),
        ({1, 2}, set[int]), (frozenset("a"), frozenset[str]),
    ],
)  # fmt: skip
def test_what_fits_a_type(value: Any, kind: Any) -> None:
    assert misfit(value, kind) == ""


@pytest.mark.parametrize(
    ("value", "kind", "message"),
    [
        (True, float, "promises float, but gave bool"),
        (1.5, int, "promises int, but gave float"),
        ([1], set[int], "promises set[int], but gave a list of int"),
        ({1}, list[int], "promises list[int], but gave set"),
        ("ab", list[str], "promises list[str], but gave str"),
        ((c for c in [CIRCLE]), Iterable[Circle], "promises Iterable[Circle], but gave generator"),
        ([CIRCLE, None], list[Circle], "promises list[Circle], but gave a list of Circle, Non"),
        ((1, 2), tuple[int, str], "promises tuple[int, str], but gave a tuple of int"),
        ("c", Literal["a", "b"], "promises 'a' | 'b', but gave str"),
        ((MASK, 1.0), Two, "promises Two, but gave a tuple of Mask, float"),
        (Two(CIRCLE, 1.0), Two, "promises Mask, but gave Circle as .mask"),  # type: ignore[arg-type]
        (np.ones((2, 2)), Image, "promises Image, but gave ndarray of 2 x 2"),
    ],
)
def test_what_fits_no_type_says_what_it_is(value: Any, kind: Any, message: str) -> None:
    assert misfit(value, kind).startswith(message)


def test_frames_may_be_checked_by_several_threads_at_once(registry: Registry) -> None:
    pipeline = loads(text("right"), "p.yaml", registry)
    result = pipeline.runner()(Frame.of(np.ones((2, 2))))
    promises = pipeline.promises

    class Meanwhile:
        """A result that another thread checks while it is being checked."""

        def __getattr__(self, name: str) -> Any:
            promises.check(result)
            return getattr(result, name)

    promises.check(Meanwhile())  # type: ignore[arg-type]
    assert promises.waiting == []
