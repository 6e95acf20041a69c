"""Machine code on disk: what cannot be read is made anew, what cannot be written is used unkept."""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable
from contextlib import suppress
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from typing import Any

from numba.core import config
from numba.core.caching import FunctionCache, IndexDataCacheFile, NullCache
from numba.core.compiler import CompileResult
from numba.core.registry import cpu_target
from numba.core.runtime import rtsys

from tactile_graph.compiled.preparing import preparing
from tactile_graph.locks import Lock

POLL_S = 0.02
"""Between two looks whether another process has finished."""


class ClaimedError(Exception):
    """Another process makes this machine code just now."""


class Sealed(IndexDataCacheFile):
    """numba's files, each under a digest: a damaged one counts as missing.

    So does one of other loops or other types: where an index was written and its data was not, as
    on a full disk, numba would take what lies there for what it looks for.
    """

    def load(self, key: Any) -> Any:
        """Return what was kept under a key, None if it is not there whole."""
        with suppress(Exception):  # damaged files raise whatever pickle comes across
            of, digest, data = super().load(key)
            if of == (self._source_stamp, key) and digest == sha256(data).digest():
                return pickle.loads(data)
        return None

    def save(self, key: Any, data: Any) -> None:
        """Keep data under a key."""
        whole = self._dump(data)
        super().save(key, ((self._source_stamp, key), sha256(whole).digest(), whole))

    def _load_index(self) -> Any:
        try:
            return super()._load_index()
        except Exception:
            return {}


class Kept(FunctionCache):
    """Machine code on disk, of which no file can fail whoever asks for it.

    Parameters
    ----------
    loops : function
    made_of : str, optional
        What outdates the code by a change; the source file unless it is given.
    """

    ending = "sealed"
    """Of the files' names, which are not numba's own."""
    is_kept = True

    def __init__(self, loops: Callable[..., Any], made_of: str = "") -> None:
        super().__init__(loops)
        self._file_name = f"{self._impl.filename_base}.{self.ending}"
        stamp = made_of or self._impl.locator.get_source_stamp()
        self._cache_file = Sealed(self.cache_path, self._file_name, stamp)

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        """Return what is on disk for a signature, None if nothing is."""
        target_context.refresh()
        return self._on_disk(sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the code, or have it told that it could not be."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            preparing.unkept(f"{self.cache_path}: {error.strerror or error}")

    def _on_disk(self, sig: Any, target_context: Any) -> CompileResult | None:
        with suppress(Exception):
            found: CompileResult | None = self._load_overload(sig, target_context)
            return found
        return None


class EntryCache(Kept):
    """An entry's machine code on disk, outdated by a change of anything it is made of."""

    ending = "whole"

    def __init__(self, loops: Callable[..., Any], made_of: str) -> None:
        super().__init__(loops, made_of)
        self._name = loops.__name__
        self.waits = True
        self._claim = Lock(Path(self.cache_path, f"{self._file_name}.lock"))

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        """Return what is on disk for a signature, None if nothing is and it is ours to make.

        While another process makes the machine code of these loops, its end is waited for.

        numba alone gets ready to compile first: it imports how each function is lowered, and
        scipy's linear algebra, which takes longer than to load the code. The compiler does so
        itself when nothing is found. Loaded code needs the symbols of numba's runtime only, and
        of its hashing.
        """
        import_module("numba.cpython.hashing")
        rtsys.initialize(target_context)
        found = self._on_disk(sig, target_context)
        if found is None and self._claimed():
            return self._on_disk(sig, target_context)  # another may have made it just now
        return found

    def holds(self, args: tuple[Any, ...]) -> bool:
        """Return whether the code for types of arguments is there, without loading it."""
        key = self._index_key(args, cpu_target.target_context.codegen())
        return key in self._cache_file._load_index()

    def _claimed(self) -> bool:
        """Wait until no other process makes these loops; return whether others now wait for us.

        Where the folder knows no locks, two may make the same, as numba alone would.

        Raises
        ------
        ClaimedError
            In place of waiting, where `waits` is False.
        """
        try:
            if self._claim.take():
                return True
            if not self.waits:
                raise ClaimedError
            with preparing.elsewhere(self._name) as tell:
                while not self._claim.take():
                    time.sleep(POLL_S)
                    tell()
        except OSError:
            return False
        return True

    def let_go(self) -> None:
        """Say that these loops are made, or could not be."""
        self._claim.release()


class Unkept(NullCache):
    """In place of a cache where no folder takes one: machine code lives as long as its process."""

    is_kept = False
    waits = True

    def holds(self, _args: tuple[Any, ...]) -> bool:
        """Return that nothing is there."""
        return False

    def let_go(self) -> None:
        """Nobody waits."""


def kept(kind: type[Kept], loops: Callable[..., Any], made_of: str = "") -> Kept | Unkept:
    """Return what keeps the machine code of loops, or does not where that is not possible."""
    try:
        return kind(loops, made_of)
    except (RuntimeError, OSError):  # numba's word for no folder that can be written to
        preparing.on_first = None  # another process could hand nothing over
        named = f"NUMBA_CACHE_DIR={config.CACHE_DIR}, " if config.CACHE_DIR else ""
        preparing.unkept(f"{named}the package's folder and the user's cache cannot be written to")
        return Unkept()
