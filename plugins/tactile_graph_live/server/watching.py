"""Files as people save them: what is read with a pipeline is looked at many times a second."""

from __future__ import annotations

import asyncio
import os
from collections import ChainMap
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass
from hashlib import sha256

from tactile_graph import Pipeline

Stamp = tuple[int, int, int] | None
Stamps = dict[str, Stamp]
Contents = dict[str, Stamp | bytes]
LOOK_S = 0.05
SETTLE_S = 0.12
"""An editor that writes in several steps is done by then; only mistakes wait so long."""
RECORDED = ".zarr/"
MOST_BYTES = 1 << 22
"""Of a file whose content is compared."""


@dataclass(frozen=True)
class FileSense:
    """How files are looked at.

    Parameters
    ----------
    stamp : callable
        Returns what changes of a file when it is saved.
    reading : callable
        Returns a context in which every file that is opened is entered into a dict with its stamp.
    read_source : callable
        Opens the files that a pipeline's source names, but for recordings, which are long or grow.
        Raises `PipelineError` if one is wrong.
    """

    stamp: Callable[[str], Stamp]
    reading: Callable[[Stamps], AbstractContextManager[None]]
    read_source: Callable[[Pipeline], None]


class Watched:
    """The files a pipeline was read from, and those that were looked for."""

    def __init__(self, sense: FileSense, named: Iterable[str]) -> None:
        self._sense = sense
        self._named = tuple(named)
        self._stamps: Stamps = {name: sense.stamp(name) for name in self._named}

    def take(self, *reads: Callable[[], object]) -> list[Stamps]:
        """Have files read, and watch from now on what was read; return what each has read.

        Where one raises, what was watched before is watched on: it may be that a file is gone.
        """
        before = {name: self._sense.stamp(name) for name in (*self._named, *self._stamps)}
        each: list[Stamps] = []
        kept: set[str] = set(before)
        try:
            for read in reads:
                each.append({})
                with self._sense.reading(each[-1]):
                    read()
            kept &= {*self._named, *ChainMap(*each)}
        finally:
            found = {k: v for k, v in ChainMap(*each).items() if RECORDED not in k}
            self._stamps = found | {name: before[name] for name in kept}
        return each

    def contents(self, stamps: Stamps) -> Contents:
        """Return a digest of what stands in each file: one saved as it was is no other.

        Of what is gone, is long, or was saved again since it was read, the stamp.
        """
        found: Contents = {}
        for name, was in stamps.items():
            found[name] = was
            if not os.path.isfile(name):
                continue  # a pipe would be waited for
            with suppress(OSError), open(name, "rb") as file:
                data = file.read(MOST_BYTES + 1)
                if len(data) <= MOST_BYTES and self._sense.stamp(name) == was:
                    found[name] = sha256(data).digest()
        return found

    def changed(self) -> bool:
        """Return whether a file is no longer what it was when it was read."""
        return any(self._sense.stamp(name) != was for name, was in self._stamps.items())

    async def change(self) -> None:
        """Return when a file has changed."""
        while not self.changed():
            await asyncio.sleep(LOOK_S)
