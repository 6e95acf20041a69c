"""``Linked``: a step's form in machine code, for several steps that are run as one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tactile_graph.compiled import Kernel


@dataclass(frozen=True)
class Linked:
    """What a step does, as loops between the parts of wires.

    Where steps of one input follow each other, and nobody asks for what is between them, the engine
    runs their loops by one call. Whatever loops leave undone, the steps themselves do anew: errors
    and skips are theirs alone. What is between is made by the steps when somebody looks at it after
    all, so that a linked step must be stateless, and its loops give the step's answer to the bit.

    A step offers its linked form by an attribute ``linked``: a function one of a function of its
    settings, a class one of a method without arguments. Either gives None for settings that it has
    none for.

    Attributes
    ----------
    loops : Kernel
        Takes the parts of the input (`tactile_graph.wires.parts`, or another step's ``parts``), and
        the settings; returns whether it is done, and the parts of the answer. These are of one
        type, done or not.
    parts : type
        The named tuple that the answer's parts are.
    made : callable
        Makes the answer of its parts, given one by one.
    settings : tuple
        Numbers and arrays, whatever the loops take beside the input.
    """

    loops: Kernel[..., Any]
    parts: type[tuple[Any, ...]]
    made: Callable[..., Any]
    settings: tuple[Any, ...] = ()
