"""A kernel runs as its reference or its twin, whichever the mode and the number of calls say."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import pytest

from tactile_graph import compiled
from tactile_graph.compiled import SWITCH_AFTER, Kernel, compiled_twin_of, have_compiler, warm_up
from tactile_graph.errors import UsageError

needs_numba = pytest.mark.skipif(not have_compiler(), reason="numba is not installed")


def plain(x: float) -> str:
    return "plain"


class Twin(Kernel[Any, Any]):
    """A kernel whose compiler is a stand-in, so that no time goes into compiling."""

    @property
    def compiled(self) -> Any:
        return lambda x: "compiled"


@pytest.fixture(autouse=True)
def clean(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.delenv("TACTILE_GRAPH_KERNELS", raising=False)
    monkeypatch.setattr(compiled, "_warm", False)
    monkeypatch.setattr(compiled, "_kernels", [])
    have_compiler.cache_clear()
    yield
    have_compiler.cache_clear()


def with_compiler(monkeypatch: pytest.MonkeyPatch, there: bool) -> None:
    monkeypatch.setattr(compiled, "find_spec", lambda name: object() if there else None)
    have_compiler.cache_clear()


def test_the_reference_serves_until_the_twin_pays(monkeypatch: pytest.MonkeyPatch) -> None:
    with_compiler(monkeypatch, True)
    kernel = Twin(plain, plain)
    answers = [kernel(1.0) for _ in range(SWITCH_AFTER + 3)]
    assert answers == ["plain"] * SWITCH_AFTER + ["compiled"] * 3


def test_warm_up_switches_at_once_and_for_kernels_to_come(monkeypatch: pytest.MonkeyPatch) -> None:
    with_compiler(monkeypatch, True)
    old = Twin(plain, plain)
    assert old(1.0) == "plain"
    warm_up()
    assert old(1.0) == "compiled"
    assert Twin(plain, plain)(1.0) == "compiled"


@pytest.mark.parametrize(("mode", "answer"), [("plain", "plain"), ("compiled", "compiled")])
def test_the_environment_decides(monkeypatch: pytest.MonkeyPatch, mode: str, answer: str) -> None:
    with_compiler(monkeypatch, True)
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", mode)
    kernel = Twin(plain, plain)
    warm_up()
    assert {kernel(1.0) for _ in range(SWITCH_AFTER + 3)} == {answer}


def test_a_mode_that_is_none_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", "plane")
    with pytest.raises(
        UsageError,
        match="TACTILE_GRAPH_KERNELS='plane': must be one of auto, plain, "
        "compiled; did you mean 'plain'",
    ):
        Twin(plain, plain)


def test_without_a_compiler_the_reference_serves_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    with_compiler(monkeypatch, False)
    kernel = Kernel(plain, plain)
    warm_up()
    assert {kernel(1.0) for _ in range(SWITCH_AFTER + 3)} == {"plain"}


def test_a_compiler_that_is_there_but_broken_is_done_without(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with_compiler(monkeypatch, True)
    monkeypatch.setitem(sys.modules, "numba", None)
    kernel = Kernel(plain, plain)
    assert {kernel(1.0) for _ in range(SWITCH_AFTER + 3)} == {"plain"}


def test_a_broken_compiler_is_told_to_who_insists(monkeypatch: pytest.MonkeyPatch) -> None:
    with_compiler(monkeypatch, True)
    monkeypatch.setitem(sys.modules, "numba", None)
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", "compiled")
    with pytest.raises(ImportError):
        Kernel(plain, plain)(1.0)


def test_keyword_arguments_are_refused_not_lost() -> None:
    with pytest.raises(TypeError, match=r"plain\(\) takes positional arguments only, got \['x'\]"):
        Kernel(plain, plain)(x=1.0)


def test_a_kernel_looks_like_its_reference() -> None:
    def doubled(x: float) -> float:
        """Return twice as much."""
        return 2.0 * x

    @compiled_twin_of(doubled)
    def kernel(x: float) -> float:
        return x + x

    assert (kernel.__name__, kernel.__doc__) == ("doubled", "Return twice as much.")
    assert kernel(2.0) == kernel.loops(2.0) == 4.0


@needs_numba
def test_a_real_twin_is_compiled_and_agrees() -> None:
    from helpers_kernels import total

    assert total.compiled(3.0, 4) == total.reference(3.0, 4) == 12.0
    assert total.compiled.signatures
