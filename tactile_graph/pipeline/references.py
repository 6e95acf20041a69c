"""References of a file, ``node.field``: what they point at, and of which type it is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tactile_graph.errors import did_you_mean, one_of
from tactile_graph.pipeline.wiring import Ref, field_type, public_fields
from tactile_graph.steps.signature import type_name


class ConditionError(Exception):
    """What is wrong with a condition or a reference, in words, and at which character of it."""

    def __init__(self, message: str, offset: int = 0, named: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.offset = offset
        self.named = named
        """The named condition it is in, if it is not in the text itself."""


def resolve_reference(
    chain: tuple[str, ...], types: Mapping[str, Any], also: list[str], offset: int = 0
) -> tuple[Ref, Any]:
    """Return the reference and the type of ``node.field…``.

    Raises
    ------
    ConditionError
        If the node is unknown or its type has no such field.
    """
    name, rest = chain[0], chain[1:]
    if len(chain) > 1 and ".".join(chain[:2]) in types:
        name, rest = ".".join(chain[:2]), chain[2:]
    if name not in types:
        inner = [n.partition(".")[2] for n in types if n.startswith(f"{name}.")]
        if inner:
            given = f"{chain[1]!r} is none of them" if len(chain) > 1 else "name one"
            raise ConditionError(f"{name!r} has the outputs {one_of(inner)}; {given}", offset)
        known = list(dict.fromkeys([*types, *also]))
        hint = did_you_mean(name, known) or f"; there are: {one_of(known)}"
        raise ConditionError(f"no node named {name!r}{hint}", offset)
    kind = types[name]
    for i, field in enumerate(rest):
        found = None if field.startswith("_") else field_type(kind, field)
        if found is None:
            known = list(public_fields(kind))
            hint = did_you_mean(field, known) or f"; it has: {one_of(known)}"
            owner = ".".join((name, *rest[:i]))
            raise ConditionError(
                f"{owner} ({type_name(kind)}) has no field {field!r}{hint}", offset
            )
        kind = found
    return Ref(name, rest), kind
