"""Each meaning of "skipped" and "failed", one by one."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pytest

from helpers_graphs import CALLS, STEPS, frame, registry
from tactile_graph import Degenerate, Frame, Image, Skip, loads
from tactile_graph.engine.outcomes.outcome import DONE, Failed, Skipped
from tactile_graph.engine.outcomes.outcomes import NoResult
from tactile_graph.errors import UsageError
from tactile_graph.steps import TimeGap

WRITTEN: list[int] = []


def write(a: int, *, tag: str = "") -> None:
    CALLS.append(tag)
    WRITTEN.append(a)


def noise(image: Image, *, tag: str = "", rng: np.random.Generator) -> float:
    return float(rng.random())


def dice(*, sides: int = 10**9, rng: np.random.Generator) -> int:
    return int(rng.integers(sides))


def throw(a: int, *, rng: np.random.Generator) -> float:
    return float(rng.random())


class Walk:
    """A random walk: the generator is handed over once."""

    def __init__(self, *, rng: np.random.Generator) -> None:
        self.rng = rng
        self.at = 0.0

    def __call__(self, image: Image) -> float:
        self.at += float(self.rng.random())
        return self.at


class Since:
    def __init__(self) -> None:
        self.n = 0

    def __call__(self, image: Image, *, gap: TimeGap) -> tuple[int, float]:
        self.n += 1
        return self.n, -1.0 if gap is None else gap


class Table:
    """Turns its setting into a table once."""

    stateless = True
    made = 0

    def __init__(self, *, n: int = 3) -> None:
        Table.made += 1
        self.table = list(range(n))

    def __call__(self, image: Image) -> int:
        return self.table[-1]


class Arrays(NamedTuple):
    one: np.ndarray[Any, Any]
    more: list[np.ndarray[Any, Any]]


def arrays(image: Image) -> Arrays:
    return Arrays(np.zeros(3), [np.ones(2)])


def nothing(image: Image) -> int:
    return None  # type: ignore[return-value]


def images(image: Image) -> list[Image]:
    return [image.with_values(image.values + i) for i in range(int(image.values[0, 0]))]


def at_least(a: int, *, least: int = 0) -> int:
    if a < least:
        raise Skip(f"{a} is too small")
    return a


def told(items: Sequence[int | None]) -> str:
    return " ".join("-" if i is None else str(i) for i in items)


def zipped(a: list[int], b: list[int]) -> int:
    return sum(x * y for x, y in zip(a, b, strict=True))


MORE = {
    **STEPS,
    "write": write,
    "noise": noise,
    "dice": dice,
    "throw": throw,
    "walk": Walk,
    "since": Since,
    "table": Table,
    "arrays": arrays,
    "nothing": nothing,
    "images": images,
    "at_least": at_least,
    "told": told,
    "zipped": zipped,
}


def make(nodes: str, outputs: str, more: str = "") -> Any:
    body = "\n".join(f"  {line.strip()}" for line in nodes.strip().splitlines())
    text = f"pipeline: p\n{more}\nnodes:\n{body}\noutputs: [{outputs}]\n"
    return loads(text, "p.yaml", registry(MORE))


def run(pipeline: Any, number: float = 3, **rest: Any) -> Any:
    CALLS.clear()
    return pipeline.run(frame(number), **rest)


V = "v: {step: read, in: frame, with: {tag: v}}"


# -- demand ------------------------------------------------------------------------------------


def test_only_what_the_outputs_need_runs() -> None:
    p = make(f"{V}\nb: {{step: add1, in: v, with: {{tag: b}}}}\nc: {{step: add1, in: v}}", "b")
    assert run(p)["b"] == 4
    assert CALLS == ["v", "b"]


def test_other_nodes_can_be_asked_for_and_fields_of_nodes() -> None:
    p = make(f"{V}\nb: {{step: pair, in: v, with: {{tag: b}}}}", "v")
    assert run(p, only=["b.high"])["b.high"] == 13
    assert CALLS == ["v", "b"]


def test_a_node_nobody_asked_for_says_so() -> None:
    p = make(f"{V}\nb: {{step: add1, in: v}}", "v")
    outcome = run(p).outcome("b")
    assert isinstance(outcome, Skipped)
    assert outcome.reason == "nothing asked for it"


def test_asking_for_what_is_not_there_names_what_is_near() -> None:
    p = make(f"{V}\nbig: {{step: add1, in: v}}", "big")
    with pytest.raises(UsageError, match="no node named 'bigg'; did you mean 'big'"):
        run(p, only=["bigg"])
    with pytest.raises(UsageError, match="no node or output named 'bgi'; did you mean 'big'"):
        run(p).outcome("bgi")
    with pytest.raises(UsageError, match=r"named 'zz'; there are: big, v$"):
        run(p).outcome("zz")
    with pytest.raises(UsageError, match=r"big \(int\) has no field 'x'"):
        run(p, only=["big.x"])


def test_a_sink_runs_when_it_is_asked_for_and_only_then() -> None:
    p = make(f"{V}\nout: {{step: write, in: v, with: {{tag: out}}}}", "v")
    WRITTEN.clear()
    run(p)
    assert WRITTEN == []
    assert run(p, only=["out"])["out"] is DONE
    assert WRITTEN == [3]


def test_a_sink_writes_equal_frames_too() -> None:
    runner = make(f"{V}\nout: {{step: write, in: v}}", "out").runner()
    WRITTEN.clear()
    for _ in range(3):
        assert not runner(frame(3)).reused
    assert WRITTEN == [3, 3, 3]


# -- guards ------------------------------------------------------------------------------------

GUARDED = f"""{V}
costly: {{step: add1, in: v, with: {{tag: costly}}}}
g: {{step: add1, in: costly, when: v > 3, with: {{tag: g}}}}"""


def test_inputs_are_not_computed_where_the_guard_is_false() -> None:
    result = run(make(GUARDED, "g"))
    assert CALLS == ["v"]
    outcome = result.outcome("g")
    assert (outcome.origin, outcome.reason) == ("g", "when v > 3 is false (v = 3)")
    assert "g" not in result
    assert not result.ok


def test_inputs_are_computed_after_the_guard_where_it_holds() -> None:
    assert run(make(GUARDED, "g"), 4)["g"] == 6
    assert CALLS == ["v", "costly", "g"]


def test_taking_a_skipped_output_says_why() -> None:
    with pytest.raises(NoResult, match=r"'g' was skipped: when v > 3 is false \(v = 3\)"):
        run(make(GUARDED, "g"))["g"]


def test_a_guard_that_reads_something_skipped_skips_with_its_origin() -> None:
    p = make(f"{GUARDED}\nh: {{step: add1, in: v, when: g > 1}}", "h")
    assert run(p).outcome("h").origin == "g"


def test_a_guard_that_reads_something_failed_fails_with_its_origin() -> None:
    p = make(
        f"{V}\nf: {{step: picky, in: v, with: {{bad: 1}}}}\nh: {{step: add1, in: v, when: f > 1}}",
        "h",
    )
    outcome = run(p).outcome("h")
    assert isinstance(outcome, Failed)
    assert outcome.origin == "f"


def test_a_guard_that_cannot_be_computed_fails_its_node() -> None:
    p = make(f"{V}\nh: {{step: add1, in: v, when: 1 / (v - 3) > 0}}", "h")
    outcome = run(p).outcome("h")
    assert (outcome.origin, outcome.step) == ("h", "when 1 / (v - 3) > 0")
    assert outcome.reason == "ZeroDivisionError: division by zero"


def test_a_guard_over_an_unknown_field_skips() -> None:
    """A field that holds None has no value."""
    p = make(f"{V}\nb: {{step: pair, in: v}}\nh: {{step: add1, in: v, when: b.note > 0}}", "h")
    outcome = run(p, 4).outcome("h")
    assert (outcome.origin, outcome.reason) == ("b.note", "b.note is not known")


def test_named_conditions_may_name_others() -> None:
    p = make(
        f"{V}\nh: {{step: add1, in: v, when: big and not huge}}",
        "h",
        "conditions: {big: v > 3, huge: big and v > 9}",
    )
    assert [run(p, n).ok for n in (3, 4, 10)] == [False, True, False]


def test_a_node_may_be_named_like_a_function_of_conditions() -> None:
    p = make(f"h: {{step: add1, in: max, when: 'max(max, 2) > 2'}}\nmax: {V[3:]}", "h")
    assert run(p)["h"] == 4


# -- first_of ----------------------------------------------------------------------------------

CHOICE = f"""{V}
cheap: {{step: add1, in: v, when: v > 3, with: {{tag: cheap}}}}
dear: {{step: add1, in: v, with: {{tag: dear, k: 100}}}}
best: {{first_of: [cheap, dear]}}"""


def test_the_second_choice_runs_only_where_the_first_has_no_value() -> None:
    p = make(CHOICE, "best")
    assert run(p, 4)["best"] == 5
    assert CALLS == ["v", "cheap"]
    assert run(p, 3)["best"] == 103
    assert CALLS == ["v", "dear"]


def test_first_of_recovers_from_a_failure_that_is_still_reported() -> None:
    p = make(
        f"{V}\nf: {{step: picky, in: v, with: {{bad: 3}}}}\nbest: {{first_of: [f, v]}}", "best"
    )
    result = run(p)
    assert result["best"] == 3
    assert [f.origin for f in result.failures] == ["f"]


def test_first_of_without_any_value_fails_where_one_failed_else_skips() -> None:
    nodes = f"""{V}
    s: {{step: add1, in: v, when: v > 9}}
    f: {{step: picky, in: v, with: {{bad: 3}}}}
    fs: {{first_of: [s, f]}}
    ss: {{first_of: [s]}}"""
    result = run(make(nodes, "fs, ss"))
    assert isinstance(result.outcome("fs"), Failed)
    assert result.outcome("fs").origin == "f"
    assert isinstance(result.outcome("ss"), Skipped)
    assert result.outcome("ss").origin == "s"


def test_first_of_can_be_guarded_itself() -> None:
    p = make(f"{CHOICE}\nmaybe: {{first_of: [cheap, dear], when: v > 5}}", "maybe")
    assert run(p, 5).outcome("maybe").origin == "maybe"
    assert CALLS == ["v"]
    assert run(p, 6)["maybe"] == 7


# -- ports -------------------------------------------------------------------------------------


def test_a_skip_and_its_origin_travel_down_the_required_ports() -> None:
    p = make(
        f"{GUARDED}\nh: {{step: add1, in: g, with: {{tag: h}}}}\ni: {{step: add1, in: h}}", "i"
    )
    assert run(p).outcome("i").origin == "g"
    assert CALLS == ["v"]


def test_ports_after_a_skipped_one_are_not_computed() -> None:
    p = make(
        f"{GUARDED}\nx: {{step: add1, in: v, with: {{tag: x}}}}\nh: {{step: add2, in: [g, x]}}", "h"
    )
    run(p)
    assert CALLS == ["v"]
    assert run(p, 4)["h"] == 16


def test_an_optional_port_takes_its_default_where_it_is_skipped() -> None:
    p = make(f"{GUARDED}\nh: {{step: optional, in: [v, g]}}", "h")
    assert run(p)["h"] == 3 - 7
    assert run(p, 4)["h"] == 4 - 6


def test_an_optional_port_fails_where_what_it_reads_failed() -> None:
    p = make(
        f"{V}\nf: {{step: picky, in: v, with: {{bad: 1}}}}\nh: {{step: optional, in: [v, f]}}", "h"
    )
    assert run(p).outcome("h").origin == "f"


def test_a_list_port_drops_skipped_items_and_skips_where_none_is_left() -> None:
    p = make(
        f"{GUARDED}\nh: {{step: total, in: [v, g, v]}}\nk: {{step: total, in: [g, g]}}", "h, k"
    )
    result = run(p)
    assert result["h"] == 6
    assert result.outcome("k").origin == "g"
    assert result.outcome("k").reason == "every item of 'items' was skipped"


def test_a_failed_item_fails_the_list() -> None:
    p = make(
        f"{V}\nf: {{step: picky, in: v, with: {{bad: 1}}}}\nh: {{step: total, in: [v, f]}}", "h"
    )
    assert isinstance(run(p).outcome("h"), Failed)


# -- failures ----------------------------------------------------------------------------------


def test_a_failure_tells_node_step_place_and_inputs_and_stops_only_its_dependants() -> None:
    nodes = f"""{V}
    f: {{step: picky, in: v, with: {{bad: 2}}}}
    after: {{step: add1, in: f}}
    other: {{step: add1, in: v}}"""
    result = run(make(nodes, "after, other"), 4)
    assert result["other"] == 5
    failed = result.outcome("after")
    assert (failed.origin, failed.kind) == ("f", "error")
    assert failed.step == "step picky of helpers_graphs"
    assert "helpers_graphs.py:" in failed.where
    assert failed.where.endswith(" in picky")
    assert (failed.inputs, failed.reason) == ("int", "ValueError: 4!")
    assert failed.error.__traceback__ is None
    assert len(result.failures) == 1
    told = r"'after' failed at 'f': ValueError: 4! \(at .*helpers_graphs.py:\d+ in picky\)"
    with pytest.raises(NoResult, match=told):
        result["after"]


def test_an_expected_numeric_failure_is_an_outcome_of_its_own_kind() -> None:
    p = make(f"{V}\nf: {{step: picky, in: v, with: {{bad: 3}}}}", "f")
    failed = run(p).outcome("f")
    assert (failed.kind, failed.reason) == ("degenerate", "3 is a multiple of 3")
    assert isinstance(failed.error, Degenerate)


def test_a_step_that_returns_none_though_it_promises_a_value_fails() -> None:
    outcome = run(make("x: {step: nothing, in: frame}", "x")).outcome("x")
    assert outcome.reason == "TypeError: the step returned None though it promises a value"


def test_a_failed_field_is_reported_once_however_many_read_it() -> None:
    class Bad(NamedTuple):
        n: int

        @property
        def field(self) -> int:
            raise ValueError("broken")

    def bad(image: Image) -> Bad:
        return Bad(1)

    text = """
    pipeline: p
    nodes:
      b: {step: bad, in: frame}
      x: {step: add1, in: b.field, when: b.n == 1}
      y: {step: add1, in: b.field, when: b.n == 1}
    outputs: [x, y, b.field]
    """
    bad.__annotations__["return"] = Bad
    result = loads(text, "p", registry({**MORE, "bad": bad})).run(frame(1))
    assert [f.origin for f in result.failures] == ["b.field"]


def test_explain_tells_every_nodes_story() -> None:
    nodes = f"""{GUARDED}
    f: {{step: picky, in: v, with: {{bad: 1}}}}
    after: {{step: add1, in: f}}
    unasked: {{step: add1, in: v}}"""
    result = run(make(nodes, "g, after"))
    story = {e.node: (e.state, e.reason) for e in result.explain()}
    assert story == {
        "v": ("ran", ""),
        "costly": ("skipped", "nothing asked for it"),
        "g": ("skipped", "when v > 3 is false (v = 3)"),
        "f": ("failed", "3 is a multiple of 1"),
        "after": ("failed", "f failed"),
        "unasked": ("skipped", "nothing asked for it"),
    }


# -- each --------------------------------------------------------------------------------------


def test_each_runs_a_step_over_the_items_of_a_list() -> None:
    p = make(f"{V}\nm: {{step: many, in: v}}\ne: {{step: add2, in: [m, v], each: true}}", "e")
    assert run(p)["e"] == (9, 10, 11)


@pytest.mark.parametrize("odd", [float("nan"), [1.0, float("inf")], np.array([np.nan, 1.0])])
def test_a_frame_whose_output_is_not_finite_is_not_ok(odd: Any) -> None:
    def given(image: Image) -> Any:
        return odd if image.values.any() else 1.0

    text = "pipeline: p\nnodes: {n: {step: given, in: frame}}\noutputs: [n]"
    pipeline = loads(text, steps={"given": given})
    assert not pipeline.run(np.ones((2, 2))).ok
    assert pipeline.run(np.zeros((2, 2))).ok


def test_an_item_that_fails_keeps_its_place_and_is_named() -> None:
    p = make(
        f"{V}\nm: {{step: many, in: v}}\ne: {{step: picky, in: m, each: true, with: {{bad: 2}}}}",
        "e",
    )
    result = run(p)
    first, failed, last = result["e"]
    assert (first, last) == (3, 5)
    assert (failed.origin, failed.item, failed.reason) == ("e", (1,), "ValueError: 4!")
    assert [(f.item, f.reason) for f in result.failures] == [((1,), "ValueError: 4!")]
    assert result.gaps == {"e": [failed]}
    assert not result.ok
    assert run(p, 1).failures == []


LISTS = (
    f"{V}\nm: {{step: many, in: v}}\ns: {{step: at_least, in: m, each: true, with: {{least: 4}}}}"
)
FAILING = f"{V}\nm: {{step: many, in: v}}\ns: {{step: picky, in: m, each: true, with: {{bad: 2}}}}"


def test_a_step_that_skips_is_no_failure_and_skips_what_depends_on_it() -> None:
    p = make(
        f"{V}\ns: {{step: at_least, in: v, with: {{least: 4}}}}\nw: {{step: add1, in: s}}", "w"
    )
    result = run(p)
    assert (result.outcome("w").origin, result.outcome("w").reason) == ("s", "3 is too small")
    assert result.failures == []
    assert run(p, 4)["w"] == 5


def test_a_node_over_a_list_hands_on_the_outcome_in_an_empty_place() -> None:
    p = make(f"{LISTS}\ne: {{step: add2, in: [s, m], each: true}}", "e")
    skipped, *rest = run(p)["e"]
    assert (skipped.origin, skipped.item, skipped.reason) == ("s", (0,), "3 is too small")
    assert rest == [12, 15]


def test_a_step_whose_port_says_its_items_may_be_none_is_told_of_empty_places() -> None:
    assert run(make(f"{LISTS}\nt: {{step: told, in: s}}", "t"))["t"] == "- 4 5"
    assert run(make(f"{FAILING}\nt: {{step: told, in: s}}", "t"))["t"] == "3 - 5"


def test_other_steps_get_a_list_without_skipped_items_and_fail_with_a_failed_one() -> None:
    assert run(make(f"{LISTS}\nt: {{step: total, in: s}}", "t"))["t"] == 9
    failed = run(make(f"{FAILING}\nt: {{step: total, in: s}}", "t")).outcome("t")
    assert (failed.origin, failed.item) == ("s", (1,))


def test_a_step_of_two_lists_is_skipped_rather_than_given_lists_out_of_step() -> None:
    skipped = run(make(f"{LISTS}\nz: {{step: zipped, in: [s, m]}}", "z")).outcome("z")
    assert (skipped.origin, skipped.reason) == ("z", "item 1 of s was skipped: 3 is too small")


def test_each_over_no_items_skips_and_over_failures_only_fails() -> None:
    p = make(
        f"{V}\nm: {{step: many, in: v}}\ne: {{step: picky, in: m, each: true, with: {{bad: 1}}}}",
        "e",
    )
    assert run(p, 4).outcome("e").reason == "no items to run for"
    assert isinstance(run(p, 3).outcome("e"), Failed)


def test_each_item_takes_the_default_of_an_optional_port_whose_list_was_skipped() -> None:
    nodes = f"{V}\nm: {{step: many, in: v}}\nl: {{step: many, in: v, when: v > 4}}"
    p = make(f"{nodes}\ne: {{step: optional, in: [m, l], each: true}}", "e")
    assert run(p, 3)["e"] == (3 - 7, 4 - 7, 5 - 7)
    assert run(p, 7)["e"] == (0, 0, 0)
    p = make(f"{nodes}\ne: {{step: options, in: {{b: l, a: m}}, each: true}}", "e")
    assert run(p, 3)["e"] == (32, 42, 52)


def test_each_is_skipped_where_no_list_is_left_to_run_over() -> None:
    nodes = f"{V}\nl: {{step: many, in: v, when: v > 4}}"
    for wires in ("optional, in: [v, l]", "options, in: [l, l]"):
        p = make(f"{nodes}\ne: {{step: {wires}, each: true}}", "e")
        outcome = run(p, 3).outcome("e")
        assert (outcome.origin, outcome.reason) == ("l", "when v > 4 is false (v = 3)")
        assert len(run(p, 7)["e"]) == 3


def test_lists_of_different_length_at_one_node_fail() -> None:
    nodes = f"{V}\nw: {{step: add1, in: v}}\nm: {{step: many, in: v}}\nk: {{step: many, in: w}}"
    p = make(f"{nodes}\ne: {{step: add2, in: [m, k], each: true}}", "e")
    assert "lists of different length at one node" in run(p, 1).outcome("e").reason


# -- pipelines in pipelines --------------------------------------------------------------------

INNER = """
pipeline: inner
nodes:
  r: {step: read, in: frame, with: {tag: r}}
  s: {step: add1, in: r, when: r > 3, with: {tag: s}}
  t: {step: picky, in: r, with: {bad: 5, tag: t}}
outputs: [%s]
"""


def using(tmp_path: Any, nodes: str, outputs: str, inner_outputs: str = "s, t") -> Any:
    path = tmp_path / "inner.yaml"
    path.write_text(INNER % inner_outputs)
    body = "\n".join(f"  {line.strip()}" for line in nodes.strip().splitlines())
    text = f"pipeline: p\nnodes:\n{body}\noutputs: [{outputs}]\n"
    return loads(text, "p.yaml", registry(MORE, {"inner": path}))


def test_a_used_pipeline_is_skipped_node_by_node(tmp_path: Any) -> None:
    p = using(tmp_path, "u: {use: inner}", "u.s, u.t")
    result = run(p)
    assert result["u.t"] == 3
    assert result.outcome("u.s").origin == "u/s"
    assert sorted(CALLS) == ["r", "t"]


def test_only_what_is_asked_of_a_used_pipeline_runs(tmp_path: Any) -> None:
    assert run(using(tmp_path, "u: {use: inner}", "u.s"), 4)["u.s"] == 5
    assert CALLS == ["r", "s"]


def test_a_guard_on_a_used_pipeline_keeps_all_of_it_from_running(tmp_path: Any) -> None:
    p = using(tmp_path, "u: {use: inner, when: frame.index > 0}", "u", "s")
    assert run(p, 4).outcome("u").origin == "u"
    assert CALLS == []


def test_a_used_pipelines_settings_are_named_node_dot_setting(tmp_path: Any) -> None:
    p = using(tmp_path, "u: {use: inner, with: {s.k: 10}}", "u.s")
    assert run(p, 4)["u.s"] == 14
    assert run(p.with_settings({"u/s.k": 20}), 4)["u.s"] == 24


def test_nodes_inside_can_be_asked_for(tmp_path: Any) -> None:
    assert run(using(tmp_path, "u: {use: inner}", "u.s"), only=["u/r"])["u/r"] == 3


def test_each_runs_a_pipeline_over_a_list_and_keeps_the_results_of_its_items(tmp_path: Any) -> None:
    p = using(tmp_path, "i: {step: images, in: frame}\nu: {use: inner, in: i, each: true}", "u")
    result = run(p)
    skipped, *rest = result["u"].s
    assert (rest, skipped.origin, skipped.item) == ([5, 6], "u/s", (0,))
    *rest, failed = result["u"].t
    assert (rest, failed.origin, failed.item) == ([3, 4], "u/t", (2,))
    assert [r.frame.image.peak for r in result.inner["u"]] == [3, 4, 5]
    assert [(f.origin, f.item) for f in result.failures] == [("u/t", (2,))]
    assert run(p, 0).outcome("u").reason == "no items to run for"


# -- conditions over items -----------------------------------------------------------------------


PEAKS = """i: {step: images, in: frame}
    p: {step: read, in: i, each: true}
    q: {step: at_least, in: p, each: true, with: {least: 4}}
"""


@pytest.mark.parametrize(
    ("when", "holds"),
    [
        ("any(q > 4)", True),
        ("all(q > 3)", True),  # the first item is left out: it was skipped
        ("all(q > 4)", False),
        ("count(q >= 4) == 2", True),
        ("count(p >= 3) == 3 and any(i.peak > 4)", True),
        ("count(i.peak > 3 and i.total > 18) > 1", False),
    ],
)
def test_a_guard_over_items_leaves_out_those_without_a_value(when: str, holds: bool) -> None:
    p = make(f"{PEAKS}g: {{step: add1, in: frame.index, when: {when}}}", "g")
    outcome = run(p).outcome("g")
    assert (outcome == 1) == holds, outcome
    if not holds:
        assert outcome.reason.startswith(f"when {when} is false (")


def test_a_guard_over_no_items_and_over_a_list_that_was_skipped() -> None:
    p = make(f"{PEAKS}g: {{step: add1, in: frame.index, when: any(i.peak > 4)}}", "g")
    assert run(p, 0).outcome("g").reason == "when any(i.peak > 4) is false (i.peak = 0 items)"
    p = make(f"{PEAKS}g: {{step: add1, in: frame.index, when: all(q > 4)}}", "g")
    outcome = run(p, 0).outcome("g")
    assert (outcome.origin, outcome.reason) == ("p", "no items to run for")


def test_a_failed_item_fails_a_guard_over_items(tmp_path: Any) -> None:
    nodes = """i: {step: images, in: frame}
    u: {use: inner, in: i, each: true}
    g: {step: add1, in: frame.index, when: any(u.t > 0)}
    h: {step: add1, in: frame.index, when: count(u.s > 5) == 1}"""
    result = run(using(tmp_path, nodes, "g, h"))
    assert (result.outcome("g").origin, result.outcome("g").item) == ("u/t", (2,))
    assert result["h"] == 1


# -- done once, reused, frozen -----------------------------------------------------------------


def test_work_that_depends_on_no_frame_is_done_once() -> None:
    nodes = """c: {step: constant, with: {tag: c, value: 4}}
    d: {step: add1, in: c, with: {tag: d}}
    v: {step: read, in: frame, with: {tag: v}}
    e: {step: add2, in: [v, d], with: {tag: e}}"""
    runner = make(nodes, "e").runner()
    CALLS.clear()
    assert [runner(frame(n))["e"] for n in (1, 2, 3)] == [11, 12, 13]
    assert CALLS == ["c", "d", "v", "e", "v", "e", "v", "e"]
    assert runner(frame(9)).times_us["d"] == 0.0


def test_a_constant_behind_a_guard_is_only_made_when_it_is_needed() -> None:
    nodes = (
        f"{V}\nc: {{step: constant, with: {{tag: c}}}}\ne: {{step: add2, in: [v, c], when: v > 3,"
    )
    runner = make(f"{nodes} with: {{tag: e}}}}", "e").runner()
    CALLS.clear()
    for n in (1, 4, 2, 5):
        runner(frame(n))
    assert CALLS == ["v", "v", "c", "e", "v", "v", "e"]


def test_a_step_that_draws_numbers_is_no_constant() -> None:
    runner = make("d: {step: dice}", "d").runner()
    assert len({runner(frame(1, i))["d"] for i in range(5)}) == 5


def test_an_equal_frame_reuses_the_result() -> None:
    runner = make(V, "v").runner()
    CALLS.clear()
    first, second = runner(frame(3, 0)), runner(frame(3, 1, time_s=7.0))
    assert (first.reused, second.reused) == (False, True)
    assert second["v"] == 3
    assert second.frame.index == 1
    assert second.times_us == {"v": 0.0}
    assert [e.state for e in second.explain()] == ["reused"]
    assert CALLS == ["v"]


@pytest.mark.parametrize(
    "other",
    [
        Frame.of(np.full((2, 2), 3.0), 1.1),
        Frame.of(np.full((2, 2), 3.0), 1.0, origin_cm=(1.0, 0.0)),
        Frame.of(np.full((2, 2), 3.0), 1.0, quantity="volt"),
        Frame.of(np.array([[3.0, 3.0], [3.0, 2.0]]), 1.0),
        Frame(Image(np.full((2, 2), 3.0), valid=np.array([[True, True], [True, False]]))),
        Frame(Image(np.full((1, 4), 3.0))),
        Frame(Image(np.full((2, 2), 3.0).view(np.int64))),
    ],
    ids=["pitch", "origin", "quantity", "value", "valid", "shape", "dtype"],
)
def test_a_frame_that_differs_in_anything_is_run_anew(other: Frame) -> None:
    runner = make(V, "v").runner()
    runner(frame(3))
    assert not runner(other).reused
    assert not runner(frame(3)).reused


@pytest.mark.parametrize(
    "node",
    [
        "x: {step: read_frame, in: frame}",
        "x: {step: add1, in: frame.index}",
        "x: {step: count, in: v}",
        "x: {step: noise, in: frame}",
        "x: {step: add1, in: v, when: frame.index >= 0}",
    ],
)
def test_nothing_is_reused_where_more_than_the_image_counts(node: str) -> None:
    runner = make(f"{V}\n{node}", "x").runner()
    runner(frame(3, 0))
    assert not runner(frame(3, 1)).reused


def test_a_frame_that_was_interrupted_is_not_taken_for_done() -> None:
    def stop(image: Image) -> int:
        if image.values[0, 0] == 2 and not stopped:
            stopped.append(True)
            raise KeyboardInterrupt
        return int(image.values[0, 0])

    stopped: list[bool] = []
    runner = loads(
        "{pipeline: p, nodes: {x: {step: stop, in: frame}}, outputs: [x]}",
        "p",
        registry({"stop": stop}),
    ).runner()
    assert runner(frame(1))["x"] == 1
    with pytest.raises(KeyboardInterrupt):
        runner(frame(2))
    assert runner(frame(2))["x"] == 2


def test_what_steps_return_is_frozen() -> None:
    result = run(make("a: {step: arrays, in: frame}\ni: {step: images, in: frame}", "a, i"))
    for array in (result["a"].one, result["a"].more[0], result["i"][0].values):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    assert isinstance(result["a"].more, tuple)
    with pytest.raises(ValueError, match="read-only"):
        result.frame.image.values[0, 0] = 1


def test_an_array_made_by_a_property_is_frozen_too() -> None:
    result = run(make("i: {step: images, in: frame}", "i"), only=["frame.image.x_cm"])
    with pytest.raises(ValueError, match="read-only"):
        result["frame.image.x_cm"][0] = 1


# -- state, time, randomness -------------------------------------------------------------------


def test_a_stateful_step_that_is_skipped_keeps_its_state_and_learns_the_true_gap() -> None:
    runner = make(f"{V}\ns: {{step: since, in: frame, when: v > 3}}", "s").runner()
    out = [
        runner(frame(n, i, t)).get("s")
        for i, (n, t) in enumerate([(4, 1.0), (3, 1.5), (3, 4.0), (5, 4.5)])
    ]
    assert out == [(1, -1.0), None, None, (2, 3.5)]


def test_a_frame_without_time_takes_its_share_of_the_gap_over_it() -> None:
    runner = make("s: {step: since, in: frame}", "s").runner()
    out = [runner(frame(1, i, t))["s"][1] for i, t in enumerate([0.0, None, 1.0, 1.5])]
    assert out == [-1.0, -1.0, 0.5, 0.5]


def test_each_runner_starts_with_a_state_of_its_own() -> None:
    p = make("s: {step: since, in: frame}", "s")
    assert [r["s"][0] for r in p.stream([frame(1), frame(2)])] == [1, 2]
    assert [r["s"][0] for r in p.stream([frame(1), frame(2)])] == [1, 2]
    assert [p.run(frame(n))["s"][0] for n in (1, 2)] == [1, 1]


def test_a_stateless_class_is_made_once_however_often_it_runs() -> None:
    Table.made = 0
    p = make("t: {step: table, in: frame, with: {n: 5}}", "t")
    assert [p.run(frame(n))["t"] for n in range(3)] == [4, 4, 4]
    assert Table.made == 1


def test_the_same_seed_gives_the_same_bits_whatever_else_is_asked_for() -> None:
    p = make(
        f"{V}\na: {{step: noise, in: frame}}\nb: {{step: noise, in: frame, with: {{tag: x}}}}",
        "a, b",
    )
    both = [r["a"] for r in p.stream([frame(1, i) for i in range(4)], seed=5)]
    alone = [r["a"] for r in p.stream([frame(1, i) for i in range(4)], only=["a"], seed=5)]
    late = p.run(frame(1, 3), seed=5)["a"]
    assert both == alone
    assert late == both[3]
    assert len(set(both)) == 4


def test_another_seed_or_other_settings_give_other_numbers() -> None:
    p = make("a: {step: noise, in: frame}\nb: {step: noise, in: frame, with: {tag: x}}", "a, b")
    one, two = p.run(frame(1), seed=1), p.run(frame(1), seed=2)
    assert len({one["a"], one["b"], two["a"], two["b"]}) == 4


def test_each_item_draws_numbers_of_its_own() -> None:
    p = make(f"{V}\nm: {{step: many, in: v}}\nt: {{step: throw, in: m, each: true}}", "t")
    assert len(set(run(p)["t"])) == 3
    assert run(p)["t"] == run(p)["t"]


def test_a_class_can_take_its_generator_once() -> None:
    p = make("w: {step: walk, in: frame}", "w")
    walks = [[r["w"] for r in p.stream([frame(n) for n in range(3)], seed=s)] for s in (1, 1, 2)]
    assert walks[0] == walks[1] != walks[2]
    assert sorted(walks[0]) == walks[0]


def test_threads_do_not_disturb_each_other() -> None:
    from concurrent.futures import ThreadPoolExecutor

    p = make(f"{V}\nn: {{step: noise, in: frame}}", "v, n")
    frames = [frame(i % 3, i) for i in range(200)]
    expected = [(r["v"], r["n"]) for r in map(p.run, frames)]
    with ThreadPoolExecutor(4) as pool:
        assert [(r["v"], r["n"]) for r in pool.map(p.run, frames)] == expected


def test_every_node_that_ran_has_a_time() -> None:
    result = run(make(CHOICE, "best"))
    times = result.times_us
    assert times["v"] > 0
    assert times["dear"] > 0
    assert times["cheap"] == 0.0


# -- long graphs -------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_chain_of_2000_nodes_runs() -> None:
    nodes = "\n".join(f"n{i}: {{step: add1, in: n{i - 1}}}" for i in range(1, 2000))
    assert run(make(f"n0: {V[3:]}\n{nodes}", "n1999"))["n1999"] == 3 + 1999


def calls_to_plan_choices(length: int) -> int:
    """Return how many functions are called in the first run of a chain of choices."""
    lines = (f"n{i}: {{first_of: [n{i - 1}, n{max(0, i - 2)}]}}" for i in range(1, length))
    p = make("\n".join((f"n0: {V[3:]}", *lines)), f"n{length - 1}")
    calls = 0

    def count(frame: object, event: str, what: object) -> None:
        nonlocal calls
        calls += event in {"call", "c_call"}

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        result = run(p, 3)
    finally:
        sys.setprofile(before)
    assert result[f"n{length - 1}"] == 3
    return calls


@pytest.mark.slow
def test_a_long_chain_of_choices_is_planned_once_for_each() -> None:
    """All that each reads stands before it; looked up anew for each, twice as many cost 4 times."""
    calls_to_plan_choices(100)  # what is imported or kept at the first use
    assert calls_to_plan_choices(1900) < 2.5 * calls_to_plan_choices(950)


@pytest.mark.slow
def test_400_guarded_nodes_in_a_chain_run_and_skip() -> None:
    nodes = "\n".join(
        f"n{i}: {{step: add1, in: n{i - 1}, when: v > 3, with: {{tag: n}}}}" for i in range(1, 401)
    )
    p = make(f"{V}\nn0: {{step: add1, in: v}}\n{nodes}", "n400")
    assert run(p, 4)["n400"] == 405
    assert run(p, 3).outcome("n400").origin == "n400"
    assert CALLS == ["v"]


# -- provenance --------------------------------------------------------------------------------


def test_a_resolved_pipeline_spells_everything_out() -> None:
    p = make(CHOICE, "best").with_settings({"dear.k": 7})
    assert p.resolved() == {
        "pipeline": "p",
        "source": None,
        "nodes": {
            "v": {"step": "read", "in": {"image": "frame.image"}, "with": {"tag": "v"}},
            "cheap": {
                "step": "add1",
                "in": {"a": "v"},
                "with": {"k": 1, "tag": "cheap"},
                "when": "v > 3",
            },
            "dear": {"step": "add1", "in": {"a": "v"}, "with": {"k": 7, "tag": "dear"}},
            "best": {"first_of": ["cheap", "dear"]},
        },
        "outputs": {"best": "best"},
    }


def test_equal_nodes_have_equal_keys() -> None:
    p = make(
        f"{V}\na: {{step: add1, in: v}}\nb: {{step: add1, in: v, with: {{k: 1}}}}\n"
        "c: {step: add1, in: v, with: {k: 2}}",
        "a, b, c",
    )
    keys = {n: node.key for n, node in p.nodes.items()}
    assert keys["a"] == keys["b"] != keys["c"]


def test_a_bare_array_is_taken_for_a_frame() -> None:
    assert make(V, "v").run(np.full((2, 2), 6))["v"] == 6


def test_the_modules_of_steps_are_named_in_failures_even_for_classes() -> None:
    class Broken:
        def __call__(self, image: Image) -> int:
            raise RuntimeError("no")

    p = loads(
        "{pipeline: p, nodes: {x: {step: broken, in: frame}}, outputs: [x]}",
        "p",
        registry({"broken": Broken}),
    )
    failed = p.run(frame(1)).outcome("x")
    assert failed.step == f"step broken of {Broken.__module__}"
    assert isinstance(failed.error, RuntimeError)


def highest(image: Image) -> float:
    return image.peak


def as_it_is(image: Image) -> Image:
    return image


def test_a_field_of_an_image_that_its_source_fills_anew_is_looked_at_anew() -> None:
    buffer = np.zeros((2, 2))
    refilled = Frame(Image(buffer.view()))
    pipeline = loads(
        "pipeline: p\nnodes:\n  same: {step: as_it_is, in: frame}\n"
        "  seen: {step: highest, in: same, when: same.peak > 0}\noutputs: [seen]\n",
        registry=registry({"highest": highest, "as_it_is": as_it_is}),
    )
    runner = pipeline.runner()
    assert isinstance(runner(refilled).outcome("seen"), Skipped)
    buffer[0, 0] = 1.0
    assert runner(refilled)["seen"] == 1.0
