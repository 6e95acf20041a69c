"""Whatever is done to a pipeline file, it gives a pipeline or an error of the file."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from helpers_graphs import registry
from tactile_graph import Pipeline, loads
from tactile_graph.engine.plan import make_plan
from tactile_graph.errors import PipelineError

FILES = [
    """\
pipeline: one
about: a chain with a guard
conditions: {touched: "v > 3 and not big", big: v >= 100}
nodes:
  v: {step: read, in: frame}
  p: {step: pair, in: v, with: {tag: "x"}}
  a: {step: add2, in: [p.low, p.high], when: touched}
  b: {step: optional, in: {a: v, b: a}}
  best: {first_of: [a, b]}
outputs: [best, p.low]
""",
    """\
pipeline: two
evolves: inner
nodes:
  m: &shared
    step: many
    in: frame.index
  each: {step: picky, in: m, each: true, with: {bad: 3}}
  sum:
    step: total_of
    in:
      a: c
      items: [c, u.x, k]
    when: len(m) > 1 or c == 2
  c: {step: constant, with: {value: 2}}
  k: {step: count, in: c}
  u: {use: inner, in: frame, with: {x.k: 4}}
outputs:
  - sum
  - each
""",
]
INNER = (
    "pipeline: inner\nnodes: {x: {step: add1, in: frame.index}, y: {step: add1, in: x}}\n"
    "outputs: [x, y]\n"
)
WORDS = [
    "",
    "~",
    "null",
    "[]",
    "{}",
    "true",
    "1e400",
    ".nan",
    "-.inf",
    "0x" + "f" * 5000,
    "9" * 4400,
    "v",
    "frame",
    "frame.image",
    "p.note",
    "a.b.c",
    "u",
    "u.x",
    "*shared",
    "&x y",
    "<<: *shared",
    "!!int x",
    "!!python/object:x y",
    "!!bool z",
    "!!binary aGk=",
    "2020-01-01",
    "1:30",
    "'",
    '"',
    '"\\0"',
    '"\\ud800"',
    "é",
    "\u2028",
    "\ufeff",
    "\t",
    "- ",
    "? ",
    ": ",
    "#",
    "|\n",
    ">-\n",
    "%YAML 2",
    "---\n",
    "...\n",
    "inner",
    "one",
    "two",
    "step",
    "use",
    "first_of",
    "each",
    "in",
    "with",
    "when",
    "__import__('os')",
    "v if v else 0",
    "lambda: 0",
    "v[0]",
    "(" * 300,
    "not " * 400 + "v",
    "-" * 1500 + "v",
    "v" * 3000,
    "x" * 300 + ".yaml",
    "../" * 50 + "x.yaml",
]

Mutation = Callable[[random.Random, str], str]


def characters(rng: random.Random, text: str) -> str:
    for _ in range(rng.randint(1, 4)):
        i = rng.randrange(len(text) + 1)
        kind = rng.randrange(4)
        if kind == 0:
            text = text[:i] + text[i + rng.randint(1, 3) :]
        elif kind == 1:
            text = text[:i] + rng.choice("[]{}:,-&*!|>'\"%@`#?~ \n\t.0aé\x00\x85\ud83d") + text[i:]
        elif kind == 2:
            text = text[:i] + rng.choice(WORDS) + text[i:]
        else:
            j = rng.randrange(len(text) + 1)
            text = text[:i] + text[min(i, j) : max(i, j)] + text[i:]
    return text


def raw_bytes(rng: random.Random, text: str) -> str:
    data = bytearray(text.encode("utf-8", "replace"))
    for _ in range(rng.randint(1, 6)):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return data.decode("utf-8", rng.choice(["replace", "surrogateescape", "ignore"]))


def lines(rng: random.Random, text: str) -> str:
    rows = text.splitlines()
    for _ in range(rng.randint(1, 3)):
        i, j = rng.randrange(len(rows)), rng.randrange(len(rows))
        kind = rng.randrange(4)
        if kind == 0 and len(rows) > 1:
            del rows[i]
        elif kind == 1:
            rows.insert(j, rows[i])
        elif kind == 2:
            rows[i], rows[j] = rows[j], rows[i]
        else:
            rows[i] = " " * rng.randint(0, 6) + rows[i].strip()
        j %= len(rows)
    return "\n".join(rows) + "\n"


def words(rng: random.Random, text: str) -> str:
    parts = text.split(" ")
    for _ in range(rng.randint(1, 3)):
        parts[rng.randrange(len(parts))] = rng.choice([*WORDS, rng.choice(parts)])
    return " ".join(parts)


def tree(rng: random.Random, text: str) -> str:
    """Change the data itself: the file stays YAML, but a value or a key becomes another."""
    data = yaml.safe_load(text)
    for _ in range(rng.randint(1, 3)):
        places = list(_places(data))
        holder, key = rng.choice(places)
        kind = rng.randrange(4)
        if kind == 0:
            holder[key] = rng.choice(
                [
                    None,
                    True,
                    0,
                    -1,
                    2.5,
                    "",
                    "v",
                    "frame",
                    [],
                    {},
                    ["v"],
                    [["v"]],
                    {"a": 1},
                    "x" * 200,
                    10**30,
                    float("nan"),
                    "a b",
                    "v.x",
                ]
            )
        elif kind == 1:
            del holder[key]
        elif kind == 2 and isinstance(holder, dict):
            holder[rng.choice(["step", "use", "when", "in", "x", "frame", "é", "1"])] = holder.pop(
                key
            )
        else:
            other, place = rng.choice(places)
            if key in holder if isinstance(holder, dict) else key < len(holder):
                holder[key] = yaml.safe_load(yaml.safe_dump(_get(other, place)))
    return yaml.safe_dump(data, sort_keys=False)


def _get(holder: Any, key: Any) -> Any:
    try:
        return holder[key]
    except LookupError:
        return None


def _places(data: Any) -> list[tuple[Any, Any]]:
    keys = list(data) if isinstance(data, dict) else list(range(len(data)))
    found = [(data, k) for k in keys]
    for key in keys:
        if isinstance(data[key], dict | list):
            found += _places(data[key])
    return found


MUTATIONS: list[Mutation] = [characters, raw_bytes, lines, words, tree]


@pytest.mark.slow
@pytest.mark.parametrize("mutate", MUTATIONS, ids=lambda m: m.__name__)
def test_240_mutants_of_each_kind_give_a_pipeline_or_an_error_of_the_file(
    mutate: Mutation, tmp_path: Path
) -> None:
    (tmp_path / "inner.yaml").write_text(INNER)
    reg = registry(pipelines={"inner": tmp_path / "inner.yaml"})
    rng = random.Random(f"tactile {mutate.__name__}")
    wrong: list[str] = []
    for number in range(240):
        text = mutate(rng, FILES[number % len(FILES)])
        try:
            pipeline = loads(text, "mutant.yaml", reg)
        except PipelineError as error:
            wrong.append(str(error))
        else:
            assert isinstance(pipeline, Pipeline)
            make_plan(pipeline, tuple(pipeline.outputs))
            pipeline.runner()
            repr(pipeline.resolved())
    assert len(wrong) > 60
    assert [text for text in wrong if not text.startswith("mutant.yaml:")] == []


def test_what_is_mutated_is_right_to_begin_with(tmp_path: Path) -> None:
    (tmp_path / "inner.yaml").write_text(INNER)
    for text in FILES:
        loads(text, "p.yaml", registry(pipelines={"inner": tmp_path / "inner.yaml"}))
