"""numba's compiler, made to leave inner kernels as they are and to finish the entry as a whole."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from numba import njit
from numba.core import sigutils
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.codegen import CodeLibrary, JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys

from tactile_graph.compiled.preparing import preparing
from tactile_graph.compiled.reach import Reach

_entries = 0


def entry_under_way() -> bool:
    """Return whether an entry is being compiled, so that kernels found on the way are its parts."""
    return _entries > 0


@contextmanager
def _under_way() -> Iterator[None]:
    """Note that an entry is compiled, and spare the compiler the collection of garbage.

    Its millions of small objects live until the end; searching them for garbage takes a fifth of
    the time.
    """
    global _entries
    collecting = gc.isenabled()
    gc.disable()
    _entries += 1
    try:
        yield
    finally:
        _entries -= 1
        if collecting:
            gc.enable()


class Part(JITCodeLibrary):
    """The code of a kernel within others: neither optimised nor emitted, callees not taken in."""

    def add_llvm_module(self, ll_module: Any) -> None:
        """Take code in as it is."""
        self._final_module.link_in(ll_module)

    def finalize(self) -> None:
        """Close the library; what turns out not to be called may be dropped by who takes it in."""
        self._raise_if_finalized()
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage.name == "external":
                function.linkage = "linkonce_odr"
        self._finalize_dynamic_globals()
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        self._ensure_finalized()
        return self._final_module


class Entry(JITCodeLibrary):
    """The code of a kernel that Python calls, with all below it."""

    _linking_libraries: list[CodeLibrary]

    def finalize(self) -> None:
        """Take all code below in, optimise and emit it."""
        preparing.all_together()
        self._linking_libraries = callers_first(self._linking_libraries)
        super().finalize()


def callers_first(libraries: Iterable[CodeLibrary]) -> list[CodeLibrary]:
    """Return the libraries and all that parts among them call, none before one that calls it.

    The linker leaves out what nobody called so far.
    """
    callees_first: dict[CodeLibrary, None] = {}

    def visit(library: CodeLibrary) -> None:
        if library not in callees_first:
            if isinstance(library, Part):
                for callee in library._linking_libraries:
                    visit(callee)
            callees_first[library] = None

    for library in libraries:
        visit(library)
    return list(reversed(callees_first))


class _Key:
    """What numba's table of callable functions knows a part by."""


class PartCompiler(Compiler):
    """From loops to a part."""

    def define_pipelines(self) -> Any:
        """Return numba's own passes; their last finds a library of ours, and orders to stop."""
        _into(self.state, Part)
        self.state.flags.no_cpython_wrapper = True
        self.state.flags.no_compile = True
        return super().define_pipelines()

    def compile_extra(self, func: Callable[..., Any]) -> CompileResult:
        """Compile, and offer the part to those that call it."""
        preparing.at(func)
        result = super().compile_extra(func)
        key = _Key()
        result.target_context.insert_user_function(key, result.fndesc, [result.library])
        return result._replace(entry_point=key)


class EntryCompiler(Compiler):
    """From loops to machine code that Python calls."""

    def define_pipelines(self) -> Any:
        """Return numba's own passes, that fill a library of ours."""
        _into(self.state, Entry)
        return super().define_pipelines()

    def compile_extra(self, func: Callable[..., Any]) -> CompileResult:
        """Compile with all below, and hand the code the objects it raises errors with."""
        with _under_way(), preparing.of(func.__name__, Reach(func).n_kernels):
            preparing.at(func)
            result = super().compile_extra(func)
        for environment in result._find_referenced_environments():
            result.codegen.set_env(environment.env_name, environment)
        return result


def _into(state: Any, kind: type[JITCodeLibrary]) -> None:
    state.library = kind(state.targetctx.codegen(), state.func_id.func_qualname)
    state.library.enable_object_caching()
    state.flags.no_cfunc_wrapper = True


class PartDispatcher(CPUDispatcher):
    """The parts made of one kernel, by the types of its arguments; never called from Python."""

    def compile(self, sig: Any) -> _Key:
        """Return the key of the part for a signature."""
        args, return_type = sigutils.normalize_signature(sig)
        with global_compiler_lock, self._compiling_counter:
            if args not in self.overloads:
                self.overloads[args] = self._compiler.compile(args, return_type)
        key: _Key = self.overloads[args].entry_point
        return key


class EntryCache(FunctionCache):
    """An entry's machine code on disk, outdated by a change of anything it is made of."""

    def __init__(self, loops: Callable[..., Any]) -> None:
        super().__init__(loops)
        self._cache_file = IndexDataCacheFile(
            self.cache_path, f"{self._impl.filename_base}.whole", Reach(loops).digest
        )

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        """Return what is on disk for a signature, None if nothing is.

        numba alone gets ready to compile first: it imports how each function is lowered, and
        scipy's linear algebra, which takes longer than to load the code. The compiler does so
        itself when nothing is found. Loaded code needs the symbols of numba's runtime only, and
        of its hashing.
        """
        import_module("numba.cpython.hashing")
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            found: CompileResult | None = self._load_overload(sig, target_context)
        return found


def entry_of(loops: Callable[..., Any]) -> Callable[..., Any]:
    """Return what runs the machine code of ``loops``."""
    dispatcher: Any = njit(pipeline_class=EntryCompiler, error_model="numpy")(loops)
    dispatcher._cache = EntryCache(loops)
    called: Callable[..., Any] = dispatcher
    return called


def part_of(loops: Callable[..., Any]) -> PartDispatcher:
    """Return what makes parts of ``loops``."""
    options = {"nopython": True, "boundscheck": None, "error_model": "numpy"}
    return PartDispatcher(loops, targetoptions=options, pipeline_class=PartCompiler)
