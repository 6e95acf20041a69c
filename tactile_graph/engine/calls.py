"""The callable of each node: settings filled in, randomness, time gaps and lists provided."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from types import FunctionType
from typing import TYPE_CHECKING, Any

import numpy as np

from tactile_graph.engine.outcome import NO_VALUE, Failed, Skipped, failure
from tactile_graph.pipeline.node import Node, NodeKind
from tactile_graph.steps.signature import Kind
from tactile_graph.wires.frame import Frame

if TYPE_CHECKING:
    from tactile_graph.engine.runner import Runner

Call = Callable[..., Any]


def make_call(node: Node, runner: Runner) -> Call:
    """Return the callable of a node's ports for one runner; stateful steps get a new instance."""
    if node.kind is NodeKind.MAP:
        return _mapped(node, runner)
    call = _seeded(node, runner)
    assert node.signature is not None
    if node.signature.gap:
        call = _with_gap(call, node.signature.gap, runner)
    return _for_each(node, call, runner) if node.each else call


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


def _seeded(node: Node, runner: Runner) -> Call:
    signature = node.signature
    assert signature is not None
    if not signature.rng:
        return _bound(node)
    words = [runner.seed, int(node.key[:16], 16)]
    if signature.rng_at_init:
        return _bound(node, **{signature.rng: np.random.default_rng(words)})
    step = _bound(node)

    def call(*args: Any, **kwargs: Any) -> Any:
        # Of the frame's number too: a frame gets the same numbers wherever a run starts.
        rng = np.random.default_rng([*words, runner.frame.index, *runner.item])
        return step(*args, **kwargs, **{signature.rng: rng})

    return call


def _with_gap(step: Call, name: str, runner: Runner) -> Call:
    last: float | None = None

    def call(*args: Any, **kwargs: Any) -> Any:
        nonlocal last
        now = runner.frame.time_s
        gap = None if last is None or now is None else now - last
        last = now if now is not None else last
        return step(*args, **kwargs, **{name: gap})

    return call


def _for_each(node: Node, step: Call, runner: Runner) -> Call:
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
        outer = runner.item
        try:
            for i in range(n):
                item = {**values, **{name: v[i] for name, v in lists.items()}}
                runner.item = (*outer, i)  # or every item would draw the same numbers
                outcomes.append(_try(step, item, node.name))
        finally:
            runner.item = outer
        runner.item_failures += [o for o in outcomes if o.__class__ is Failed]
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


def _mapped(node: Node, runner: Runner) -> Call:
    """Return the embedded pipeline run over a list of images."""
    from tactile_graph.engine.runner import Runner as Inner

    assert node.inner is not None
    inner = Inner(node.inner, tuple(node.inner.outputs), runner.seed)
    fields = getattr(node.output, "_fields", ())
    names = list(node.inner.outputs)

    def call(frame: Any) -> Any:
        results = []
        outer = runner.frame
        for i, image in enumerate(frame):
            inner.item = (*runner.item, i)
            results.append(inner(Frame(image, outer.index, outer.time_s, label=outer.label)))
        runner.inner_results[node.name] = results
        columns = [gathered([r.outcome(n) for r in results], node.name) for n in names]
        if not fields or all(c.__class__ in NO_VALUE for c in columns):
            return columns[0]
        return node.output(*columns)

    return call
