"""Conditions give what Python would, read only what they name, and say what they read."""

from __future__ import annotations

import ast
import pickle
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tactile_graph import Frame, Image, loads
from tactile_graph.errors import PipelineError
from tactile_graph.pipeline.conditions.conditions import compile_condition, names_in
from tactile_graph.pipeline.references import ConditionError
from tactile_graph.pipeline.wiring import Ref


class Item(NamedTuple):
    size: float
    peak: float | None
    kind: str
    parts: list[int]


class Found(NamedTuple):
    count: int
    names: list[str]
    any: Any


Kind = Literal["disc", "rectangle"]
Unit = Annotated[str, Literal["volt", "gram"]]
TYPES = {
    "kind": Kind,
    "unit": Unit,
    "flag": bool,
    "a": int,
    "b": float,
    "found": Found,
    "text": str,
    "frame": int,
    "items": list[Item],
    "flags": list[bool],
    "u.s": list[Item | None],
}
VALUES = {"a": 3, "b": 0.5, "found.count": 2, "found.names": ("x", "y"), "text": "on"}


def holds(text: str, named: dict[str, str] | None = None) -> bool:
    guard = compile_condition(text, TYPES, named)
    return bool(guard.function(*[VALUES[str(r)] for r in guard.refs]))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a - b > 10", False),
        ("a + b < 100", False),
        ("a * 2 < b", True),
        ("-a > 0", False),
        ("abs(a) > 0", True),
        ("max(a, b) + 100 > 300", True),
        ("count(flags) - a > 0", False),
        ("any(items.size - a > 10)", False),
        ("a < b", True),
    ],
)
def test_small_numbers_of_numpy_are_reckoned_with_as_pythons_are(text: str, expected: bool) -> None:
    guard = compile_condition(text, TYPES)
    low, high = np.uint8(120), np.uint8(250)
    values = {"a": low, "b": high, "flags": (True,), "items": (np.uint8(7),)}
    assert bool(guard.function(*[values[str(r)] for r in guard.refs])) is expected
    least = compile_condition("abs(a) > 0", TYPES)
    assert least.function(np.int8(-128))


def test_a_guard_that_the_program_itself_holds_reckons_so_too() -> None:
    def peak(image: Image) -> float:
        return image.values.max()  # type: ignore[no-any-return]

    nodes = "{a: {step: peak, in: frame}, b: {step: peak, in: frame, when: -a > 0}}"
    pipeline = loads(f"{{pipeline: p, nodes: {nodes}, outputs: [b]}}", steps={"peak": peak})
    runner = pipeline.runner()
    runner.prepare()
    frame = Frame(Image(np.full((2, 2), 120, np.uint8)), 0)
    assert [runner(frame).explain()[-1].state for _ in range(3)] == ["skipped"] * 3


def test_parts_of_numbers_are_divided_by_0_as_before() -> None:
    with np.errstate(all="ignore"):
        assert compile_condition("b / 0.0 > 1", TYPES).function(np.float64(1.0))
        for kind in (np.int64, np.uint64, np.uint8):
            zero = kind(0)  # type: ignore[operator]
            assert compile_condition("b / a > 1", TYPES).function(np.uint16(2), zero)
            assert not compile_condition("a / b > 1", TYPES).function(zero, zero)


def test_large_numbers_of_numpy_are_reckoned_with_as_they_are() -> None:
    assert compile_condition("a - 1 > 0", TYPES).function(np.uint64(2**64 - 1))
    single = np.float32(0.1)
    for text in ("a > 0.1", "abs(a) > 0.1", "a * 1 > 0.1"):
        assert not compile_condition(text, TYPES).function(single), text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a > 2 and b < 1", True),
        ("not a", False),
        ("a in (1, 2, 3)", True),
        ("a not in [3]", False),
        ("text == 'on' or text == 'off'", True),
        ("1 < a <= 3", True),
        ("a // 2 + a % 2 - -1 == 3", True),
        ("max(a, b) / min(a, 2) >= 1.5", True),
        ("len(found.names) == found.count", True),
        ("abs(b - a) > 2.4", True),
        ("found.names", True),
        (" a\n  > 2 ", True),
        ('a > 2  # so\nand b > 1  # "not"\n', False),
        ("text == 'on#' or text == \"#\" or a > 3#", False),
    ],
)
def test_a_condition_gives_what_python_would(text: str, expected: bool) -> None:
    assert holds(text) is expected


@pytest.mark.parametrize(
    "text",
    ["kind == 'disk'", "'disk' != kind", "kind in ('disk',)", "kind not in ['disk']"],
)
def test_a_text_that_a_field_never_holds_is_refused(text: str) -> None:
    words = "kind is never 'disk'; it is one of 'disc', 'rectangle'; did you mean 'disc'"
    with pytest.raises(ConditionError, match=words):
        compile_condition(text, TYPES)
    assert compile_condition(text.replace("disk", "disc"), TYPES).refs == (Ref("kind"),)


def test_a_text_is_not_compared_with_a_number() -> None:
    with pytest.raises(ConditionError, match="kind is a text and 1 is a number"):
        compile_condition("kind == 1", TYPES)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1 > 2", "1 > 2 reads no node: it is always false"),
        ("max(1, 2) > 1", r"max\(1, 2\) > 1 reads no node: it is always true"),
        ("1 / 0 > 2", r"1 / 0 > 2 reads no node: it cannot be told \(division by zero\)"),
        ("10 < 5 < a", "10 < 5 reads no node: it is always false"),
        ("3 + 4", r"3 \+ 4 reads no node: it is always true"),
        ("len('abc')", r"len\('abc'\) reads no node: it is always true"),
        ("'yes'", "'yes' reads no node: it is always true; what is it to be compared with"),
        ("a > 0 or 1", "1 reads no node: it is always true; what is it to be compared with"),
        ("kind == 'disc' or 'rectangle'", "'rectangle' reads no node: it is always true"),
        ("not 0", "0 reads no node: it is always false"),
        ("b > 0,5", "this is a list, which is always true: .*the decimals of a number behind a po"),
        ("(a > 2, b) and a", "this is a list, which is always true"),
        ("a in 3", r"'in' looks into a list, and 3 is a number; a list is written \(3,\)"),
        ("a in (3)", r"'in' looks into a list, and 3 is a number"),
        ("len(found.count) > 1", r"len\(\) counts the items of a list, and found.count is"),
        ("abs(text) > 1", r"abs\(\) takes a number, and text is a text"),
        ("max(b) > 1", r"max\(\) takes several numbers, or a list of them, and b is one number"),
        ("class.count > 1", "'class' is a word of Python: a condition can read nothing of that"),
        ("text in ('on')", r"'in' looks into a list, and 'on' is a text; .* written \('on',\)"),
        ("text in a", r" looks into a list, and a is a number"),
        ("a in ()", "nothing is in an empty list: this is always false"),
        ("a not in []", "nothing is in an empty list: this is always true"),
        ("len(found.names) < 0", r"len\(\) is never negative: this is always false"),
        ("abs(b) >= 0", r"abs\(\) is never negative: this is always true"),
        ("abs(b) == -1", r"abs\(\) is never negative: this is always false"),
        ("found.count == found.count", "found.count is compared with itself: that is always true"),
        ("a < a", "a is compared with itself: that is always false"),
        ("flag == 3", "flag is never 3; it is one of True, False"),
        ("unit == 'volts'", "unit is never 'volts'; it is one of 'volt', 'gram'; did you mean 'vo"),
    ],
)
def test_what_comes_out_the_same_in_every_frame_is_refused(text: str, words: str) -> None:
    with pytest.raises(ConditionError, match=words):
        compile_condition(text, TYPES)


@pytest.mark.parametrize(
    "text",
    ["True", "1", "a > 0 and True", "len(found.names) > 0", "len(found.names) <= 0", "abs(b) > 0",
     "abs(b) == 0", "flag == True", "flag == 1", "unit == 'volt'", "text in ('on', 'off')",
     "'n' in text", "found.any in found.any", "a == b"],
)  # fmt: skip
def test_what_frames_may_decide_and_plain_switches_are_let_through(text: str) -> None:
    assert compile_condition(text, TYPES).text == text


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a > 0 && b", "write 'and' for '&&'"),
        ("a > 0 || b", r"write 'or' for '\|\|'"),
        ("a = 3", "to compare, write '=='$"),
        ("a => 3", "write '>=' for '=>'$"),
        ("a =< 3", "write '<=' for '=<'$"),
        ("a <> 3", "write '!=' for '<>'$"),
        ("!a", "write 'not' for '!'"),
        ("a > 0 AND b", "'and', 'or' and 'not' are written small"),
        ("NOT a", "'and', 'or' and 'not' are written small"),
        ("a is 3", "write '==' for 'is'"),
        ("b > 0.5V", "a number stands alone, without a unit"),
        ("a == true", "true is written True in a condition"),
        ("A > 3", "no node named 'A'; did you mean 'a'"),
        ("found.COUNT > 3", "has no field 'COUNT'; did you mean 'count'"),
    ],
)
def test_signs_of_other_languages_are_told(text: str, words: str) -> None:
    with pytest.raises(ConditionError, match=words):
        compile_condition(text, TYPES)


@pytest.mark.parametrize(
    ("quantity", "words"),
    [
        ("volt", "node 'b', 'when': a.force_n is there for images in gram or kilopascal, here they "
                 "are in volt: it never runs"),
        ("gram", ""),
    ],
)  # fmt: skip
def test_a_condition_over_a_field_that_images_in_volts_lack_is_refused(
    quantity: str, words: str
) -> None:
    siemens = "  s: {step: decouple, in: frame}\n  g: {step: force, in: s}\n"
    image = "frame" if quantity == "volt" else "g"
    text = (
        f"pipeline: p\nsource: {{step: sample}}\nnodes:\n{siemens}"
        f"  a: {{step: load, in: {image}}}\n"
        "  b: {step: inpaint, in: frame, when: a.force_n > 3}\noutputs: [b]\n"
    )
    if not words:
        assert loads(text).nodes["b"].guard is not None
        return
    with pytest.raises(PipelineError, match=words):
        loads(text)


ITEMS = {
    "items.size": (1.0, 2.0, 3.0),
    "items.peak": (0.1, 0.9, 0.5),
    "items.kind": ("disc", "bar", "disc"),
    "flags": (True, False),
    "u.s.size": (),
}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("any(items.size > 2.5)", True),
        ("all(items.size > 2.5)", False),
        ("count(items.size > 1.5) == 2", True),
        ("count(items.size > 1.5 and items.peak > 0.6) >= 2", False),
        ("any(items.kind == 'disc' and items.peak > 0.6)", False),
        ("any(items.size > a) or count(flags) == 1", True),
        ("not any(items.size > 9) and all(flags or a > 1)", True),
        ("any(u.s.size > 0)", False),
        ("all(u.s.size > 0)", True),
        ("count(u.s.size > 0) > 0", False),
        ("any(abs(items.size - 2) < b)", True),
        ("len(items) and any(items.size > 2.5)", True),
    ],
)
def test_any_all_and_count_are_over_the_items_of_a_list(text: str, expected: bool) -> None:
    guard = compile_condition(text, TYPES, {})
    values = {**VALUES, **ITEMS, "items": (1, 2, 3)}
    assert bool(guard.function(*[values[r.spelled] for r in guard.refs])) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("items.size > 2", "items is a list: fields of its items are read within any(), all() or"),
        (
            "any(items.sise > 2)",
            "an item of items (Item) has no field 'sise'; did you mean 'size'?",
        ),
        ("any(items.zzzzz > 2)", "has no field 'zzzzz'; it has: kind, parts, peak, size"),
        ("any(a > 2)", "any() is over the items of a list, and none is read in it"),
        ("any(items.size > 2, 3)", "any() takes one condition over items, like any(fits.radius"),
        ("any()", "any() takes one condition over items"),
        ("any(items.size > 1 and flags)", "any() is over the items of one list, got flags, items"),
        ("any(all(flags))", "all() cannot stand within another any(), all() or count()"),
        ("any(items.size > 1) > 2", "any() is a yes or no; count() is a number"),
        ("count(items.size > 1) >= 0", "count() is never negative: this is always true"),
        ("any(items.kind > 2)", "items.kind is a text and 2 is a number"),
        ("any(items)", "items is a Item, not a yes/no or a number"),
        ("count(items.parts > 1)", "items.parts is a list[int] and cannot be compared"),
        ("a in flags", "flags is a list[bool] and cannot be compared; write any(flags == a)"),
        ("'x' not in found.names", "cannot be compared; write not any(found.names == 'x')"),
        ("a in items", "items is a list[Item] and cannot be compared"),
        ("any(items.__class__)", "has no field '__class__'"),
        ("any([x for x in items])", "listcomp is not allowed in a condition"),
        ("any(1 > 2)", "1 > 2 reads no node"),
    ],
)
def test_what_is_wrong_over_items_is_told(text: str, words: str) -> None:
    with pytest.raises(ConditionError) as caught:
        compile_condition(text, TYPES, {})
    assert words in caught.value.message


def test_items_are_told_in_a_reason_once_for_each_field() -> None:
    guard = compile_condition("any(items.size > 9) or count(items.size > 8) > 1", TYPES)
    assert guard.reason(((1.0, 2.0), (1.0, 2.0))) == (
        "when any(items.size > 9) or count(items.size > 8) > 1 is false (items.size = [1, 2])"
    )
    assert "(items.size = [1, 1, 1, 1, … of 9])" in guard.reason(((1.0,) * 9, (1.0,) * 9))


def test_each_value_is_read_once_in_order() -> None:
    guard = compile_condition("found.count > a and a > b and found.count > 1", TYPES)
    assert guard.refs == (Ref("found", ("count",)), Ref("a"), Ref("b"))


@pytest.mark.parametrize(
    ("value", "shown"),
    [(3, "3"), (0.1234567891, "0.123457"), (np.int64(3), "3"), (np.bool_(False), "False"),
     (True, "True"), ("x", "'x'"), (("x", "y"), "2 items"), (object(), "a object")],
)  # fmt: skip
def test_a_reason_shows_what_was_read(value: Any, shown: str) -> None:
    guard = compile_condition("found.any == 9", TYPES)
    assert guard.reason((value,)) == f"when found.any == 9 is false (found.any = {shown})"


def test_names_are_those_of_nodes_not_of_functions() -> None:
    assert names_in("max(max, len(x.y)) > z") == {"max", "x", "z"}
    assert names_in("a >") == set()


COMMENTED = """
pipeline: commented
nodes:
  a:
    step: threshold
    in: frame
    with: {{level_v: 0.01}}
    when: {style}
      frame.index > 0           # began
      and frame.index > 5  # it's late
outputs: [a]
"""


def test_a_comment_in_a_condition_ends_with_its_line() -> None:
    pipeline = loads(COMMENTED.format(style="|"))
    frames = [Frame.of([[1.0]], quantity="volt").with_index(i) for i in (0, 1, 6)]
    assert [pipeline.run(f).ok for f in frames] == [False, False, True]
    guard = pipeline.nodes["a"].guard
    assert guard is not None
    assert guard.text == "frame.index > 0 and frame.index > 5"


@pytest.mark.parametrize("style", [">", ">-"])
def test_a_comment_whose_line_yaml_joins_to_the_next_is_refused(style: str) -> None:
    with pytest.raises(PipelineError, match=r"8:\d+: node 'a', 'when': a comment in it would swal"):
        loads(COMMENTED.format(style=style))


@pytest.mark.parametrize("style", [">", ">-", "|"])
def test_a_comment_behind_the_only_line_of_a_condition_swallows_nothing(style: str) -> None:
    text = COMMENTED.format(style=style).replace("           # began\n      and", " and")
    guard = loads(text).nodes["a"].guard
    assert guard is not None
    assert guard.text == "frame.index > 0 and frame.index > 5"


@pytest.mark.slow
@settings(max_examples=150, deadline=None, derandomize=True)
@given(text=st.text(st.sampled_from("ab.()[]<>=!+-*/%'\", 01notandri\n"), max_size=30))
def test_any_text_is_a_condition_or_told_to_be_none(text: str) -> None:
    from tactile_graph.pipeline.references import ConditionError

    try:
        guard = compile_condition(text, TYPES)
    except ConditionError as error:
        message = error.message
    else:
        message = guard.text
    assert isinstance(message, str)


@pytest.mark.parametrize("name", ["on", "off", "yes", "no", "Yes"])
def test_a_condition_may_be_named_what_yaml_reads_as_a_switch(name: str) -> None:
    text = f"""
pipeline: switches
conditions: {{{name}: frame.index > 0}}
nodes:
  a: {{step: threshold, in: frame, with: {{level_v: 0.01}}, when: {name}}}
outputs: [a]
"""
    pipeline = loads(text)
    frames = [Frame.of([[1.0]], quantity="volt").with_index(i) for i in (0, 1)]
    assert [pipeline.run(f).ok for f in frames] == [False, True]


@pytest.mark.parametrize(("when", "ran"), [("true", True), ("FALSE", False)])
def test_a_guard_may_be_a_plain_truth(when: str, ran: bool) -> None:
    text = f"""
pipeline: plain
nodes:
  a: {{step: threshold, in: frame, with: {{level_v: 0.01}}, when: {when}}}
outputs: [a]
"""
    assert loads(text).run(Frame.of([[1.0]], quantity="volt")).ok is ran


@pytest.mark.parametrize(
    "text",
    ["any(items.size > 2.5 and items.kind == 'disc') or a > 5", "count(flags) == 1", "b < 1"],
)
def test_a_guard_is_pickled_and_holds_as_before(text: str) -> None:
    guard = compile_condition(text, TYPES)
    again = pickle.loads(pickle.dumps(guard))
    assert (again.text, again.refs, again.groups) == (guard.text, guard.refs, guard.groups)
    for size, flag, a, b in ((3.0, True, 1, 0.5), (1.0, False, 1, 2.0), (1.0, True, 6, 0.5)):
        values = {"items.size": (size,), "items.kind": ("disc",), "flags": (flag,), "a": a, "b": b}
        given = [values[ref.spelled] for ref in guard.refs]
        assert again.function(*given) == guard.function(*given)


@contextmanager
def marked(node: ast.AST) -> Iterator[None]:
    """Hang what nobody can copy onto a node, as IPython's tracebacks do with whole files."""

    class Parent:
        def __reduce__(self) -> str:
            raise AssertionError("the trees of others were copied")

    vars(node)["parent"] = Parent()
    try:
        yield
    finally:
        del vars(node)["parent"]


def test_what_others_hang_onto_shared_nodes_of_trees_is_not_copied() -> None:
    with marked(ast.parse("a", mode="eval").body.ctx):  # type: ignore[attr-defined]
        guard = compile_condition("count(items.size > 2) == 1 and b < 1", TYPES)
        again = pickle.loads(pickle.dumps(guard))
    assert guard.function((3.0, 1.0), 0.5) is again.function((3.0, 1.0), 0.5) is True
