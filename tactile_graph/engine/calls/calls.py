"""The callable of each node: settings filled in, randomness and time gaps provided."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from types import FunctionType
from typing import Any

import numpy as np

from tactile_graph.engine.calls.context import Context
from tactile_graph.engine.calls.each import for_each, mapped, told_of_gaps
from tactile_graph.engine.calls.isolated import isolated_step
from tactile_graph.pipeline.graph import Node, NodeKind
from tactile_graph.steps.signature import Kind

Call = Callable[..., Any]


def make_call(node: Node, context: Context) -> Call:
    """Return the callable of a node's ports within a context; stateful steps get a new instance."""
    if node.kind is NodeKind.MAP:
        return mapped(node, context)
    call = _seeded(node, context)
    assert node.signature is not None
    if node.signature.gap:
        call = _with_gap(call, node.signature.gap, context)
    call = told_of_gaps(node, call)
    return for_each(node, call, context) if node.each else call


def _bound(node: Node, context: Context, **injected: Any) -> Call:
    """Return a node's step with its settings, as what costs least to call in every frame."""
    if node.isolation is not None:
        step = isolated_step(node, injected, context.hosts)
        context.apart[node.name] = step.host
        return step
    bound: Any = node.bound(**injected)
    assert node.signature is not None
    call: Call = bound.__call__ if node.signature.kind is Kind.CLASS else bound
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
        return _bound(node, context)
    words = [context.seed, int(node.key[:16], 16)]
    if signature.rng_at_init:
        return _bound(node, context, **{signature.rng: np.random.default_rng(words)})
    step = _bound(node, context)

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
        last = now
        return step(*args, **kwargs, **{name: gap})

    return call
