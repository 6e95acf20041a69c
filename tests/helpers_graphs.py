"""Random pipelines over small integers: steps that note each call, and hypothesis strategies."""

from __future__ import annotations

import types
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import yaml
from annotated_types import Ge
from hypothesis import strategies as st

from helpers_naive import NaiveStep
from tactile_graph import Degenerate, Frame, Image, Skip, hookimpl
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps import TimeGap

DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
"""The quicker one, where the library has it; both write the same."""
CALLS: list[str] = []
"""The tags of the steps that were called, in order."""


class Pair(NamedTuple):
    low: int
    high: int
    note: int | None


def read(image: Image, *, tag: str = "") -> int:
    CALLS.append(tag)
    return int(image.values[0, 0])


def read_frame(frame: Frame, *, tag: str = "") -> int:
    CALLS.append(tag)
    return frame.index


def constant(*, value: int = 1, tag: str = "") -> int:
    CALLS.append(tag)
    return value


def add1(a: int, *, k: int = 1, tag: str = "") -> int:
    CALLS.append(tag)
    return a + k


def add2(a: int, b: int, *, tag: str = "") -> int:
    CALLS.append(tag)
    return a + 2 * b


def add3(a: int, b: int, c: int, *, tag: str = "") -> int:
    CALLS.append(tag)
    return a + 2 * b + 3 * c


def optional(a: int, b: int = 7, *, tag: str = "") -> int:
    CALLS.append(tag)
    return a - b


def options(a: int = 1, b: int = 2, *, tag: str = "") -> int:
    CALLS.append(tag)
    return 10 * a + b


def total(items: list[int], *, tag: str = "") -> int:
    CALLS.append(tag)
    return sum(items)


def total_of(a: int, items: list[int] = (), *, tag: str = "") -> int:  # type: ignore[assignment]
    CALLS.append(tag)
    return a + sum(items)


def pair(a: int, *, tag: str = "") -> Pair:
    CALLS.append(tag)
    return Pair(a % 3, a + 10, a if a % 2 else None)


def maybe(a: int | None, *, tag: str = "") -> int:
    CALLS.append(tag)
    return 5 if a is None else a


def many(a: int, *, tag: str = "") -> list[int]:
    CALLS.append(tag)
    return [a + i for i in range(a % 4)]


def picky(a: int, *, bad: Annotated[int, Ge(1)] = 2, tag: str = "") -> int:
    CALLS.append(tag)
    if a % bad == 0:
        raise Degenerate(f"{a} is a multiple of {bad}") if bad % 2 else ValueError(f"{a}!")
    return a


def shy(a: int, *, tag: str = "") -> int:
    CALLS.append(tag)
    if a % 3 == 0:
        raise Skip(f"{a} says nothing")
    return a


class Count:
    def __init__(self, *, tag: str = "") -> None:
        self.tag = tag
        self.n = 0

    def __call__(self, a: int, *, gap: TimeGap = None) -> int:
        CALLS.append(self.tag)
        self.n += a
        return self.n + (0 if gap is None else round(100 * gap))


def _naive_count(state: dict[str, Any], now: float, a: int) -> int:
    state["n"] = state.get("n", 0) + a
    gap = now - state.get("last", now)
    state["last"] = now
    return state["n"] + round(100 * gap)


def _naive_picky(a: int, bad: int = 2) -> int:
    if a % bad == 0:
        raise ValueError
    return a


def _naive_shy(a: int) -> int:
    if a % 3 == 0:
        raise Skip
    return a


STEPS: dict[str, Callable[..., Any]] = {
    f.__name__.lower(): f
    for f in (
        read,
        read_frame,
        constant,
        add1,
        add2,
        add3,
        optional,
        options,
        total,
        total_of,
        pair,
        maybe,
        many,
        picky,
        shy,
        Count,
    )
}

NAIVE = {
    "read": NaiveStep(("image",), lambda image: int(image.image.values[0, 0])),
    "read_frame": NaiveStep(("frame",), lambda frame: frame.index),
    "constant": NaiveStep((), lambda value=1: value),
    "add1": NaiveStep(("a",), lambda a, k=1: a + k),
    "add2": NaiveStep(("a", "b"), lambda a, b: a + 2 * b),
    "add3": NaiveStep(("a", "b", "c"), lambda a, b, c: a + 2 * b + 3 * c),
    "optional": NaiveStep(("a", "b"), lambda a, b: a - b, {"b": 7}),
    "options": NaiveStep(("a", "b"), lambda a, b: 10 * a + b, {"a": 1, "b": 2}),
    "total": NaiveStep(("items",), lambda items: sum(items)),
    "total_of": NaiveStep(("a", "items"), lambda a, items: a + sum(items), {"items": ()}),
    "pair": NaiveStep(("a",), lambda a: Pair(a % 3, a + 10, a if a % 2 else None)),
    "maybe": NaiveStep(("a",), lambda a: a),
    "many": NaiveStep(("a",), lambda a: tuple(a + i for i in range(a % 4))),
    "picky": NaiveStep(("a",), _naive_picky),
    "shy": NaiveStep(("a",), _naive_shy),
    "count": NaiveStep(("a",), _naive_count, stateful=True),
}


def registry(
    steps: Mapping[str, Any] = STEPS,
    pipelines: Mapping[str, Path] | None = None,
    plugin: str = "test",
) -> Registry:
    """Return a registry of one plugin, as if it were installed."""
    module = types.ModuleType(plugin)

    @hookimpl
    def tactile_graph_steps() -> Mapping[str, Any]:
        return steps

    @hookimpl
    def tactile_graph_pipelines() -> Mapping[str, Path]:
        return pipelines or {}

    module.tactile_graph_steps = tactile_graph_steps  # type: ignore[attr-defined]
    module.tactile_graph_pipelines = tactile_graph_pipelines  # type: ignore[attr-defined]
    return Registry([(plugin, f"{plugin}-package", "1.0", lambda: module)])


def frame(number: float, index: int = 0, time_s: float | None = None, **rest: Any) -> Frame:
    """Return a frame of 2 x 2 cells that hold one number."""
    return Frame.of(np.full((2, 2), float(number)), 1.0, index=index, time_s=time_s, **rest)


def shown(document: dict[str, Any]) -> str:
    return yaml.dump(document, Dumper=DUMPER, sort_keys=False)


# -- strategies ------------------------------------------------------------------------------

INTS = (
    "add1",
    "add2",
    "add3",
    "optional",
    "options",
    "total",
    "total_of",
    "picky",
    "shy",
    "maybe",
    "count",
    "read",
    "read_frame",
    "constant",
    "first_of",
    "pair",
    "many",
    "many",
    "each",
    "each",
    "use",
)


class _Grower:
    """Draws one node after the other, wiring each to those before it."""

    def __init__(self, draw: Callable[..., Any], prefix: str, library: dict[str, Any]) -> None:
        self.draw = draw
        self.library = library
        self.prefix = prefix
        self.nodes: dict[str, Any] = {}
        self.conditions: dict[str, str] = {}
        self.ints: list[str] = ["frame.index"]
        self.unsure: list[str] = []
        self.lists: list[str] = []

    def some(self, options: list[str]) -> str:
        # The late ones more often: long graphs tell more than broad ones.
        n = len(options)
        return options[max(self.draw(st.integers(0, n - 1)), self.draw(st.integers(0, n - 1)))]

    def grow(self, number: int) -> None:
        name = f"n{number}"
        kind = self.draw(st.sampled_from(INTS))
        if (kind == "each" and not self.lists) or (kind == "use" and not self.library):
            kind = "add2"
        if kind == "maybe" and not self.unsure:
            kind = "pair"
        body = self.body(kind)
        if "step" in body:
            body["with"] = {**body.get("with", {}), "tag": f"{self.prefix}{name}"}
        if self.draw(st.integers(0, 2)) == 0:
            body["when"] = self.guard()
        self.nodes[name] = body
        self.offer(name, kind, body)

    def offer(self, name: str, kind: str, body: Any) -> None:
        if kind == "pair":
            self.ints += [f"{name}.low", f"{name}.high"]
            self.unsure.append(f"{name}.note")
        elif kind in ("many", "each"):
            self.lists.append(name)
        elif kind == "use":
            outputs = self.library[body["use"]]["outputs"]
            single = len(outputs) == 1
            self.ints += [name if single else f"{name}.{o.replace('.', '_')}" for o in outputs]
        else:
            self.ints.append(name)

    def body(self, kind: str) -> dict[str, Any]:
        pick = lambda: self.some(self.ints)  # noqa: E731
        if kind in ("add1", "picky", "shy", "count", "pair", "many"):
            body: dict[str, Any] = {"step": kind, "in": pick()}
            if kind == "picky":
                body["with"] = {"bad": self.draw(st.integers(1, 4))}
            return body
        if kind in ("add2", "add3"):
            refs = [pick() for _ in range(int(kind[-1]))]
            as_map = self.draw(st.booleans())
            return {"step": kind, "in": dict(zip("abc", refs, strict=False)) if as_map else refs}
        if kind in ("optional", "options"):
            ports = self.draw(st.sampled_from([("a",), ("a", "b"), ("b",), ()]))
            if kind == "optional":
                ports = {*ports, "a"}
            return {"step": kind, "in": {p: pick() for p in sorted(ports)}}
        if kind == "total":
            from_list = self.lists and self.draw(st.booleans())
            refs = [pick() for _ in range(self.draw(st.integers(1, 3)))]
            return {"step": kind, "in": self.some(self.lists) if from_list else refs}
        if kind == "total_of":
            refs = [pick() for _ in range(self.draw(st.integers(1, 3)))]
            return {"step": kind, "in": {"a": pick(), "items": refs}}
        if kind == "maybe":
            return {"step": kind, "in": self.some(self.unsure)}
        if kind == "first_of":
            return {kind: [pick() for _ in range(self.draw(st.integers(1, 3)))]}
        if kind == "each":
            if self.draw(st.booleans()):
                step, wires = "add2", {"a": self.some(self.lists), "b": pick()}
            else:
                step = self.draw(st.sampled_from(["picky", "shy"]))
                wires = {"a": self.some(self.lists)}
            return {"step": step, "in": wires, "each": True}
        if kind == "use":
            return {"use": self.draw(st.sampled_from(sorted(self.library)))}
        return {"step": kind} if kind == "constant" else {"step": kind, "in": "frame"}

    def guard(self) -> str:
        parts = []
        for _ in range(self.draw(st.integers(1, 2))):
            ref = self.some([*self.ints, *self.unsure])
            form = self.draw(
                st.sampled_from(
                    ["{0} > 3", "{0} % 2 == 0", "not {0}", "{0}", "12 / {0} > 2", "{0} != 1"]
                )
            )
            parts.append(form.format(ref))
        text = self.draw(st.sampled_from([" and ", " or "])).join(parts)
        if self.draw(st.integers(0, 3)) == 0:
            name = f"c{len(self.conditions)}"
            self.conditions[name] = text
            return name
        return text


@st.composite
def documents(
    draw: Callable[..., Any],
    name: str = "random",
    library: dict[str, Any] | None = None,
    most: int = 14,
) -> dict[str, Any]:
    """Return a random valid pipeline file as plain data; what it can ``use`` is in the library."""
    grower = _Grower(draw, f"{name}:", library or {})
    for number in range(draw(st.integers(2, most))):
        grower.grow(number)
    every = grower.ints[1:] + (grower.lists if name == "random" else [])
    outputs = draw(
        st.lists(st.sampled_from(every or ["frame.index"]), min_size=1, max_size=4, unique=True)
    )
    order = draw(st.permutations(list(grower.nodes)))
    return {
        "pipeline": name,
        "conditions": grower.conditions,
        "nodes": {n: grower.nodes[n] for n in order},
        "outputs": outputs,
    }


@st.composite
def cases(draw: Callable[..., Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return a pipeline and the library of pipelines it, and they themselves, may use."""
    library: dict[str, Any] = {}
    for number in range(draw(st.integers(0, 2))):
        name = f"inner{number}"
        library[name] = draw(documents(name, dict(library), most=5))
    return draw(documents(library=library)), library
