"""``ExecutorKind``: what a plugin offers that does work elsewhere, and who takes which address."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor
from typing import NamedTuple

from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph.plugins.registry import installed

OFFERS = "executors"
USUAL = "processes"


class Opened(NamedTuple):
    """An executor at work.

    Attributes
    ----------
    executor : Executor
        Of `concurrent.futures`, or one that acts like it. What it is given to do are functions of
        modules, with arguments that can be pickled.
    n_workers : int
        How many calls it does at the same time.
    end : callable
        Ends it, and at once whatever it is at.
    died : tuple of type
        What a call's future raises when the process died that was at it. A `BrokenExecutor` means
        that the executor itself is of no use any more: another is opened.
    n_there : callable, optional
        Says how many workers there are right now, where they come and go by themselves: who waits
        for one is told.
    """

    executor: Executor
    n_workers: int
    end: Callable[[], None]
    died: tuple[type[BaseException], ...] = (BrokenExecutor,)
    n_there: Callable[[], int] | None = None


class ExecutorKind(NamedTuple):
    """A place where work is done.

    Attributes
    ----------
    called : str
        As people call it: ``"local processes"``.
    opened : callable
        ``opened(address, n_workers)`` returns an `Opened`. The address is empty where only the
        executor's name was told; ``n_workers`` is None where nobody said how many. Raises
        `UsageError` if there is none to be had.
    schemes : tuple of str
        How addresses begin that are this one's without its name: ``tcp`` for ``tcp://…``.
    """

    called: str
    opened: Callable[[str, int | None], Opened]
    schemes: tuple[str, ...] = ()


class Place(NamedTuple):
    """An executor that was asked for, not opened yet."""

    kind: ExecutorKind
    address: str
    n_workers: int | None

    def opened(self) -> Opened:
        """Open it."""
        return self.kind.opened(self.address, self.n_workers)


def place_of(on: str | None, n_workers: int | None) -> Place:
    """Return the executor that ``NAME``, ``NAME=ADDRESS`` or a bare address names.

    Raises
    ------
    UsageError
        If nobody offers such a one.
    """
    registry = installed()
    name, _, address = (on or USUAL).partition("=")
    if not registry.has(OFFERS, name):
        scheme = name.partition("://")[0] if "://" in name else ""
        kinds = {n: registry.load(OFFERS, n) for n in registry.offered(OFFERS)} if scheme else {}
        taking = [n for n, kind in kinds.items() if scheme in kind.schemes]
        if not taking:
            names = registry.names(OFFERS)
            near = did_you_mean(name, names)
            what = "is no executor, nor an address that one takes (tcp://host:port)"
            raise UsageError(f"--on {on}: {what}; there are: {', '.join(names)}{near}")
        name, address = taking[0], str(on)
    return Place(registry.load(OFFERS, name), address, n_workers)
