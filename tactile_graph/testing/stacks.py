"""A step's form for many frames, held against the step itself, frame by frame."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Sized
from typing import Any, get_args

import numpy as np

from tactile_graph.engine.blocks.stacked import StackedForm
from tactile_graph.errors import text_of
from tactile_graph.testing.same import same
from tactile_graph.wires.stacks import Answered, Stack

Inputs = Mapping[str, Any]
_IN_COMMON = ("shape", "pitch_cm", "origin_cm", "quantity")


def mixed(inputs: Inputs, usual: Inputs) -> Iterator[list[Inputs]]:
    """Yield frames for a stack: a case alone, and among ordinary ones where they are alike."""
    yield [inputs, inputs]
    if all(_likeness(value) == _likeness(usual[name]) for name, value in inputs.items()):
        yield [usual, inputs, usual, inputs, inputs]


def _likeness(value: Any) -> tuple[Any, ...]:
    common = tuple([getattr(value, name, None) for name in _IN_COMMON])
    return (type(value), *common, getattr(value, "valid", None) is None)


def stack_trouble(form: StackedForm, rows: Sequence[Inputs], step: Callable[..., Any]) -> str:
    """Return what a stacked form gives that the step does not, in words; "" where nothing is."""
    stacks = {name: _stack(form, name, [row[name] for row in rows]) for name in rows[0]}
    if None in stacks.values():
        return ""
    try:
        found = form.answer(**stacks)
    except Exception as error:
        what = f"{type(error).__name__}: {text_of(error)}"
        return f"its stacked form raises {what}; leave such frames undone (`Answered`)"
    if found is NotImplemented:
        return ""
    values, done = found if isinstance(found, Answered) else (found, [True] * len(rows))
    if not isinstance(values, Stack) or len(values) != len(rows) or len(done) != len(rows):
        return f"its stacked form gives no stack of as many values as it took: {_counted(found)}"
    for i, row in enumerate(rows):
        trouble = _difference(values, i, row, step) if done[i] else ""
        if trouble:
            return trouble
    return ""


def _counted(found: Any) -> str:
    """Return what a stacked form gave, by types and numbers: texts that differ by no address."""
    if isinstance(found, Answered):
        return f"{_counted(found.values)}, {np.size(found.done)} of them told as done or not"
    n = f" of {len(found)}" if isinstance(found, Sized) else ""
    return f"{type(found).__name__}{n}"


def _stack(form: StackedForm, port: str, values: Sequence[Any]) -> Stack | None:
    """Return the stack that a port takes; None where the values make none."""
    wanted = form.kinds[port]
    for kind in get_args(wanted) or (wanted,):
        if isinstance(kind, type) and issubclass(kind, Stack) and isinstance(values[0], kind.item):
            return kind.of(values)
    return None


def _difference(values: Stack, i: int, row: Inputs, step: Callable[..., Any]) -> str:
    got = values[i]
    try:
        expected = step(**row)
    except Exception as error:
        return f"its stacked form gives {got!r:.80} where the step raises {text_of(error)}"
    if same(got, expected):
        return ""
    return f"its stacked form gives {got!r:.80}, the step {expected!r:.80}"
