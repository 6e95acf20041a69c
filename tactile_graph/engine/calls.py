"""The callable of each node: settings filled in, randomness, time gaps and lists provided."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from types import FunctionType
from typing import Any

import numpy as np

from tactile_graph.engine.outcome import NO_VALUE, Failed, Skipped, failure
from tactile_graph.engine.outcomes import Outcomes
from tactile_graph.pipeline.graph import Graph, Node, NodeKind
from tactile_graph.steps.signature import Kind
from tactile_graph.wires.frame import Frame

Call = Callable[..., Any]
RunInner = Callable[[Frame, tuple[int, ...]], Outcomes]
"""Runs an embedded pipeline on the frame of one item; where the item stands seeds its numbers."""


class Context:
    """What the calls of one context share: the frame that is under way, and what items came to.

    Parameters
    ----------
    seed : int
        Seed of the steps that take randomness.
    embedded : callable
        Gives what runs an embedded pipeline.
    """

    __slots__ = ("embedded", "frame", "inner_results", "item", "item_failures", "seed")

    def __init__(self, seed: int, embedded: Callable[[Graph], RunInner]) -> None:
        self.seed = seed
        self.embedded = embedded
        self.frame: Frame
        self.item: tuple[int, ...] = ()
        self.inner_results: dict[str, list[Outcomes]] = {}
        self.item_failures: list[Failed] = []


def make_call(node: Node, context: Context) -> Call:
    """Return the callable of a node's ports within a context; stateful steps get a new instance."""
    if node.kind is NodeKind.MAP:
        return _mapped(node, context)
    call = _seeded(node, context)
    assert node.signature is not None
    if node.signature.gap:
        call = _with_gap(call, node.signature.gap, context)
    return _for_each(node, call, context) if node.each else call


def _bound(node: Node, **injected: Any) -> Call:
    """Return a node's step with its settings, as what costs least to call in every frame."""
    step: Any = node.bound(**injected)
    assert node.signature is not None
    call: Call = step.__call__ if node.signature.kind is Kind.CLASS else step
    return _with_defaults(call) if isinstance(call, partial) else call


def _with_defaults(step: partial[Any]) -> Call:
    """Return a copy of the function with the settings as its defaults: no call between the two."""
    function = step.func
    if not isinstance(function, FunctionType) or step.args:
        return step
    code = function.__code__
    by_keyword = code.co_varnames[code.co_argcount : code.co_argcount + code.co_kwonlyargcount]
    if not step.keywords.keys() <= set(by_keyword):  # a wrapper that hands on what it gets
        return step
    copy = FunctionType(
        code, function.__globals__, function.__name__, function.__defaults__, function.__closure__
    )
    copy.__kwdefaults__ = {**(function.__kwdefaults__ or {}), **step.keywords}
    return copy


def _seeded(node: Node, context: Context) -> Call:
    signature = node.signature
    assert signature is not None
    if not signature.rng:
        return _bound(node)
    words = [context.seed, int(node.key[:16], 16)]
    if signature.rng_at_init:
        return _bound(node, **{signature.rng: np.random.default_rng(words)})
    step = _bound(node)

    def call(*args: Any, **kwargs: Any) -> Any:
        # Of the frame's number too: a frame gets the same numbers wherever a run starts.
        rng = np.random.default_rng([*words, context.frame.index, *context.item])
        return step(*args, **kwargs, **{signature.rng: rng})

    return call


def _with_gap(step: Call, name: str, context: Context) -> Call:
    last: float | None = None

    def call(*args: Any, **kwargs: Any) -> Any:
        nonlocal last
        now = context.frame.time_s
        gap = None if last is None or now is None else now - last
        last = now if now is not None else last
        return step(*args, **kwargs, **{name: gap})

    return call


def _for_each(node: Node, step: Call, context: Context) -> Call:
    """Return the step run over the items of whichever ports hold lists it does not want whole."""
    assert node.signature is not None
    over = [b.port.name for b in node.inputs if b.iterates]
    order = [p.name for p in node.signature.ports]

    def call(*args: Any, **kwargs: Any) -> Any:
        values = {**dict(zip(order, args, strict=False)), **kwargs}
        lists = {name: values[name] for name in over}
        counts = {name: len(v) for name, v in lists.items()}
        if len(set(counts.values())) > 1:
            raise ValueError(f"lists of different length at one node: {counts}")
        n = next(iter(counts.values()))
        outcomes = []
        outer = context.item
        try:
            for i in range(n):
                item = {**values, **{name: v[i] for name, v in lists.items()}}
                context.item = (*outer, i)  # or every item would draw the same numbers
                outcomes.append(_try(step, item, node.name))
        finally:
            context.item = outer
        context.item_failures += [o for o in outcomes if o.__class__ is Failed]
        return gathered(outcomes, node.name)

    return call


def _try(step: Call, arguments: dict[str, Any], name: str) -> Any:
    try:
        return step(**arguments)
    except Exception as error:
        return failure(name, error, tuple(arguments.values()), "")


def gathered(outcomes: list[Any], name: str) -> Any:
    """Return the values among the outcomes of a node's items; its own outcome if there are none."""
    values = tuple([o for o in outcomes if o.__class__ not in NO_VALUE])
    if values:
        return values
    failed = next((o for o in outcomes if o.__class__ is Failed), None)
    if failed is not None:
        return failed
    return Skipped(name, "no items to run for" if not outcomes else outcomes[0].reason)


def _mapped(node: Node, context: Context) -> Call:
    """Return the embedded pipeline run over a list of images."""
    assert node.inner is not None
    run = context.embedded(node.inner)
    fields = getattr(node.output, "_fields", ())
    names = list(node.inner.outputs)

    def call(frame: Any) -> Any:
        results = []
        outer = context.frame
        for i, image in enumerate(frame):
            inner = Frame(image, outer.index, outer.time_s, label=outer.label)
            results.append(run(inner, (*context.item, i)))
        context.inner_results[node.name] = results
        columns = [gathered([r.outcome(n) for r in results], node.name) for n in names]
        if not fields or all(c.__class__ in NO_VALUE for c in columns):
            return columns[0]
        return node.output(*columns)

    return call
