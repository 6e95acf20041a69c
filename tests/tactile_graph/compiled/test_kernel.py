"""A kernel is answered by plain or by machine code, whichever mode, calls and sizes say."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tactile_graph.compiled import (
    SWITCH_AFTER_CALLS,
    SWITCH_AFTER_ELEMENTS,
    Kernel,
    compiled_as_is,
    compiled_later,
    compiled_twin_of,
    kernel,
    warm_up,
)
from tactile_graph.errors import UsageError


def plain(x: Any) -> str:
    return "plain"


class Light(Kernel[Any, Any]):
    """A kernel that is plain first, with a stand-in for a compiler."""

    def __init__(self) -> None:
        super().__init__(plain, plain, plain_first=True)

    @property
    def compiled(self) -> Any:
        return lambda x: "compiled"


@pytest.fixture(autouse=True)
def clean(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TACTILE_GRAPH_KERNELS", raising=False)
    monkeypatch.setattr(kernel, "_warm", False)
    monkeypatch.setattr(kernel, "_kernels", [])


def test_plain_code_answers_until_the_calls_are_many() -> None:
    light = Light()
    answers = [light(1.0) for _ in range(SWITCH_AFTER_CALLS + 3)]
    assert answers == ["plain"] * SWITCH_AFTER_CALLS + ["compiled"] * 3


def test_one_large_array_is_worth_the_compiler_at_once() -> None:
    large = np.empty(SWITCH_AFTER_ELEMENTS + 1, dtype=bool)
    assert Light()(large) == "compiled"


def test_elements_are_counted_over_the_calls() -> None:
    light = Light()
    part = np.empty(SWITCH_AFTER_ELEMENTS // 4)
    assert [light(part) for _ in range(5)] == ["plain"] * 4 + ["compiled"]


def test_loops_that_are_slow_count_for_as_many_passes() -> None:
    light = Light()
    light.passes = 4
    part = np.empty(SWITCH_AFTER_ELEMENTS // 8)
    assert [light(part) for _ in range(3)] == ["plain"] * 2 + ["compiled"]


def test_arrays_of_records_are_counted() -> None:
    assert Light()((np.empty(SWITCH_AFTER_ELEMENTS), np.empty(1))) == "compiled"


def test_kernels_that_are_never_plain_are_compiled_before_their_first_answer() -> None:
    class Heavy(Light):
        def __init__(self) -> None:
            Kernel.__init__(self, plain, plain, plain_first=False)

    assert Heavy()(1.0) == "compiled"


def test_the_decorators_say_when_to_compile() -> None:
    def other(x: Any) -> str:
        return "plain"

    made = [compiled_as_is(plain), compiled_later(plain), compiled_twin_of(plain)(other)]
    assert [k.plain_first for k in made] == [False, True, True]
    assert [k.reference for k in made] == [plain] * 3
    assert [k.loops for k in made] == [plain, plain, other]


def test_warm_up_switches_at_once_and_for_kernels_to_come() -> None:
    old = Light()
    assert old(1.0) == "plain"
    warm_up()
    assert old(1.0) == "compiled"
    assert Light()(1.0) == "compiled"


@pytest.mark.parametrize(("mode", "answer"), [("plain", "plain"), ("compiled", "compiled")])
def test_the_environment_decides(monkeypatch: pytest.MonkeyPatch, mode: str, answer: str) -> None:
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", mode)
    light = Light()
    warm_up()
    assert {light(1.0) for _ in range(SWITCH_AFTER_CALLS + 3)} == {answer}


def test_a_mode_that_is_none_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", "plane")
    with pytest.raises(
        UsageError,
        match="TACTILE_GRAPH_KERNELS='plane': must be one of auto, plain, "
        "compiled; did you mean 'plain'",
    ):
        Light()


def test_keyword_arguments_are_refused_not_lost() -> None:
    with pytest.raises(TypeError, match=r"plain\(\) takes positional arguments only, got \['x'\]"):
        Light()(x=1.0)


def test_a_kernel_looks_like_its_reference() -> None:
    def doubled(x: float) -> float:
        """Return twice as much."""
        return 2.0 * x

    @compiled_twin_of(doubled)
    def kernel(x: float) -> float:
        return x + x

    assert (kernel.__name__, kernel.__doc__) == ("doubled", "Return twice as much.")
    assert kernel(2.0) == kernel.loops(2.0) == 4.0


@pytest.mark.parametrize("mode", ["auto", "plain"])
def test_plain_loops_are_silent_and_answer_python_numbers(
    monkeypatch: pytest.MonkeyPatch, mode: str
) -> None:
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", mode)

    @compiled_later
    def kernel(x: Any) -> Any:
        return x[0] - x[0], (x[1] + 1.0, x[1] > 0.0)

    nothing, (more, above) = kernel(np.array([np.inf, 1.0]))
    assert np.isnan(nothing)
    assert (more, above) == (2.0, True)
    assert [type(v) for v in (nothing, more, above)] == [float, float, bool]


def test_plain_loops_within_others_keep_their_kind_of_numbers() -> None:
    @compiled_later
    def inner(x: Any) -> Any:
        return x[0]

    @compiled_later
    def outer(x: Any) -> Any:
        return 1.0 / inner(x)

    assert outer(np.zeros(1)) == np.inf
    assert type(inner(np.zeros(1))) is float


def grown(values: Any, out: Any) -> float:
    """Write to ``out`` before it comes to what Python calls an overflow."""
    for i in range(values.shape[0]):
        out[i] += 1.0
        out[i] *= math.exp(values[i])
    return float(out[0])


@pytest.mark.slow
def test_what_python_refuses_as_no_number_machine_code_answers() -> None:
    kernel = compiled_later(grown)
    out = np.ones(2)

    assert kernel(np.array([0.0, 1000.0]), out) == 2.0
    np.testing.assert_array_equal(out, [2.0, np.inf])


def test_plain_code_alone_says_what_it_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", "plain")
    kernel = compiled_later(grown)

    with pytest.raises(OverflowError):
        kernel(np.array([1000.0]), np.ones(1))
