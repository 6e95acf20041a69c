"""Every mistake in a pipeline file is told in words, with its place; all of them in one run."""

from __future__ import annotations

import json
import os
import pickle
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import pytest
from annotated_types import Ge, Gt, Len, MultipleOf

from helpers_graphs import STEPS, Count, registry
from tactile_graph import Frame, Image, Mask, loads
from tactile_graph.api.pipeline import load
from tactile_graph.cli.watch import Stamp, files_read
from tactile_graph.errors import PipelineError, PluginError, UsageError
from tactile_graph.pipeline.load import evolves_in_circle
from tactile_graph.steps import Grid, Quantity


def threshold(
    image: Image,
    *,
    level_v: Annotated[float | None, Gt(0), Quantity("volt", of="image")] = None,
    kind: Literal["hard", "soft"] = "hard",
    cells: Annotated[int, MultipleOf(2)] = 2,
) -> Annotated[Mask, Grid.like("image")]:
    return image.mask(image.values > (level_v or 0))


def volts(image: Annotated[Image, Quantity("volt")]) -> Annotated[Image, Quantity.like("image")]:
    return image


def to_grams(image: Image) -> Annotated[Image, Quantity("gram"), Grid.like("image")]:
    return image


def finer(
    mask: Mask, *, factor: Annotated[int, Ge(1)] = 2
) -> Annotated[Mask, Grid.like("mask", finer_by="factor")]:
    return mask


def both(a: Mask, b: Annotated[Mask, Grid.like("a")]) -> Mask:
    return a


def sixteen(mask: Annotated[Mask, Grid(rows=15)]) -> Mask:
    return mask


def masks(image: Image) -> list[Mask]:
    return []


def needs(image: Image, *, gain: float, table: Annotated[list[int], Len(2)] = [1, 2]) -> Image:  # noqa: B006
    return image


def anything(values: Sequence[Any | None]) -> int:
    return len(values)


class Listed(NamedTuple):
    n: int
    values: list[int]


def listed(image: Image) -> Listed:
    return Listed(0, [])


def several(images: list[Image]) -> Image:
    return images[0]


def maybe(image: Image) -> Mask | None:
    return None


class Torn:
    def __init__(self) -> None:
        raise KeyError("x")

    def __call__(self, image: Image) -> int:
        return 1


class Refuses:
    def __init__(self, *, n: int = 1) -> None:
        if n == 7:
            raise ValueError("n must not be 7, got 7")
        if n == 8:
            raise ValueError("n is 8\nwhich is even")
        if n == 9:
            json.loads("[")

    def __call__(self, image: Image) -> int:
        return 1


def frames(*, n: Annotated[int, Ge(1)] = 1) -> Iterator[Annotated[Frame, Quantity("counts")]]:
    for i in range(n):
        yield Frame.of([[1.0]], quantity="counts", index=i)  # type: ignore[arg-type]


ALL: dict[str, Any] = {
    **STEPS, "refuses": Refuses, "frames": frames, "count": Count, "torn": Torn
} | {
    f.__name__: f
    for f in (
        threshold, volts, to_grams, finer, both, sixteen, masks, needs, several, maybe, anything,
        listed,
    )
}  # fmt: skip


@pytest.fixture
def reg(tmp_path: Path) -> Any:
    inner = tmp_path / "inner.yaml"
    inner.write_text(
        "{pipeline: inner, nodes: {m: {step: threshold, in: frame}, "
        "n: {step: volts, in: frame}}, outputs: [m, n]}"
    )
    state = tmp_path / "state.yaml"
    state.write_text("{pipeline: state, nodes: {c: {step: count, in: frame.index}}, outputs: [c]}")
    loop = tmp_path / "loop.yaml"
    loop.write_text("{pipeline: loop, nodes: {a: {use: pool}}, outputs: [a]}")
    pool = tmp_path / "pool.yaml"
    pool.write_text("{pipeline: pool, nodes: {a: {use: loop}}, outputs: [a]}")
    bad = tmp_path / "bad.yaml"
    bad.write_text("{pipeline: bad, nodes: {a: {step: thresold}}, outputs: [a]}")
    names = {p.stem: p for p in (inner, state, loop, pool, bad)}
    return registry(ALL, {**names, "gone": tmp_path / "gone.yaml"})


def text_of(nodes: str = "m: {step: threshold, in: frame}", rest: str = "outputs: [m]") -> str:
    lines = "\n".join(f"  {line.strip()}" for line in nodes.strip().splitlines())
    return f"pipeline: p\nnodes:\n{lines}\n{rest}\n"


M = "m: {step: threshold, in: frame}\n"
BAD_NODES = [
    # names, kinds and wires
    ("m: {step: thresold, in: frame}", "node 'm': no step named 'thresold'; did you mean 'thresh"),
    ("m: {step: qqq, in: frame}", "node 'm': no step named 'qqq'; there are: add1, add2"),
    ("m: {stp: threshold, in: frame}", "unknown key 'stp'; did you mean 'step'"),
    ("m: {stp: threshold, in: frame}", "exactly one of 'step', 'use', 'first_of' .*, got none"),
    (M + "n: {step: add1, first_of: [m]}", "is needed, got 'step' and 'first_of'"),
    (M + "n: {first_of: [m], in: m}", "'in' makes no sense beside 'first_of'"),
    (M + "n: {first_of: m}", "'first_of' must be a list of nodes, got a text: 'm'"),
    (M + "n: {first_of: [m, 3]}", "'first_of': a node or node.field is needed, got 3"),
    (M + "n: {first_of: [m, mm]}", "node 'n': no node named 'mm'; did you mean 'm'"),
    ("m: {step: }", "node 'm': 'step' is empty"),
    ("m: {use: ''}", "node 'm': 'use' is empty"),
    ("m: {step: [a], in: frame}", r"node 'm', 'step' must be a text, got a list: \['a'\]"),
    ("m: 3", "node 'm' must be a mapping, got 3"),
    (M + "2x: {step: threshold, in: frame}", "node name '2x': letters a to z, digits and '_' only"),
    (M + "frame: {step: threshold, in: frame}", "node name 'frame' is reserved"),
    (M + "m: {step: threshold, in: frame}", "'m' is given twice; the first is in line 3"),
    ("m: {step: threshold, in: 3}", "node 'm', 'in': a node or node.field is needed, got 3"),
    ("m: {step: threshold, in: {image: 3}}", "'in', image: a node or node.field is needed, got 3"),
    ("m: {step: threshold, in: {imge: frame}}", "has no port 'imge'; did you mean 'image'"),
    ("m: {step: threshold}", r"port 'image' of step 'threshold' is not wired \(Image\)"),
    ("m: {step: threshold, in: frm}", "node 'm': no node named 'frm'; did you mean 'frame'"),
    ("m: {step: threshold, in: frame.imag}", r"frame \(Frame\) has no field 'imag'; did you mean"),
    ("m: {step: threshold, in: frame._x}", "has no field '_x'"),
    ("m: {step: threshold, in: [frame, frame]}", "2 inputs for 1 port of 'threshold'"),
    ("m: {step: threshold, in: {image: [frame]}}", "takes one input, not a list"),
    ("m: {step: constant, in: frame}", "step 'constant' has no ports"),
    ("m: {step: add1, in: frame}", "'frame' is a Frame, but port 'a' of step 'add1' takes an int"),
    ("l: {step: masks, in: frame}\nm: {step: finer, in: l}", "add 'each: true' to run it for each"),
    ("l: {step: pair, in: frame.index}\nm: {step: add1, in: l}", r"takes an int; try l\.low"),
    (
        "a: {step: add1, in: b}\nb: {step: add1, in: c}\nc: {step: add1, in: a}\n" + M,
        "the nodes form a cycle: (a -> b -> c -> a|b -> c -> a -> b|c -> a -> b -> c)",
    ),
    ("a: {step: add1, in: frame.index, when: a > 1}\n" + M, "form a cycle: a -> a"),
    # each
    (M + "n: {step: finer, in: m, each: true}", "'each' needs a list on one of its ports"),
    ("m: {step: threshold, in: frame, each: 1}", "'each' must be true or false, got 1"),
    (
        "l: {step: many, in: frame.index}\nm: {step: count, in: l, each: true}",
        r"a stateful step \(count\) cannot run for each item",
    ),
    ("m: {use: inner, in: frame, each: true}", "'each' needs a list"),
    ("l: {step: masks, in: frame}\nm: {use: state, in: l, each: true}", "stateful node 'c' of 'st"),
    # settings
    ("m: {step: threshold, in: frame, with: {level_v: -1}}", "level_v: must be > 0(.0)?, got -1"),
    (
        "m: {step: threshold, in: frame, with: {level_v: a}}",
        "level_v: must be a number or null, got 'a",
    ),
    (
        "m: {step: threshold, in: frame, with: {level_v: true}}",
        "level_v: must be a number .*, got True",
    ),
    (
        "m: {step: threshold, in: frame, with: {level: 1}}",
        "level: unknown setting 'level'; did you m",
    ),
    (
        "m: {step: threshold, in: frame, with: {qq: 1}}",
        "'qq'; threshold takes: cells, kind, level_v",
    ),
    (
        "m: {step: threshold, in: frame, with: {kind: hrd}}",
        "kind: must be one of 'hard' | 'soft', got 'hrd'; did you mean 'hard'",
    ),
    ("m: {step: threshold, in: frame, with: {cells: 3}}", "cells: must be a multiple of 2, got 3"),
    (
        "m: {step: threshold, in: frame, with: {cells: 2.5}}",
        "cells: must be a whole number, got 2.5",
    ),
    ("m: {step: threshold, in: frame, with: 3}", "node 'm': 'with' must be a mapping, got 3"),
    ("m: {step: needs, in: frame}", r"setting 'gain' is missing \(a number\)"),
    ("m: {step: needs, in: frame, with: {gain: 1, table: [1, x]}}", "table: must be .*, got 'x'"),
    (
        "m: {step: needs, in: frame, with: {gain: 1, table: [1]}}",
        "table: list should have at least 2",
    ),
    ("m: {step: refuses, in: frame, with: {n: 7}}", "node 'm': n must not be 7, got 7"),
    ("m: {step: refuses, in: frame, with: {n: 8}}", "node 'm': n is 8 which is even"),
    (
        "m: {step: refuses, in: frame, with: {n: 9}}",
        r"node 'm': step 'refuses' cannot be made: JSONDecodeError: Expecting value: .* \(.*:\d+\)",
    ),
    # rules
    (
        "g: {step: to_grams, in: frame}\nm: {step: volts, in: g}",
        "step 'volts' takes volt at port 'image', got gram",
    ),
    (
        "g: {step: to_grams, in: frame}\nm: {step: threshold, in: g, with: {level_v: 1}}",
        "setting 'level_v' of step 'threshold' takes volt at port 'image', got gram",
    ),
    (
        M + "f: {step: finer, in: m}\nb: {step: both, in: [m, f]}",
        "step 'both' needs 'b' on the same grid as 'a', but its cells are 0.5 times as wide",
    ),
    (M + "f: {step: finer, in: m}\nb: {step: sixteen, in: f}", "takes 15 rows .*cut into 2 a side"),
    # guards
    ("m: {step: threshold, in: frame, when: }", "node 'm': 'when' is empty"),
    ("m: {step: threshold, in: frame, when: [a]}", "'when' must be a text, got a list"),
    (M + "n: {step: finer, in: m, when: mm.count > 0}", "'when': no node named 'mm'; did you mean"),
    (
        M + "n: {step: finer, in: m, when: m.cuont > 0}",
        r"m \(Mask\) has no field 'cuont'; did you m",
    ),
    (M + "n: {step: finer, in: m, when: m}", "m is a Mask, not a yes/no or a number; it has: area"),
    (
        M + "n: {step: finer, in: m, when: m > 1}",
        "m is a Mask and cannot be compared; it has: area",
    ),
    (
        M + "n: {step: finer, in: m, when: m.count >}",
        "'when': 'm.count >' is no condition: invalid s",
    ),
    (M + "n: {step: finer, in: m, when: m.count > ((1}", "was never closed"),
    (
        M + "n: {step: finer, in: m, when: m.count > 'b'}",
        "'when': m.count is a number and 'b' is a text: they cannot be compared",
    ),
    (M + "n: {step: finer, in: m, when: 0 < m.count < 'b'}", "they cannot be compared"),
    (M + "n: {step: finer, in: m, when: 1 > 2}", "'when': 1 > 2 reads no node: it is always false"),
    (M + "n: {step: finer, in: m, when: m.count > 0 or 2 > 1}", "2 > 1 reads no node: .* true"),
    (M + "n: {step: finer, in: m, when: m.count = 1}", "invalid syntax; to compare, write '=='"),
    (M + "n: {step: finer, in: m, when: m.count > 1 && m}", "write 'and' for '&&'"),
    (M + "n: {step: finer, in: m, when: m.count > 1 || m}", r"write 'or' for '\|\|'"),
    (
        "m: {step: threshold, in: frame, with: {level_v: '0.2'}}",
        "must be a number or null, got the text '0.2'; without the quotes it is a number",
    ),
    (
        "m: {step: threshold, in: frame, with: {level_v:0.2}}",
        "unknown setting 'level_v:0.2'; a space is missing behind the colon: level_v: 0.2",
    ),
    (
        "m: {step: threshold, in: frame, with: {level_v=0.2}}",
        "a key and its value have a colon and a space between them: level_v: 0.2",
    ),
    ("m: {step: threshold, in: frame, with: {level_v 0.2}}", "a colon is missing: level_v: 0.2"),
    (
        "m: {step: threshold, in: frame, with: {level_v: 0,2}}",
        "unknown setting '2'; the decimals of a number stand behind a point",
    ),
    (
        "m: {step: threshold, in: frame, with: {level_v: 0.2V}}",
        "got '0.2V'; a number stands without its unit: 0.2",
    ),
    (
        "m: {step: threshold, in: frame, with: {level_v: '0,2'}}",
        "got '0,2'; its decimals stand behind a point: 0.2",
    ),
    ("m: {step: threshold, in: frame, with: {LEVEL_V: 0.2}}", "did you mean 'level_v'"),
    ("m: {step:threshold, in: frame}", "a space is missing behind the colon: step: threshold"),
    ("m: {step: threshold, in:frame}", "a space is missing behind the colon: in: frame"),
    ("m: {STEP: threshold, in: frame}", "unknown key 'STEP'; did you mean 'step'"),
    ("m: {step: threshold, inputs: frame}", "unknown key 'inputs'; did you mean 'in'"),
    ("m: {step: threshold, in: frame, Params: {}}", "unknown key 'Params'; did you mean 'with'"),
    (
        "m: {step: threshold, in: frame, level_v: 3}",
        "about; a setting stands under 'with': {level_v: …}",
    ),
    (
        "m: {step: threshold, in: frame, with: level_v: 3}",
        "a comma is missing before this key, or braces around a mapping in {…}",
    ),
    (
        M + "n: {step: finer, in: m, when: qqq.count > 1}",
        "no node named 'qqq'; there are: frame, m, n",
    ),
    (
        "early: {step: threshold, in: frame, when: lste.count > 1}\nlate: {step: masks, in: frame}",
        "'when': no node named 'lste'; did you mean 'late'",
    ),
    (
        "early: {step: finer, in: lste}\nlate: {step: masks, in: frame}",
        "no node named 'lste'; did you mean 'late'",
    ),
    (
        "l: {step: listed, in: frame}\nm: {step: anything, in: l}",
        r"takes a Sequence\[Any \| None\]; try l\.values",
    ),
    ("m: {step: several, in: frame}", r"takes a list\[Image\]; as a list of nodes it is \[frame\]"),
    ("m: {step: torn, in: frame}", r"node 'm': step 'torn' cannot be made: KeyError: 'x' \(.*py:"),
    ("m: {step: maybe, in: frame}", r"may return None .*Degenerate.* \(plugin '.*', package "),
    (
        M + "n: {step: finer, in: m, when: __import__('os')}",
        "only abs, len, max, min, any, all, count can be called",
    ),
    (M + "n: {step: finer, in: m, when: 'abs(m.count, 1) > 0'}", r"abs\(\) takes one argument"),
    (M + "n: {step: finer, in: m, when: 'm.count ** 9 > 1'}", "pow is not allowed in a condition"),
    (M + "n: {step: finer, in: m, when: '[x for x in m]'}", "listcomp is not allowed"),
    (M + "n: {step: finer, in: m, when: 'm.count > 1j'}", "1j is not allowed in a condition"),
    (M + "n: {step: finer, in: m, when: '(1).real > 0'}", "a field can only be taken from a node"),
    (M + "n: {step: finer, in: m, when: m._values > 0}", "has no field '_values'"),
    (M + f"n: {{step: finer, in: m, when: '{'1' * 2001}'}}", "longer than 2000 characters"),
    (
        M + f"n: {{step: finer, in: m, when: '{'-' * 1900}1'}}",
        "nested deeper than 100 levels",
    ),
    # embedded pipelines
    ("m: {use: iner}", "pipeline 'iner' cannot be used: no pipeline named 'iner'; did you mean"),
    ("m: {use: bad}", "pipeline 'bad' cannot be used: .*no step named 'thresold'"),
    ("m: {use: gone}", "pipeline file '.*gone.yaml' cannot be read"),
    ("m: {use: loop}", "pipelines use each other in a circle: loop -> pool -> loop"),
    ("m: {use: p}", "pipelines use each other in a circle: p -> p"),
    (f"m: {{use: {'x' * 300}.yaml}}", "no pipeline file"),
    (
        "m: {use: inner, with: {level_v: 1}}",
        "settings of an embedded pipeline are named node.setting",
    ),
    ("m: {use: inner, with: {m.levl_v: 1}}", "unknown setting 'levl_v'; did you mean 'level_v'"),
    ("m: {use: inner, with: {q.level_v: 1}}", "node 'm', q.level_v: no node named 'q'"),
    ("m: {use: inner, in: [frame]}", "an embedded pipeline takes one input, its frame, or a map"),
    (
        "m: {use: inner, in: {frame: frame, mm: frame}}",
        "pipeline 'inner' has no node 'mm' to take the place of; did you mean 'm'?",
    ),
    ("m: {use: inner, in: {m: frame}}", "frame is a Frame, but stands for 'm', a Mask"),
    ("m: {use: inner, in: {m: [frame]}}", "'m' takes one input, not a list"),
    ("c: {step: constant}\nm: {use: inner, in: {m: gone}}", "no node named 'gone'"),
    (
        "c: {step: constant}\nm: {use: inner, in: c}",
        "the pipeline reads frame.image, but c is a int",
    ),
    (
        "g: {step: to_grams, in: frame}\nm: {use: inner, in: g}",
        "node 'm': m/n: step 'volts' takes volt at port 'image', got gram",
    ),
    ("u: {use: inner}\nm: {step: finer, in: u}", "'u' has the outputs m, n; name one"),
    ("u: {use: inner}\nm: {step: finer, in: u.x}", "'u' has the outputs m, n; 'x' is none of them"),
    ("m: {step: frames}", "'frames' is a source; it belongs under 'source'"),
]


@pytest.mark.parametrize(("nodes", "message"), BAD_NODES, ids=range(len(BAD_NODES)))
def test_a_wrong_node_is_told_with_place_and_snippet(nodes: str, message: str, reg: Any) -> None:
    text = text_of(nodes)
    with pytest.raises(PipelineError, match=message) as caught:
        loads(text, "p.yaml", reg)
    problem = next(p for p in caught.value.problems if re.search(message, p.message))
    assert problem.mark is not None
    assert re.match(r"p\.yaml:\d+:\d+: ", str(problem))
    shown, caret = problem.snippet.splitlines()
    # What the caret points at is what stands at the marked place.
    line = text.splitlines()[problem.mark.line - 1]
    pointed = shown[caret.index("^") :][:5]
    assert pointed == line[problem.mark.column - 1 :][: len(pointed)]


BAD_FILES = [
    ("", "the file is empty"),
    ("- a", r"a pipeline file is a mapping, got a list: \['a'\]"),
    ("just text", "a pipeline file is a mapping, got a text: 'just text'"),
    ("a: [", "this is not YAML: "),
    ("a: b: c", "this is not YAML: mapping values are not allowed here"),
    ("a: 1\n--- \nb: 2", "not YAML: '---' begins a second document, but"),
    ("a: \x01", r"a character that YAML does not allow: '\\x01'"),
    ("[" * 2000, "deeper than 40 levels"),
    ("a: " + "[" * 60 + "]" * 60, "deeper than 40 levels"),
    ("x" * 1_000_001, "the file is too long: 1000001 characters"),
    ("a: &a [*a]", "an alias that contains itself"),
    (
        "a: &a [1,1,1,1,1,1,1,1,1]\n"
        + "".join(
            f"{chr(98 + i)}: &{chr(98 + i)} [{','.join([f'*{chr(97 + i)}'] * 9)}]\n"
            for i in range(8)
        ),
        "more than 20000 values",
    ),
    ("a: *b", "this is not YAML: found undefined alias 'b'"),
    ("a:\n\tb: 1", "this is not YAML: a tab cannot stand here: YAML is indented with spaces"),
    ("pipeline: !!python/object:os.system p", "the tag 'tag:yaml.org,2002:python/object:os.system"),
    ("pipeline: !mine p", "the tag '!mine' is refused: pipeline files hold plain values only"),
    ("!!python/name:os.system pipeline: p", "the tag 'tag:yaml.org,2002:python/name:os.system' is"),
    ("pipeline: !!int x", "'x' is no int"),
    ("pipeline: !!int ''", "'' is no int"),
    ("pipeline: !!bool x", "'x' is no bool"),
    ("pipeline: !!float ''", "'' is no float"),
    ("pipeline: !!set {a}", "the tag 'tag:yaml.org,2002:set' is refused"),
    ("a: &a {b: 1}\nc:\n  <<: *a", r"merge keys \('<<'\) are refused"),
    ("? [a, b]\n: 1", "a key must be a plain word"),
    ("pipeline: p\npipeline: q", "'pipeline' is given twice; the first is in line 1"),
    ("nodes: {}", "'pipeline' is missing: every file names its pipeline"),
    ("pipeline: true", "'pipeline' must be a text, got a yes/no: True"),
    ("pipeline: [a]", "'pipeline' must be a text, got a list"),
    ("pipeline: p\nabuot: x", "pipeline file: unknown key 'abuot'; did you mean 'about'"),
    ("pipeline: p\nqqq: x", "unknown key 'qqq'; allowed: pipeline, about, evolves, source"),
    ("pipeline: p", "'nodes' is missing: it maps a name to each node"),
    ("pipeline: p\nnodes: [a]", "'nodes' must be a mapping of nodes, got a list"),
    (text_of(rest=""), "'outputs' is missing: a list of nodes out of m"),
    (text_of(rest="outputs: []"), "'outputs' must be a list of nodes, got an empty list"),
    (text_of(rest="outputs: [m/n]"), "got a text: 'm/n'; what is inside .* to be seen by --only"),
    (text_of(rest="outputs: {m: 1}"), "'outputs' must be a list of nodes, got a mapping"),
    (text_of(rest="outputs: [n]"), "output 'n': no node named 'n'; did you mean 'm'|there are"),
    (text_of(rest="outputs: [m.x]"), r"output 'm.x': m \(Mask\) has no field 'x'"),
    (text_of(rest="outputs: [m, m]"), "output 'm' is given twice"),
    (
        text_of(rest="outputs: [m]\nevolves: iner"),
        "'evolves': no pipeline named 'iner'; did you mea",
    ),
    (text_of(rest="outputs: [m]\nsource: 3"), "'source' must be {step: …, with: …}, got 3"),
    (text_of(rest="outputs: [m]\nsource: {}"), "source: 'step' is missing"),
    (
        text_of(rest="outputs: [m]\nsource: {stp: x}"),
        "source: unknown key 'stp'; did you mean 'step'",
    ),
    (
        text_of(rest="outputs: [m]\nsource: {step: fram}"),
        "source: no step named 'fram'; did you mea",
    ),
    (text_of(rest="outputs: [m]\nsource: {step: volts}"), "source: step 'volts' is no source"),
    (
        text_of(rest="outputs: [m]\nsource: {step: frames, with: {n: 0}}"),
        "source, n: must be >= 1, got 0",
    ),
    (
        text_of(rest="outputs: [m]\nsource: {step: frames, with: 0}"),
        "'with' must be a mapping, got 0",
    ),
    (
        text_of("m: {step: volts, in: frame}", "outputs: [m]\nsource: {step: frames}"),
        "step 'volts' takes volt at port 'image', got counts",
    ),
    (text_of(rest="outputs: [m]\nsource: frames"), "'source' must be .*; write {step: frames}"),
    (text_of(rest="outputs: [m]\nconditions: 3"), "'conditions' must be a mapping, got 3"),
    (
        text_of(rest="outputs: [m]\nconditions: {a: [m]}"),
        "condition 'a' must be an expression, got",
    ),
    (text_of(rest="outputs: [m]\nconditions: {m: 1 > 0}"), "'m' is both a node and a condition"),
    (text_of(rest="outputs: [m]\nconditions: {a-b: 1 > 0}"), "condition name 'a-b': letters"),
    (text_of(rest="outputs: [m]\nconditions: {a: x > 0}"), "condition 'a': no node named 'x'"),
    (text_of(rest="outputs: [m]\nconditions: {a: b, b: a}"), "refers to itself: "),
    (
        text_of(
            rest="outputs: [m]\nconditions: {"
            + ", ".join(f"c{i}: c{i + 1} and c{i + 1}" for i in range(40))
            + ", c40: m.count > 0}"
        ),
        "longer than 2000 characters",
    ),
]


@pytest.mark.parametrize(("text", "message"), BAD_FILES, ids=range(len(BAD_FILES)))
def test_a_wrong_file_is_told_with_its_place(text: str, message: str, reg: Any) -> None:
    with pytest.raises(PipelineError, match=message) as caught:
        loads(text, "p.yaml", reg)
    assert all(str(p).startswith("p.yaml:") for p in caught.value.problems)


@pytest.mark.parametrize("value", ["!!int x", "!!float ''", "!mine 3"])
@pytest.mark.parametrize("text", [
    "pipeline: {}\nnodes: {{a: {{step: load, in: frame}}}}",
    "pipeline: p\nnodes: {}",
    "pipeline: p\nnodes: {{a: {{step: {}, in: frame}}}}",
    "pipeline: p\nnodes: {{a: {{step: threshold, in: frame, with: {{level_v: {}}}}}}}",
    "pipeline: p\nsource: {{step: {}}}\nnodes: {{a: {{step: load, in: frame}}}}",
    "pipeline: p\nsource: {{step: recording, with: {{path: {}}}}}\n"
    "nodes: {{a: {{step: load, in: frame}}}}",
], ids=["name", "nodes", "step", "setting", "source", "setting of a source"])  # fmt: skip
def test_a_value_that_cannot_be_read_is_one_mistake(text: str, value: str) -> None:
    with pytest.raises(PipelineError) as caught:
        loads(f"{text.format(value)}\noutputs: [a]", "p.yaml")
    assert len(caught.value.problems) == 1


def test_a_name_that_is_no_text_is_not_missing_as_well(reg: Any) -> None:
    with pytest.raises(PipelineError) as caught:
        loads("pipeline: no", "p.yaml", reg)
    assert not any("'pipeline' is missing" in str(p) for p in caught.value.problems)


def test_all_mistakes_are_told_in_one_run_in_the_order_of_the_file(reg: Any) -> None:
    text = """
pipeline: p
abuot: x
conditions: {touched: footprnt.count > 0}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: -0.5, levl: 3}}
  fine: {step: finr, in: footprint}
  c1: {step: add1, in: c2, with: {k: x}}
  c2: {step: add1, in: c1}
  d1: {step: add1, in: d2}
  d2: {step: add1, in: d1, when: touched}
  t: {step: add1, in: footprint, when: footprint.cuont > 1}
outputs: [last]
"""
    with pytest.raises(PipelineError) as caught:
        loads(text, "bad.yaml", reg)
    found = [(p.mark.line, p.mark.column, p.message.split(";")[0]) for p in caught.value.problems]
    assert found == [
        (3, 1, "pipeline file: unknown key 'abuot'"),
        (4, 23, "condition 'touched': no node named 'footprnt'"),
        (6, 59, "node 'footprint', level_v: must be > 0.0, got -0.5"),
        (6, 71, "node 'footprint', levl: unknown setting 'levl'"),
        (7, 16, "node 'fine': no step named 'finr'"),
        (8, 3, "the nodes form a cycle: c1 -> c2 -> c1"),
        (8, 38, "node 'c1', k: must be a whole number, got 'x'"),
        (10, 3, "the nodes form a cycle: d1 -> d2 -> d1"),
        (12, 23, "node 't': 'footprint' is a Mask, but port 'a' of step 'add1' takes an int"),
        (12, 40, "node 't', 'when': footprint (Mask) has no field 'cuont'"),
        (13, 11, "output 'last': no node named 'last'"),
    ]


def test_the_text_of_an_error_shows_place_words_and_line(reg: Any) -> None:
    with pytest.raises(PipelineError) as caught:
        loads(text_of("m: {step: threshold, in: frm}"), "p.yaml", reg)
    assert str(caught.value) == (
        "p.yaml:3:28: node 'm': no node named 'frm'; did you mean 'frame'?\n"
        "  3 |   m: {step: threshold, in: frm}\n"
        "                                 ^"
    )


# -- overrides ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("level_v", "setting 'level_v': it is named node.setting; did you mean m.level_v"),
        ("mm.level_v", "setting mm.level_v: no node named 'mm'; did you mean 'm'"),
        ("m.levl_v", "setting m.levl_v: unknown setting 'levl_v'; did you mean 'level_v'"),
        ("m.level_v", "setting m.level_v: must be > 0.0, got -1"),
        (
            "u.level_v",
            "'u' is no step and has no settings; inside it they are named u/node.setting",
        ),
        ("f.level_v", "node 'f' is no step and has no settings"),
        ("m/x.level_v", "no node named 'm/x'"),
        ("m.model.a.b", "a setting is given whole: m.model={a: {b: -1}}"),
        ("u/q.level_v", "setting q.level_v: no node named 'q'"),
    ],
)
def test_an_override_of_what_is_not_there_is_refused(setting: str, message: str, reg: Any) -> None:
    p = loads(text_of(M + "u: {use: inner}\nf: {first_of: [m]}"), "p.yaml", reg)
    with pytest.raises(PipelineError, match=message):
        p.with_settings({setting: -1})


def test_overrides_add_up_and_leave_the_pipeline_alone(reg: Any) -> None:
    p = loads(text_of(), "p.yaml", reg)
    q = p.with_settings({"m.level_v": 0.5}).with_settings({"m.kind": "soft"})
    assert q.nodes["m"].settings == {"level_v": 0.5, "kind": "soft", "cells": 2}
    assert p.nodes["m"].settings["level_v"] is None


def test_another_source_checks_the_rules_again(reg: Any) -> None:
    p = loads(text_of("m: {step: volts, in: frame}"), "p.yaml", reg)
    with pytest.raises(PipelineError, match=r"takes volt at port 'image', got counts"):
        p.with_source("frames", n=2)
    q = loads(text_of(), "p.yaml", reg).with_source("frames", n=2)
    assert [r.frame.index for r in q.stream()] == [0, 1]
    with pytest.raises(UsageError, match=r"pipeline 'p' declares no source: give it frames"):
        p.frames()


# -- finding -----------------------------------------------------------------------------------


def test_a_pipeline_is_found_by_name_or_file(reg: Any, tmp_path: Path) -> None:
    assert load("inner", reg).name == "inner"
    assert load(tmp_path / "inner.yaml", reg).name == "inner"
    (tmp_path / "readme").write_text("x")
    with pytest.raises(
        UsageError, match=r"no pipeline file '.*innr.yaml'; did you mean 'inner.yaml'"
    ):
        load(tmp_path / "innr.yaml", reg)
    with pytest.raises(UsageError, match=r"no pipeline named 'innr'; did you mean 'inner'"):
        load("innr", reg)


def test_a_file_that_is_no_pipeline_file_is_told(
    reg: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("data").write_text("x")
    with pytest.raises(UsageError, match=r"'data' is a file, but a pipeline file ends in .*; rec"):
        load("data", reg)
    with pytest.raises(UsageError, match=r"no file 'data.csv', and no pipeline named 'data.csv'"):
        load("data.csv", reg)
    Path("latin.yaml").write_bytes(b"about: \xe9")
    with pytest.raises(UsageError, match=r"pipeline file 'latin.yaml' cannot be read"):
        load("latin.yaml", reg)


def test_a_file_may_use_and_evolve_from_its_neighbour(reg: Any, tmp_path: Path) -> None:
    (tmp_path / "next.yaml").write_text(
        "pipeline: next\nevolves: inner.yaml\nnodes: {u: {use: inner.yaml}}\noutputs: [u.m]\n"
    )
    assert list(load(tmp_path / "next.yaml", reg).nodes) == ["u/m", "u/n", "u.m", "u.n"]


def test_a_pipeline_may_use_another_of_its_own_name(reg: Any) -> None:
    text = text_of("m: {use: inner}", "outputs: [m.m]").replace("pipeline: p", "pipeline: inner")
    assert "m/m" in loads(text, "mine.yaml", reg).nodes


def test_a_file_that_uses_itself_under_another_name_is_a_circle(reg: Any, tmp_path: Path) -> None:
    path = tmp_path / "self.yaml"
    path.write_text("pipeline: other\nnodes: {u: {use: self.yaml}}\noutputs: [u]\n")
    with pytest.raises(PipelineError, match=r"in a circle: other -> other"):
        load(path, reg)


def test_files_that_use_each_other_are_a_circle_wherever_one_comes_in(
    reg: Any, tmp_path: Path
) -> None:
    for name, used in (("d", "cb"), ("c", "b"), ("b", "c")):
        nodes = ", ".join(f"{u}: {{use: {u}.yaml, with: {{m.tag: x}}}}" for u in used)
        text = f"pipeline: {name}\nnodes: {{{nodes}, m: {{step: constant}}}}\noutputs: [m]\n"
        (tmp_path / f"{name}.yaml").write_text(text)
    with pytest.raises(PipelineError) as caught:
        load(tmp_path / "d.yaml", reg)
    assert "in a circle: c -> b -> c" in str(caught.value)
    assert "in a circle: b -> c -> b" in str(caught.value)


def test_a_line_that_is_cut_at_its_left_says_so(reg: Any) -> None:
    names = ", ".join(f"name_{k}" for k in range(20))
    with pytest.raises(PipelineError) as caught:
        loads(
            text_of(f"m: {{step: refuses, in: frame, with: {{n: [{names}], x: 1}}}}"), "p.yaml", reg
        )
    problem = next(p for p in caught.value.problems if "unknown setting 'x'" in p.message)
    shown, caret = problem.snippet.splitlines()
    assert "| …" in shown
    assert shown[caret.index("^") :].startswith("1}}")


def test_a_byte_order_mark_is_no_mistake(reg: Any, tmp_path: Path) -> None:
    path = tmp_path / "bom.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + text_of().encode())
    assert load(path, reg).name == "p"


def test_a_broken_step_is_told_at_the_node_that_names_it() -> None:
    def unannotated(image) -> int:  # type: ignore[no-untyped-def]
        return 1

    with pytest.raises(PipelineError, match=r"p.yaml:3:13: .*parameter 'image' has no annotation"):
        loads(text_of("m: {step: bad, in: frame}"), "p.yaml", registry({"bad": unannotated}))
    with pytest.raises(PipelineError, match=r"cannot import nowhere.to.be.found"):
        loads(text_of("m: {step: bad}"), "p.yaml", registry({"bad": "nowhere.to.be.found:x"}))
    with pytest.raises(PluginError, match=r"'bad' of plugin 'test' .*: json has no 'nope'"):
        registry({"bad": "json:nope"}).step("bad")


# -- order -------------------------------------------------------------------------------------

ORDER = """
import sys
sys.path.insert(0, {tests!r})
from helpers_graphs import registry
from tactile_graph import loads
p = loads({text!r}, "p.yaml", registry())
print(list(p.nodes), [n.key for n in p.nodes.values()], p.key)
print([i.name for i in p.runner().plan.items])
try:
    loads({bad!r}, "p.yaml", registry())
except Exception as error:
    print(error)
"""


@pytest.mark.slow
def test_the_order_is_the_same_under_two_hash_seeds() -> None:
    nodes = "\n".join(
        f"n{i}: {{step: add2, in: [v, n{(i * 7) % 13 + 20}], when: a and b or v > {i}}}"
        for i in range(10)
    )
    roots = "\n".join(f"n{i + 20}: {{step: add1, in: v}}" for i in range(13))
    rest = (
        "conditions: {a: v > 1, b: n20 > n21 + n22}\noutputs: "
        f"[{', '.join(f'n{i}' for i in range(10))}]"
    )
    text = text_of(f"{nodes}\n{roots}\nv: {{step: read, in: frame}}", rest)
    bad = text.replace("step: read, in: frame", "step: add1, in: n3")
    code = ORDER.format(tests=str(Path(__file__).parents[2]), text=text, bad=bad)
    outputs = [
        subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            check=True,
            env={**os.environ, "PYTHONHASHSEED": seed},
        ).stdout
        for seed in ("1", "2")
    ]
    assert outputs[0] == outputs[1]
    assert "form a cycle" in outputs[0]


USES_OTHER = "pipeline: p\nnodes: {best: {use: other.yaml, in: frame}}\noutputs: [best]\n"


def test_a_pipeline_that_another_uses_is_looked_for_beside_it_and_here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "p.yaml").write_text(USES_OTHER)
    monkeypatch.chdir(tmp_path)
    found: dict[str, Stamp] = {}
    with files_read(found), pytest.raises(PipelineError, match="no pipeline file"):
        load("folder/p.yaml")
    missing = {path for path, stamp in found.items() if stamp is None}
    assert missing == {os.path.join("folder", "other.yaml"), "other.yaml"}


def _files_of_level(folder: Path, level: int) -> None:
    (folder / "parts").mkdir(parents=True)
    deep = f"""\
pipeline: deep
nodes: {{m: {{step: threshold, in: frame, with: {{level: {level}}}}}}}
outputs: [m]
"""
    (folder / "parts" / "deep.yaml").write_text(deep)
    (folder / "parts" / "inner.yaml").write_text(USES_OTHER.replace("other", "deep"))
    (folder / "parts" / "outer.yaml").write_text(
        f"""\
pipeline: outer
evolves: inner.yaml
nodes:
  beside: {{use: inner.yaml}}
  here: {{use: {folder.name}.yaml}}
  own: {{step: threshold, in: frame, with: {{level: 1}}}}
outputs: [beside, here, own]
"""
    )


def test_a_pipeline_keeps_the_files_it_was_made_of_whichever_folder_is_current(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, level in (("first", 1), ("second", 3)):
        _files_of_level(tmp_path / name, level)
        (tmp_path / name / "first.yaml").write_text(USES_OTHER.replace("other", "parts/deep"))
    monkeypatch.chdir(tmp_path / "first")
    pipeline = load("parts/outer.yaml")
    monkeypatch.chdir(tmp_path / "second")
    changed = pipeline.with_settings({"own.level": 5})
    again = pickle.loads(pickle.dumps(changed)).with_source("sample", name="discs")
    for found, own in ((pipeline, 16), (changed, 0), (again, 0)):
        assert found.file == os.path.join("parts", "outer.yaml")
        result = found.run(np.full((4, 4), 2.0))
        assert [result[name].count for name in ("beside", "here", "own")] == [16, 16, own]
    monkeypatch.chdir(tmp_path)
    shutil.rmtree(tmp_path / "first")
    assert pipeline.with_settings({"own.level": 5}).key == changed.key


def test_a_name_is_looked_for_as_no_file() -> None:
    found: dict[str, Stamp] = {}
    with files_read(found), pytest.raises(UsageError, match="no pipeline named"):
        load("nothing")
    assert not [path for path, stamp in found.items() if stamp is None]


def test_a_script_gives_steps_of_its_own_by_name(reg: Any) -> None:
    def mine(image: Image, *, gain: float = 2.0) -> float:
        return gain * image.peak

    text = "pipeline: p\nnodes: {a: {step: mine, in: frame}}\noutputs: [a]"
    p = loads(text, steps={"mine": mine})
    assert [r["a"] for r in p.with_settings({"a.gain": 3}).stream([np.ones((2, 2))])] == [3.0]
    with pytest.raises(UsageError, match="registry of its own, or steps: not to be pickled"):
        pickle.dumps(p)
    with pytest.raises(UsageError, match="steps: a registry is given"):
        loads(text, registry=reg, steps={"mine": mine})


@pytest.mark.parametrize(
    ("steps", "told"),
    [
        ([len], "steps must be a mapping of names to functions, got list"),
        (len, "steps must be a mapping of names to functions, got .*; give {'len': len}"),
        ({"x": 3}, "steps: 'x' is 3, no function"),
        ({"x": None}, "steps: 'x' is None, no function"),
        ({3: len}, "steps: names are texts, got 3"),
    ],
)
def test_steps_that_are_no_functions_by_name_are_refused(steps: Any, told: str) -> None:
    text = "pipeline: p\nnodes: {a: {step: x, in: frame}}\noutputs: [a]"
    with pytest.raises(UsageError, match=told):
        loads(text, steps=steps)
    with pytest.raises(UsageError, match="registry must be a Registry, got dict; steps="):
        loads(text, "p.yaml", {"x": len})  # type: ignore[arg-type]


def test_a_parent_that_is_looked_into_has_the_name_it_is_looked_for_by(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    nodes = "nodes: {{a: {{step: threshold, in: frame, with: {{level: auto}}}}}}"
    text = f"pipeline: {{}}\n{{}}{nodes}\noutputs: [a]\n"
    (tmp_path / "child.yaml").write_text(text.format("child", "evolves: parent.yaml\n"))
    (tmp_path / "parent.yaml").write_text(text.format("parent", ""))
    monkeypatch.chdir(tmp_path)
    read: dict[str, Any] = {}
    with files_read(read):
        assert evolves_in_circle(load("child.yaml")) == ""
    assert sorted(name for name in read if name.endswith("parent.yaml")) == ["parent.yaml"]
