"""Hot loops written in plain Python and compiled to machine code, kept on disk."""

from tactile_graph.compiled.beside import Work, prepared_beside
from tactile_graph.compiled.kernel import (
    SWITCH_AFTER_CALLS,
    SWITCH_AFTER_ELEMENTS,
    Kernel,
    compiled_as_is,
    compiled_later,
    compiled_twin_of,
    mode,
    plain_and_noted,
    warm_up,
)
from tactile_graph.compiled.meanwhile import Meanwhile, answered_meanwhile
from tactile_graph.compiled.once import made_so_far, once_made

__all__ = [
    "SWITCH_AFTER_CALLS",
    "SWITCH_AFTER_ELEMENTS",
    "Kernel",
    "Meanwhile",
    "Work",
    "answered_meanwhile",
    "compiled_as_is",
    "compiled_later",
    "compiled_twin_of",
    "made_so_far",
    "mode",
    "once_made",
    "plain_and_noted",
    "prepared_beside",
    "warm_up",
]
