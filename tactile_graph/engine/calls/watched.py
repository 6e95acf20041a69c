"""Find the steps that write into what they were given, or into what they gave before.

What goes into and comes out of steps is read-only, and shared: a step that gets round that changes
the answers of others. To look at every array before and after each call costs time, so it is done
only when asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import PluginError

Call = Callable[..., Any]
Array = NDArray[Any]


def arrays_in(value: Any) -> Iterator[Array]:
    """Yield the arrays a value holds, those of its fields and items too; each object once."""
    waiting, seen = [value], set[int]()
    while waiting:
        one = waiting.pop()
        if id(one) in seen or isinstance(one, bool | int | float | complex | str | bytes):
            continue
        seen.add(id(one))
        if isinstance(one, np.ndarray):
            yield one
        elif isinstance(one, Mapping):
            waiting += one.values()
        elif isinstance(one, list | tuple | set | frozenset):
            waiting += one
        elif not isinstance(one, type | ModuleType | FunctionType):
            waiting += _attributes(one)


def _attributes(value: Any) -> list[Any]:
    slots = [s for kind in type(value).__mro__ for s in getattr(kind, "__slots__", ())]
    return [*getattr(value, "__dict__", {}).values(), *(getattr(value, s, None) for s in slots)]


class Kept:
    """Copies of the arrays in values, to tell later whether anybody wrote into these.

    Parameters
    ----------
    values : mapping of str to anything
        By the names they are told by.
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._pairs = [(n, a, a.copy()) for n, v in values.items() for a in arrays_in(v)]

    def changed(self) -> list[str]:
        """Return the names of the values that were written into, which are as they were again."""
        names: dict[str, None] = {}
        for name, array, copy in self._pairs:
            if array.tobytes() != copy.tobytes():
                names[name] = None
                _put_back(array, copy)
        return list(names)

    def within(self, values: Mapping[str, Any]) -> bool:
        """Return whether an array of these may lie in the memory of another value's."""
        others = [a for v in values.values() for a in arrays_in(v)]
        return any(np.may_share_memory(a, o) for _, a, _ in self._pairs for o in others)


def _put_back(array: Array, copy: Array) -> None:
    try:
        writable = array.flags.writeable
        array.setflags(write=True)
        array[...] = copy
        array.setflags(write=writable)
    except ValueError:  # a view of what is read-only: whoever wrote had another way
        return


def watched(call: Call, what: str) -> Call:
    """Return a step that fails where it writes into its inputs or into what it gave before.

    Parameters
    ----------
    call : callable
        The step, of its ports.
    what : str
        How errors name it.

    Raises
    ------
    PluginError
        From the call that wrote, or the one after; the arrays are as they were by then.
    """
    before: Kept | None = None

    def watching(*args: Any, **kwargs: Any) -> Any:
        nonlocal before
        given = {**{f"input {i}": a for i, a in enumerate(args, 1)}, **kwargs}
        kept = Kept(given)
        result = call(*args, **kwargs)
        wrote = kept.changed()
        if wrote:
            names = ", ".join(wrote)
            raise PluginError(f"{what} writes into {names}, which others read: change a copy")
        if before is not None and before.changed():
            before = None
            raise PluginError(
                f"{what} writes into what it gave before, which others read: give a copy"
            )
        of_result = Kept({"result": result})
        # What lies in its input may rightly change: a source may fill the same array anew.
        before = None if of_result.within(given) else of_result
        return result

    return watching
