"""What a step's form for stacks of frames takes, as its annotations say."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, get_type_hints

from tactile_graph.errors import PluginError
from tactile_graph.steps.signature import Signature, type_name

STACKED = "stacked"
"""The attribute of a step by which it offers the form."""


def stacked_form(signature: Signature) -> Callable[..., Any] | None:
    """Return what a step offers for stacks; an attribute that cannot be called is its own."""
    form = getattr(signature.target, STACKED, None)
    return form if callable(form) else None


def stacked_kinds(signature: Signature) -> Mapping[str, Any] | None:
    """Return which stack each port of a step's form for stacks takes; None where it offers none.

    A port that takes ``Any`` takes any stack.

    Raises
    ------
    PluginError
        If the form does not say so of each port.
    """
    form = stacked_form(signature)
    if form is None:
        return None
    from tactile_graph.wires.stacks import Stack

    what = f"step {signature.name!r}: its stacked form"
    try:
        hints = get_type_hints(form)
    except Exception as error:  # names that nothing defines, or no function
        raise PluginError(f"{what} has no annotations that can be read: {error}") from None
    if absent := [p.name for p in signature.ports if p.name not in hints]:
        raise PluginError(
            f"{what} must annotate each port with the stack it takes: {absent[0]!r} has none"
        )
    kinds = {p.name: Stack if hints[p.name] is Any else hints[p.name] for p in signature.ports}
    for name, kind in kinds.items():
        try:
            isinstance(None, kind)
        except TypeError:
            told = f"port {name!r} is {type_name(kind)}, which is no type of stacks"
            raise PluginError(f"{what}: {told}") from None
    return kinds
