"""What a kernel's machine code is made of: all kernels beneath it, and a digest of their code."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from hashlib import sha256
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

PLAIN = (int, float, complex, str, bytes, bool, type(None), np.generic)


class Reach:
    """The functions a kernel's loops call, their calls included, and what they read.

    Attributes
    ----------
    sizes : dict of object to int
        Bytes of Python's code of each function, the loops first.
    digest : str
        Changes with the code and the place of any of them and with any constant they read, and with
        nothing else: neither comments nor other functions of their files matter.
    """

    def __init__(self, loops: Callable[..., Any]) -> None:
        self.sizes: dict[Callable[..., Any], int] = {}
        self._hash = sha256()
        self._function(loops)
        self.digest = self._hash.hexdigest()

    def _function(self, function: Any) -> None:
        if function in self.sizes:
            return
        self.sizes[function] = sum(len(code.co_code) for code in _codes(function.__code__))
        # What is kept on disk names the modules its functions came from.
        self._add(f"{function.__module__}.{function.__qualname__}".encode())
        self._code(function.__code__)
        for cell in function.__closure__ or ():
            self._value("", cell.cell_contents, function.__code__)
        names = dict.fromkeys(name for code in _codes(function.__code__) for name in code.co_names)
        for name in names:
            if name in function.__globals__:
                self._value(name, function.__globals__[name], function.__code__)

    def _code(self, code: CodeType) -> None:
        for part in _codes(code):
            plain = [c for c in part.co_consts if not isinstance(c, CodeType)]
            self._add(part.co_code, repr((plain, part.co_names, part.co_varnames)).encode())

    def _value(self, name: str, value: Any, code: CodeType) -> None:
        self._add(name.encode())
        loops = getattr(value, "loops", None) or getattr(value, "py_func", value)
        if isinstance(loops, FunctionType):
            self._function(loops)
        elif isinstance(value, ModuleType):
            self._module(value, code)
        elif isinstance(value, np.ndarray):
            self._add(repr((value.dtype, value.shape)).encode(), value.tobytes())
        elif isinstance(value, PLAIN):
            self._add(repr(value).encode())
        elif isinstance(value, tuple):
            for item in value:
                self._value("", item, code)
        elif isinstance(value, type):
            fields = repr(getattr(value, "__annotations__", None))
            self._add(f"{value.__module__}.{value.__qualname__}{fields}".encode())

    def _module(self, module: ModuleType, code: CodeType) -> None:
        """Look at what is read of a module of the project's or a plugin's own."""
        self._add(module.__name__.encode())
        if module.__name__.split(".")[0] in ("numpy", "math", "numba", "cmath", "operator"):
            return
        for name in code.co_names:
            if name in vars(module):
                self._value(name, vars(module)[name], code)

    def _add(self, *parts: bytes) -> None:
        for part in parts:
            self._hash.update(len(part).to_bytes(8, "little"))
            self._hash.update(part)


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for const in code.co_consts:
        if isinstance(const, CodeType):
            yield from _codes(const)
