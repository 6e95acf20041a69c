"""What a node comes to for a frame: a value, skipped (why, whence) or failed (what, whence)."""

from __future__ import annotations

import inspect
import os
import pickle
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from tactile_graph.errors import Degenerate, Skip, text_of


def for_want_of_time(_: tuple[Any, ...]) -> str:
    """Return the reason of a node that was skipped since it would not have been done in time."""
    return "deadline"


class Skipped:
    """A node that was not needed, with the reason and the node it began at.

    The text of the reason is made only when somebody asks for it. ``item`` says which item of a
    list it is, counted from 0, outermost list first; it is empty for a whole node. ``unforeseen``
    tells that no guard, no list without values and no unknown field was the cause: a step said so
    itself.
    """

    __slots__ = ("_reason", "_values", "item", "origin", "unforeseen")

    def __init__(
        self,
        origin: str,
        reason: str | Callable[[tuple[Any, ...]], str],
        values: tuple[Any, ...] = (),
        item: tuple[int, ...] = (),
        unforeseen: bool = False,
    ) -> None:
        self.origin = origin
        self.item = item
        self.unforeseen = unforeseen
        self._reason = reason
        self._values = values

    @property
    def reason(self) -> str:
        """Why, in words."""
        return self._reason if isinstance(self._reason, str) else self._reason(self._values)

    @property
    def for_deadline(self) -> bool:
        """Whether it was skipped because it would not have been done in time."""
        return self._reason is for_want_of_time

    def at(self, origin: str, *, unforeseen: bool = False) -> Skipped:
        """Return the same, begun at a node of another name; or as it is, but ``unforeseen``."""
        unforeseen = unforeseen or self.unforeseen
        return Skipped(origin, self._reason, self._values, self.item, unforeseen)

    def of_item(self, i: int) -> Skipped:
        """Return the same as the outcome of a list's item."""
        return Skipped(self.origin, self._reason, self._values, (i, *self.item))

    def within(self, node: str, i: int) -> Skipped:
        """Return the same as the outcome of an item that a node ran a pipeline for."""
        return self.at(f"{node}/{self.origin}" if self.origin else "").of_item(i)

    def told_by(self, change: Callable[[Any], Any]) -> Skipped:
        """Return the same with each value that its reason tells changed; itself if it has none."""
        if not self._values:
            return self
        values = tuple([change(value) for value in self._values])
        return Skipped(self.origin, self._reason, values, self.item, self.unforeseen)

    def __repr__(self) -> str:
        return f"<skipped at {self.origin!r}: {self.reason}>"


class Failed:
    """A node whose step failed, or that needed one that did.

    Parameters
    ----------
    origin : str
        The node that failed first.
    error : Exception
        What its step raised, without the traceback.
    where : str
        File and line the error was raised at.
    inputs : str
        What went in: types and shapes.
    step : str
        Step and plugin of the node.
    item : tuple of int
        Which item of a list it is, counted from 0, outermost list first; empty for a whole node.
    """

    __slots__ = ("error", "inputs", "item", "origin", "step", "where")

    def __init__(
        self,
        origin: str,
        error: Exception,
        where: str = "",
        inputs: str = "",
        step: str = "",
        item: tuple[int, ...] = (),
    ) -> None:
        self.item = item
        self.origin = origin
        self.error = error
        self.where = where
        self.inputs = inputs
        self.step = step

    @property
    def kind(self) -> str:
        """``degenerate`` for an expected numeric failure, ``error`` for any other."""
        return "degenerate" if isinstance(self.error, Degenerate) else "error"

    @property
    def reason(self) -> str:
        """What went wrong, in words."""
        if isinstance(self.error, Degenerate):
            return str(self.error)
        return f"{type(self.error).__name__}: {text_of(self.error)}"

    def at(self, origin: str) -> Failed:
        """Return the same, begun at a node of another name."""
        return Failed(origin, self.error, self.where, self.inputs, self.step, self.item)

    def of_item(self, i: int) -> Failed:
        """Return the same as the outcome of a list's item."""
        item = (i, *self.item)
        return Failed(self.origin, self.error, self.where, self.inputs, self.step, item)

    def within(self, node: str, i: int) -> Failed:
        """Return the same as the outcome of an item that a node ran a pipeline for."""
        return self.at(f"{node}/{self.origin}" if self.origin else "").of_item(i)

    def __reduce__(self) -> tuple[type[Failed], tuple[Any, ...]]:
        """Pickle with an error of the same words, where the error itself is not to be pickled."""
        rest = (self.where, self.inputs, self.step, self.item)
        return Failed, (self.origin, travelling(self.error), *rest)

    def __repr__(self) -> str:
        return f"<failed at {self.origin!r}: {self.reason}>"


def travelling(error: BaseException) -> Exception:
    """Return an error that is the same after pickling: itself, or one of its name, words and kind.

    A plugin's own may not even come back. What is no `Exception` comes as one of that name.
    """
    try:
        again = pickle.loads(pickle.dumps(error))
    except Exception:
        again = None
    same = type(again) is type(error) and text_of(again) == text_of(error)
    if same and isinstance(error, Exception):
        return error
    kind = next((k for k in (Degenerate, Skip) if isinstance(error, k)), Exception)
    return _told(type(error).__name__, kind, text_of(error))


def _told(name: str, kind: type[Exception], text: str) -> Exception:
    """Return an error that is known by its type's name and its words alone."""
    again = lambda error: (_told, (name, kind, text))  # noqa: E731
    made: Exception = type(name, (kind,), {"__reduce__": again})(text)
    return made


ErrorT = TypeVar("ErrorT", bound=BaseException)
_CORE = str(Path(__file__).parents[2]) + os.sep

Outcome = Any
"""A value, or `Skipped`, or `Failed`; never None."""

NO_VALUE = frozenset({Skipped, Failed})
NOT_ASKED = Skipped("", "nothing asked for it")


def gaps(value: Any) -> list[Skipped | Failed]:
    """Return the outcomes of those items of a list that have no value, of lists in records too."""
    if not isinstance(value, list | tuple):
        return []
    if hasattr(value, "_fields"):
        return [gap for field in value for gap in gaps(field)]
    return [item for item in value if isinstance(item, Skipped | Failed)]


def with_value(items: Iterable[Any]) -> list[Any]:
    """Return those items of a list that have a value, in order."""
    return [item for item in items if item.__class__ not in NO_VALUE]


def item_words(item: tuple[int, ...]) -> str:
    """Return which item of a list that is, counted from 1 as pictures do: ``item 2``."""
    return f"item {'.'.join(str(i + 1) for i in item)}" if item else ""


def outcome_word(outcome: Outcome) -> str:
    """Return ``ok``, or ``skipped: why``, or ``failed: why``; of a list what its items lack."""
    if isinstance(outcome, Skipped | Failed):
        where = f"{item_words(outcome.item)} " if outcome.item else ""
        return f"{where}{'failed' if outcome.__class__ is Failed else 'skipped'}: {outcome.reason}"
    return "; ".join(outcome_word(gap) for gap in gaps(outcome)) or "ok"


class Done:
    """The value of a sink that has run."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "done"


DONE = Done()


def raised(name: str, error: Exception, values: tuple[Any, ...], what: str) -> Skipped | Failed:
    """Return the outcome of a node whose step raised: skipped where it said so, else failed."""
    if isinstance(error, Skip):
        return Skipped(name, str(error) or "its step had nothing to say", unforeseen=True)
    return failure(name, error, values, what)


def failure(name: str, error: Exception, values: tuple[Any, ...], what: str) -> Failed:
    """Return the outcome of a failed node; the traceback is dropped, its place kept."""
    where = raised_at(error)
    return Failed(name, error.with_traceback(None), where, describe_inputs(values), what)


def nothing_returned(name: str, what: str) -> Failed:
    """Return the outcome of a step that returned None though it promises a value."""
    return Failed(name, TypeError("the step returned None though it promises a value"), step=what)


def describe_inputs(values: tuple[Any, ...]) -> str:
    """Return types and shapes of what went into a step, for error reports."""
    return ", ".join(_describe(v) for v in values)


def _describe(value: Any) -> str:
    name = type(value).__name__
    shape = getattr(getattr(value, "values", value), "shape", None)
    if isinstance(shape, tuple):
        return f"{name} {'x'.join(map(str, shape))}"
    count = getattr(value, "count", None)
    return f"{name} of {count}" if isinstance(count, int) else name


_THERE = "_tactile_graph_raised_at"


def raised_there(error: ErrorT, where: str) -> ErrorT:
    """Return an error with what `raised_at` is to say of it; "" for no line of anybody's."""
    with suppress(AttributeError):  # it takes none: the line at which it came is told
        setattr(error, _THERE, where)
    return error


def raised_at(error: BaseException) -> str:
    """Return ``file:line in function`` of the innermost frame an error passed through.

    Frames of this package are left out where another's called them: it is that line which is wrong.
    Of an error of another process it is what `raised_there` said.
    """
    if (told := getattr(error, _THERE, None)) is not None:
        return str(told)
    passed = list[tuple[str, int, str]]()
    cause = error.__cause__
    if isinstance(error, RuntimeError) and isinstance(cause, StopIteration):
        error = cause  # in a generator Python makes the one of the other, behind its lines
    traceback = error.__traceback__
    while traceback is not None:
        code = traceback.tb_frame.f_code
        passed.append((code.co_filename, traceback.tb_lineno, code.co_name))
        traceback = traceback.tb_next
    others = [where for where in passed if not where[0].startswith(_CORE)]
    for file, line, name in (others or passed)[-1:]:
        return f"{file}:{line} in {name}"
    return ""


def defined_at(target: Any) -> str:
    """Return the file and line at which a step is defined; "" where nobody can tell."""
    try:
        code = inspect.unwrap(target)
        return f"{inspect.getsourcefile(code)}:{inspect.getsourcelines(code)[1]}"
    except (OSError, TypeError):
        return ""
