"""What steps have to say of a frame beside their values, worked out only when somebody asks."""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from typing import Any, Protocol

from tactile_graph.engine.outcomes.outcome import NO_VALUE, Outcome
from tactile_graph.engine.plan import Plan
from tactile_graph.pipeline.graph import Node
from tactile_graph.pipeline.wiring import Ref

VALUE = "value"


class Settled(Protocol):
    """A plan and the outcomes that a frame came to."""

    plan: Plan

    def outcome(self, name: str) -> Outcome:
        """Return a node's outcome."""

    def outcome_at(self, ref: Ref) -> Outcome:
        """Return the outcome of what the plan reads at a reference."""


def notices(settled: Settled) -> dict[str, str]:
    """Return for each node that ran, and whose step may have something to say, what it says.

    A step says so by an attribute ``notice``, a function of some of its ports, and of ``value``,
    what it gave: their names are its parameters. It returns a text, empty where there is nothing
    to say. Nodes run for each item of a list say nothing.
    """
    found = {}
    for item in settled.plan.nodes:
        say = _notice_of(item.node)
        if item.node is None or say is None or settled.outcome(item.name).__class__ in NO_VALUE:
            continue
        names = tuple(signature(say).parameters)
        given = {VALUE: settled.outcome(item.name)} if VALUE in names else {}
        ports = _ports(item.node, settled, tuple(n for n in names if n != VALUE))
        if ports is not None:
            found[item.name] = say(**ports, **given)
    return found


def _notice_of(node: Node | None) -> Callable[..., str] | None:
    if node is None or node.signature is None or node.each:
        return None
    say: Callable[..., str] | None = getattr(node.signature.target, "notice", None)
    return say


def _ports(node: Node, settled: Settled, names: tuple[str, ...]) -> dict[str, Any] | None:
    """Return what came to the ports of these names; None where one of them had no value."""
    values = {
        b.port.name: settled.outcome_at(b.refs[0])
        for b in node.inputs
        if b.port.name in names and b.refs and not b.collects
    }
    if len(values) < len(names) or any(v.__class__ in NO_VALUE for v in values.values()):
        return None
    return values
