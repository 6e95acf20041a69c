"""numba's compiler, made to leave inner kernels as they are and to finish the entry as a whole."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from numba.core import sigutils
from numba.core.codegen import CodeLibrary, JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher

from tactile_graph.compiled.counted import are_its_own, taken_in
from tactile_graph.compiled.given_back import given_back_by_c
from tactile_graph.compiled.kept import ClaimedError, EntryCache, Unkept, kept
from tactile_graph.compiled.looked_at import arrays_looked_at
from tactile_graph.compiled.numbas_own import made_parts
from tactile_graph.compiled.preparing import preparing
from tactile_graph.compiled.reach import Reach

OPTIONS = {"nopython": True, "boundscheck": None, "error_model": "numpy", "nogil": True}
"""Machine code lets other threads of Python run: the one that reads a pad must not wait for it."""

MADE = "arrays and their byte order looked at, given back by C, counted without a lock, sealed"
"""How entries are made, beside numba's version: machine code made otherwise is made anew."""

_entries = 0
_taken_in = False


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
        with made_parts(into_part, offered), arrays_looked_at(), given_back_by_c():
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
        """Return the code; for a library of numba's own, which knows of no parts, with callees."""
        self._ensure_finalized()
        if _taken_in:
            return self._final_module
        module = self._final_module.clone()
        with _taking_in():
            for library in callers_first([self])[1:]:
                module.link_in(library._get_module_for_linking(), True)
        return module


@contextmanager
def _taking_in() -> Iterator[None]:
    """Note that parts are linked by who finds their callees itself."""
    global _taken_in
    before, _taken_in = _taken_in, True
    try:
        yield
    finally:
        _taken_in = before


class Entry(JITCodeLibrary):
    """The code of a kernel that Python calls, with all below it."""

    _linking_libraries: list[CodeLibrary]
    _final_module: Any
    counts_are_its_own = False

    def finalize(self) -> None:
        """Take all code below in, optimise and emit it."""
        preparing.all_together()
        self._linking_libraries = callers_first(self._linking_libraries)
        with _taking_in():
            super().finalize()

    def _optimize_final_module(self) -> None:
        """Optimise in numba's two rounds; between them, counts of references are taken in."""
        if not self.counts_are_its_own:
            super()._optimize_final_module()
            return
        codegen = self._codegen
        first, its_builder = codegen._module_pass_manager(
            loop_vectorize=codegen._loopvect, slp_vectorize=False, opt=codegen._opt_level,
            cost="cheap",
        )  # fmt: skip
        first.run(self._final_module, its_builder)
        self._final_module = taken_in(self._final_module)
        second, its_builder = codegen._module_pass_manager()
        second.run(self._final_module, its_builder)


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


def _key() -> Callable[..., Any]:
    """Return what numba's table of callable functions knows a part by.

    Its dispatchers take only what C wrote; any such function of an object of its own will do, since
    nobody calls it.
    """
    return object().__dir__


class PartCompiler(Compiler):
    """From loops to a part."""

    def define_pipelines(self) -> Any:
        """Return numba's own passes; their last finds a library of ours, and orders to stop."""
        into_part(self.state)
        return super().define_pipelines()

    def compile_extra(self, func: Callable[..., Any]) -> CompileResult:
        """Compile, and offer the part to those that call it."""
        preparing.at(func)
        return offered(super().compile_extra(func))


def into_part(state: Any) -> None:
    """Let a compiler make a part, and stop before machine code."""
    _into(state, Part)
    state.flags.no_cpython_wrapper = True
    state.flags.no_compile = True


def offered(result: CompileResult) -> CompileResult:
    """Return a part as compiled code finds it."""
    key = _key()
    result.target_context.insert_user_function(key, result.fndesc, [result.library])
    return result._replace(entry_point=key)


class EntryCompiler(Compiler):
    """From loops to machine code that Python calls."""

    def define_pipelines(self) -> Any:
        """Return numba's own passes, that fill a library of ours."""
        _into(self.state, Entry)
        self.state.library.counts_are_its_own = are_its_own(self.state.args)
        return super().define_pipelines()

    def compile_extra(self, func: Callable[..., Any]) -> CompileResult:
        """Compile with all below, and hand the code the objects it raises errors with."""
        with _under_way(), preparing.of(func.__name__, len(Reach(func).sizes)):
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

    def compile(self, sig: Any) -> Callable[..., Any]:
        """Return the key of the part for a signature."""
        args, return_type = sigutils.normalize_signature(sig)
        with global_compiler_lock, self._compiling_counter:
            if args not in self.overloads:
                self.overloads[args] = self._compiler.compile(args, return_type)
        key: Callable[..., Any] = self.overloads[args].entry_point
        return key


class EntryDispatcher(CPUDispatcher):
    """The machine code of an entry by the types of its arguments."""

    _cache: EntryCache | Unkept

    @property
    def is_kept(self) -> bool:
        """Whether the machine code is kept on disk, where other processes find it."""
        return self._cache.is_kept

    def compile(self, sig: Any) -> Any:
        """Return the machine code for a signature, from disk if it is there or comes there."""
        try:
            return super().compile(sig)
        finally:
            preparing.n_made += 1
            self._cache.let_go()

    def on_disk(self, args: tuple[Any, ...]) -> bool:
        """Return whether the machine code for types of arguments is there to be loaded."""
        return self._cache.holds(args)

    def compile_unless_claimed(self, sig: Any) -> None:
        """Make the machine code for a signature, unless another process is at these loops."""
        self._cache.waits = False
        try:
            self.compile(sig)
        except ClaimedError:
            pass
        finally:
            self._cache.waits = True


def entry_of(loops: Callable[..., Any]) -> EntryDispatcher:
    """Return what runs the machine code of ``loops``."""
    dispatcher = EntryDispatcher(loops, targetoptions=OPTIONS, pipeline_class=EntryCompiler)
    made_of = f"{Reach(loops).digest} {sorted(OPTIONS.items(), key=str)} {MADE}"
    dispatcher._cache = kept(EntryCache, loops, made_of)
    return dispatcher


def part_of(loops: Callable[..., Any]) -> PartDispatcher:
    """Return what makes parts of ``loops``."""
    return PartDispatcher(loops, targetoptions=OPTIONS, pipeline_class=PartCompiler)
