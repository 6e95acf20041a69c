"""The callable of each node: settings filled in, randomness and time gaps provided."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from types import FunctionType
from typing import Any

import numpy as np

from tactile_graph.engine.calls.context import Context
from tactile_graph.engine.calls.each import for_each, mapped, told_of_gaps
from tactile_graph.engine.calls.gaps import Gaps
from tactile_graph.engine.calls.isolated import Host, isolated_step
from tactile_graph.engine.operations.memory import detached
from tactile_graph.pipeline.graph import Node, NodeKind
from tactile_graph.steps.signature import Kind

Call = Callable[..., Any]


def make_call(node: Node, context: Context) -> Call:
    """Return the callable of a node's ports within a context; stateful steps get new instances.

    A step that keeps state has an instance for each label of frames: what one recording or sensor
    has shown says nothing of another. One that gives no value has a single one: it may write a
    file.
    """
    if node.kind is NodeKind.MAP:
        return mapped(node, context)
    call = _instance(node, context, context.hosts)
    by_label = node.stateful and not node.is_sink
    call = _by_label(node, call, context) if by_label else call
    call = told_of_gaps(node, call)
    if node.each:
        return for_each(node, call, context)
    return detached(call) if _holds(node) else call


def _holds(node: Node) -> bool:
    """Return whether a node's step may hold on to what it gives; its own process gives copies.

    Those of the project's own that keep no state do not.
    """
    assert node.signature is not None
    return (node.stateful or not node.signature.is_own) and node.isolation is None


def _by_label(node: Node, first: Call, context: Context) -> Call:
    """Return what calls the instance of the label that is under way; ``first`` is not used yet."""
    instances: dict[str, Call] = {}
    hosts = context.hosts
    if node.isolation is not None:  # all run in its process
        hosts = {node.isolation.process: context.apart[node.name]}

    def call(*args: Any, **kwargs: Any) -> Any:
        frame = context.frame
        label = frame.label if frame.state_of is None else frame.state_of
        instance = instances.get(label)
        if instance is None:
            instance = _instance(node, context, hosts) if instances else first
            instances[label] = instance
            context.labels.add(label)
        return instance(*args, **kwargs)

    return call


def _instance(node: Node, context: Context, hosts: dict[str, Host]) -> Call:
    call = _seeded(node, context, hosts)
    assert node.signature is not None
    return _with_gap(call, node.signature.gap, context) if node.signature.gap else call


def _bound(node: Node, context: Context, hosts: dict[str, Host], **injected: Any) -> Call:
    """Return a node's step with its settings, as what costs least to call in every frame."""
    if node.isolation is not None:
        step = isolated_step(node, injected, hosts)
        if hosts is context.hosts:  # of the node's first instance
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


def _seeded(node: Node, context: Context, hosts: dict[str, Host]) -> Call:
    signature = node.signature
    assert signature is not None
    if not signature.rng:
        return _bound(node, context, hosts)
    words = [context.seed, int(node.key[:16], 16)]
    if signature.rng_at_init:
        return _bound(node, context, hosts, **{signature.rng: np.random.default_rng(words)})
    step = _bound(node, context, hosts)

    def call(*args: Any, **kwargs: Any) -> Any:
        # Of the frame's number too: a frame gets the same numbers wherever a run starts.
        rng = np.random.default_rng([*words, context.frame.index, *context.item])
        return step(*args, **kwargs, **{signature.rng: rng})

    return call


def _with_gap(step: Call, name: str, context: Context) -> Call:
    gaps = Gaps()

    def call(*args: Any, **kwargs: Any) -> Any:
        return step(*args, **kwargs, **{name: gaps.before(context.frame)})

    return call
