"""What steps have to say of a frame beside their values, worked out only when somebody asks."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from inspect import signature
from typing import Any, Protocol

from tactile_graph.engine.outcomes.outcome import NO_VALUE, Outcome, raised_at
from tactile_graph.engine.plan import Plan
from tactile_graph.errors import PluginError, shown, text_of
from tactile_graph.pipeline.graph import Node
from tactile_graph.pipeline.wiring import Ref

VALUE = "value"
NOTICE, ASSUMED = "notice", "assumed"
"""The attributes of a step, and of a value, by which they say so."""


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
    to say. Nodes run for each item of a list say nothing. Of a notice that breaks it is said how.
    """
    found = {}
    for item in settled.plan.nodes:
        node, value = item.node, settled.outcome(item.name)
        say = _notice_of(node)
        if node is None or say is None or value.__class__ in NO_VALUE:
            continue
        try:
            told = said(say, value, partial(_ports, node, settled))
        except Exception as error:  # a plugin's own code may raise anything
            told = breaks(NOTICE, error)
        if told is not None:
            found[item.name] = told
    return found


def said(
    say: Callable[..., str],
    value: Any,
    ports: Callable[[tuple[str, ...]], dict[str, Any] | None],
) -> str | None:
    """Return what a step's notice says; None where it is not asked.

    Parameters
    ----------
    say : callable
        The notice.
    value : object
        What the step gave.
    ports : callable
        Gives what came to the ports of some names; None where one of them had no value.

    Raises
    ------
    Exception
        Whatever it raises; TypeError if it gives no text.
    """
    names = tuple(signature(say).parameters)
    given = ports(tuple(n for n in names if n != VALUE))
    if given is None:
        return None
    text = say(**given, **({VALUE: value} if VALUE in names else {})) or ""
    if not isinstance(text, str):
        raise TypeError(f"it must return a text, got {shown(text)}")
    return text


def breaks(what: str, error: Exception) -> str:
    """Return the words for something of a plugin's that could not be asked, and where it broke."""
    where = raised_at(error)
    told = " ".join(f"{type(error).__name__}: {text_of(error)}".split()).removesuffix(":")
    return f"its {what} breaks: {told}" + (f" ({where})" if where else "")


def untold(output: str, what: str, error: Exception) -> PluginError:
    """Return the error that names the output whose value could not be written out."""
    return PluginError(f"output {output!r}: {breaks(what, error)}")


def assumed_by(value: Any) -> str:
    """Return what a value says was taken that nobody said, or how saying it breaks; "" for most."""
    try:
        told = getattr(value, ASSUMED, "")
        return str(told) if told else ""
    except Exception as error:  # a plugin's own code may raise anything
        return breaks(ASSUMED, error)


def _notice_of(node: Node | None) -> Callable[..., str] | None:
    if node is None or node.signature is None or node.each:
        return None
    say: Callable[..., str] | None = getattr(node.signature.target, NOTICE, None)
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
