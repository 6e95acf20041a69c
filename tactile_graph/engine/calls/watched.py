"""Find the steps that write into what they were given, or into what they gave before.

What goes into and comes out of steps is read-only, and shared: a step that gets round that changes
the answers of others. To look at every array, list, dict and record before and after each call
costs time, so it is done only when asked for.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.engine.operations.freeze import freeze
from tactile_graph.engine.outcomes.outcome import raised_there
from tactile_graph.errors import PluginError

Call = Callable[..., Any]
Array = NDArray[Any]
AGAIN = "writes into what it gave before, which others read: give a copy"


def arrays_in(value: Any) -> Iterator[Array]:
    """Yield the arrays a value holds, those of its fields and items too; each object once."""
    yield from (one for one, _ in _held(value) if isinstance(one, np.ndarray))


def _held(value: Any) -> list[tuple[Any, bool]]:
    """Return what a value holds, itself first, and whether a way there is public; each once."""
    waiting, seen = [(value, True)], dict[int, tuple[Any, bool]]()
    while waiting:
        one, public = waiting.pop()
        if isinstance(one, bool | int | float | complex | str | bytes | type | ModuleType):
            continue
        if isinstance(one, FunctionType) or (id(one) in seen and seen[id(one)][1] >= public):
            continue
        seen[id(one)] = one, public
        if isinstance(one, Mapping):
            waiting += [(item, public) for item in one.values()]
        elif isinstance(one, list | tuple | set | frozenset):
            waiting += [(item, public) for item in one]
        elif not isinstance(one, np.ndarray):
            waiting += [(v, public and n[0] != "_") for n, v in _attributes(one).items()]
    return [*seen.values()]


def _attributes(value: Any) -> dict[str, Any]:
    slots = [s for kind in type(value).__mro__ for s in getattr(kind, "__slots__", ())]
    return {**{s: getattr(value, s, None) for s in slots}, **getattr(value, "__dict__", {})}


def _content(value: Any) -> Any:
    """Return a shallow copy of what can be written into; None of what cannot, or is an array."""
    if isinstance(value, dict | list | set | bytearray):
        return value.copy()
    if dataclasses.is_dataclass(value):
        return {f.name: getattr(value, f.name, None) for f in dataclasses.fields(value)}
    return None


def _alike(one: Any, other: Any) -> bool:
    """Return whether two shallow copies hold the very same objects, or equal numbers or texts."""
    if isinstance(one, dict):
        return list(one) == list(other) and _alike([*one.values()], [*other.values()])
    if not isinstance(one, list):
        return bool(one == other)
    return len(one) == len(other) and all(map(_same, one, other))


def _same(one: Any, other: Any) -> bool:
    plain = isinstance(one, bool | int | float | complex | str | bytes)
    return one is other or (plain and type(one) is type(other) and one == other)


class Kept:
    """Copies of the arrays, lists, dicts, sets and records in values, to tell what is written into.

    What a value keeps for itself (names with an underscore) is looked through for arrays alone.

    Parameters
    ----------
    values : mapping of str to anything
        By the names they are told by.
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        held = [(name, one, public) for name, v in values.items() for one, public in _held(v)]
        self._pairs = [(n, a, a.copy()) for n, a, _ in held if isinstance(a, np.ndarray)]
        contents = [(n, one, _content(one)) for n, one, public in held if public]
        self._contents = [kept for kept in contents if kept[2] is not None]

    @classmethod
    def of_answer(cls, name: str, value: Any) -> Kept:
        """Keep what a step gave as others read it: its lists and dicts are its own still."""
        with suppress(Exception):  # what cannot be frozen fails its node
            value = freeze(value)
        return cls({name: value})

    def changed(self) -> list[str]:
        """Return the names of the values that were written into, which are as they were again."""
        names: dict[str, None] = {}
        for name, array, copy in self._pairs:
            if array.tobytes() != copy.tobytes():
                names[name] = None
                _put_back(array, copy)
        for name, one, content in self._contents:
            if not _alike(_content(one), content):
                names[name] = None
                _fill_again(one, content)
        return list(names)

    def within(self, values: Mapping[str, Any]) -> bool:
        """Return whether an array of these may lie in another value's memory, or is held there."""
        others = [one for v in values.values() for one, _ in _held(v)]
        theirs = {id(one) for one in others}
        arrays = [one for one in others if isinstance(one, np.ndarray)]
        return any(id(one) in theirs for _, one, _ in self._contents) or any(
            np.may_share_memory(a, o) for _, a, _ in self._pairs for o in arrays
        )


def _put_back(array: Array, copy: Array) -> None:
    try:
        writable = array.flags.writeable
        array.setflags(write=True)
        array[...] = copy
        array.setflags(write=writable)
    except ValueError:  # a view of what is read-only: whoever wrote had another way
        return


def _fill_again(value: Any, content: Any) -> None:
    if isinstance(value, list | bytearray):
        value[:] = content
    elif isinstance(value, dict | set):
        value.clear()
        value.update(content)
    else:
        for name, one in content.items():
            object.__setattr__(value, name, one)


def watched(call: Call, what: str, ports: Sequence[str] = (), place: str = "") -> Call:
    """Return a step that fails where it writes into its inputs or into what it gave before.

    Parameters
    ----------
    call : callable
        The step, of its ports.
    what : str
        How errors name it.
    ports : sequence of str, optional
        Its inputs in order; those without a name are told by their number.
    place : str, optional
        File and line at which it is defined.

    Raises
    ------
    PluginError
        From the call that wrote, or the one after; what it wrote into is as it was by then. Where
        it gave that before, it may be its state: every later call raises, too.
    """
    before: Kept | None = None
    undone = False

    def wrong(told: str) -> PluginError:
        return raised_there(PluginError(told), place) if place else PluginError(told)

    def watching(*args: Any, **kwargs: Any) -> Any:
        nonlocal before, undone
        if undone:
            raise wrong(f"{what} {AGAIN}")
        named = [*ports, *(f"input {i}" for i in range(len(ports) + 1, len(args) + 1))]
        given = {**dict(zip(named, args, strict=False)), **kwargs}
        kept = Kept(given)
        result = call(*args, **kwargs)
        wrote = kept.changed()
        if wrote:
            names = ", ".join(wrote)
            told = f"{what} writes into {names}, which others read: change a copy"
            raise wrong(told)
        if before is not None and before.changed():
            undone = True
            raise wrong(f"{what} {AGAIN}")
        of_result = Kept.of_answer("result", result)
        # What lies in its input may rightly change: a source may fill the same array anew.
        before = None if of_result.within(given) else of_result
        return result

    return watching
