"""numba's own functions within an entry: parts of it, as its kernels are, with a plainer error.

What numpy's functions do in compiled code is itself Python that numba compiles, each function to
machine code of its own, which is not needed where the entry takes the function in. The text of one
error, of a slice assigned from another shape, takes longer to compile than most kernels.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from numba.core.compiler import Compiler, CompileResult
from numba.extending import overload
from numba.np import arrayobj

FOLDERS = ("numba.np.", "numba.cpython.", "numba.core.")
"""Where the functions live that only compiled code calls."""


def shapes_differ(source: Any, target: Any) -> None:
    """Stand for the error of a slice assigned from another shape."""


@overload(shapes_differ)
def _shapes_differ(source: Any, target: Any) -> Callable[[Any, Any], None]:
    def raised(source: Any, target: Any) -> None:
        raise ValueError("cannot assign to a slice what has another shape")

    return raised


@contextmanager
def made_parts(
    into_part: Callable[[Any], None], offered: Callable[[CompileResult], CompileResult]
) -> Iterator[None]:
    """Let numba make parts of its own functions, and raise the plain error.

    Parameters
    ----------
    into_part : callable
        Takes a compiler's state, and lets it make a part.
    offered : callable
        Returns what came of it as compiled code finds it.
    """
    numbas: Any = Compiler
    compile_extra, define_pipelines = numbas.compile_extra, numbas.define_pipelines
    told = arrayobj.raise_with_shape_context

    def compiled(self: Any, func: Callable[..., Any]) -> CompileResult:
        result: CompileResult = compile_extra(self, func)
        return offered(result) if _its_own(self) else result

    def pipelines(self: Any) -> Any:
        if _its_own(self):
            into_part(self.state)
        return define_pipelines(self)

    numbas.compile_extra, numbas.define_pipelines = compiled, pipelines
    arrayobj.raise_with_shape_context = shapes_differ
    try:
        yield
    finally:
        numbas.compile_extra, numbas.define_pipelines = compile_extra, define_pipelines
        arrayobj.raise_with_shape_context = told


def _its_own(compiler: Any) -> bool:
    name: str = compiler.state.func_id.modname
    return type(compiler) is Compiler and name.startswith(FOLDERS)
