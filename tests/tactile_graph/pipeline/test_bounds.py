"""A pipeline file that asks for work out of proportion is refused before the work."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml

from helpers_graphs import STEPS, registry
from tactile_graph import Image, load, loads
from tactile_graph.errors import PipelineError, UsageError
from tactile_graph.pipeline import document
from tactile_graph.pipeline import load as module

LEAF = "pipeline: leaf\nnodes: {a: {step: read, in: frame}}\noutputs: [a]\n"

WHEN = """\
pipeline: when
nodes:
  named: {step: named, in: frame}
  a: {step: read, in: frame}
  b: {step: read, in: frame, when: "CONDITION"}
outputs: [b]
"""


class Named(NamedTuple):
    """Fields that are texts and lists."""

    word: str
    words: list[str]
    sizes: list[float]


def named(image: Image) -> Named:
    return Named("b", ["b"], [1.0])


def nested(folder: Path, levels: int, uses: int = 1) -> Path:
    """Write pipelines that use each the next one, and return the outermost's file."""
    (folder / "p0.yaml").write_text(LEAF.replace("leaf", "p0"))
    for n in range(1, levels + 1):
        nodes = "".join(f"  n{k}: {{use: p{n - 1}.yaml, in: frame}}\n" for k in range(uses))
        text = f"pipeline: p{n}\nnodes:\n{nodes}outputs: [n0]\n"
        (folder / f"p{n}.yaml").write_text(text)
    return folder / f"p{levels}.yaml"


@pytest.fixture
def read_files(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Return the files that are read."""
    read: list[Path] = []
    text = module.text_of_file

    def noted(path: Path, **how: bool) -> str:
        read.append(path)
        return text(path, **how)

    monkeypatch.setattr(module, "text_of_file", noted)
    return read


def test_a_pipeline_used_many_times_is_read_once(tmp_path: Path, read_files: list[Path]) -> None:
    pipeline = load(nested(tmp_path, 9, uses=2), registry())
    assert len(read_files) == 10
    assert len(pipeline.nodes) >= 2**9


def test_settings_of_one_use_are_not_those_of_another(tmp_path: Path) -> None:
    nested(tmp_path, 1)
    outer = tmp_path / "outer.yaml"
    outer.write_text(
        "pipeline: outer\nnodes:\n  m: {use: p0.yaml, in: frame, with: {a.tag: x}}\n"
        "  n: {use: p0.yaml, in: frame}\noutputs: [m, n]\n"
    )
    found: Any = load(outer, registry()).nodes
    assert [found[f"{k}/a"].settings.get("tag") for k in "mn"] == ["x", ""]


@pytest.mark.slow
def test_too_many_nodes_in_all_are_refused(tmp_path: Path, read_files: list[Path]) -> None:
    with pytest.raises(PipelineError, match=r"nodes with those of the pipelines it uses; allowed"):
        load(nested(tmp_path, 20, uses=2), registry())
    assert len(read_files) <= 21


@pytest.mark.slow
def test_a_pipeline_of_very_many_uses_is_refused_by_the_first(
    tmp_path: Path, read_files: list[Path]
) -> None:
    """Each use has settings of its own, and so is read anew."""
    nested(tmp_path, 1)
    uses = "".join(
        f"  m{k}: {{use: p0.yaml, in: frame, with: {{a.tag: x{k}}}}}\n" for k in range(1200)
    )
    outer = tmp_path / "outer.yaml"
    outer.write_text(f"pipeline: outer\nnodes:\n{uses}outputs: [m0]\n")
    with pytest.raises(UsageError, match=r"'outer', node 'm0': comes to 2400 nodes with those of"):
        load(outer, registry())
    assert len(read_files) == 2


@pytest.mark.skipif(not hasattr(yaml, "CSafeLoader"), reason="PyYAML is without libyaml here")
@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("a: {b: 1}\nl: [" + "1, " * 21_000 + "1]", "more than 20000 values"),
        ("".join(f"node_number_{k}: 1\n" for k in range(2001)), "a mapping of more than 2000 keys"),
    ],
    ids=["values", "keys"],
)
def test_a_long_text_of_too_many_values_is_never_composed(
    text: str, what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    composed: list[str] = []
    monkeypatch.setattr(document._composed, "__wrapped__", composed.append)
    with pytest.raises(PipelineError, match=what):
        loads(text, registry())
    assert composed == []


@pytest.mark.slow
def test_a_long_chain_of_pipelines_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PipelineError, match=r"pipelines use each other more than 50 deep"):
        load(nested(tmp_path, 150), registry())
    assert load(nested(tmp_path, 45), registry()).nodes


def test_a_file_without_an_end_is_refused(tmp_path: Path) -> None:
    endless = tmp_path / "endless.yaml"
    endless.symlink_to("/dev/zero")
    with pytest.raises(UsageError, match=r"is longer than 4000000 bytes"):
        load(endless, registry())


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_pipe_that_a_pipeline_names_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.yaml")
    outer = tmp_path / "outer.yaml"
    outer.write_text("pipeline: p\nnodes: {m: {use: pipe.yaml, in: frame}}\noutputs: [m]\n")
    with pytest.raises(PipelineError, match=r"pipe\.yaml' is a pipe; save what it gives as a file"):
        load(outer, registry())


def test_what_is_no_pipeline_file_is_not_shown(tmp_path: Path) -> None:
    secret = tmp_path / "secret.txt"
    secret.write_text("root:x:0:0\n")
    outer = tmp_path / "outer.yaml"
    outer.write_text(f"pipeline: p\nnodes: {{m: {{use: {secret}, in: frame}}}}\noutputs: [m]\n")
    with pytest.raises(PipelineError, match=r"a pipeline file ends in \.yaml") as told:
        load(outer, registry())
    assert "root:x" not in str(told.value)


@pytest.mark.parametrize(
    ("condition", "words"),
    [
        ("len([a] * 500000000) > 3", "arithmetic takes numbers, not a list"),
        ("'%1000000000d' % a == 'b'", "'%1000000000d' is a text"),
        ("len((1, 2) * a) > 3", "arithmetic takes numbers, not a list"),
        ("min('%1000000000d', 'b') % 1 == 'b' and a > 0", "'%1000000000d' is a text"),
        ("len(min(max(['b', 'c']), 'd') * 500000000) > a", "'b' is a text"),
        ("a in max([1], [2]) * 500000000", "arithmetic takes numbers, not a list"),
        ("a in max([[1], [2]]) * 500000000", "arithmetic takes numbers, not a list"),
        ("len((named.word or named.word) * 500000000) > a", "named.word is a text"),
        ("len(max(named.words) * 500000000) > a", "named.words is a text"),
        ("len(max(named.words, named.words) * 500000000) > a", "not a list"),
    ],
)
def test_a_condition_cannot_ask_for_all_memory(condition: str, words: str) -> None:
    text = WHEN.replace("CONDITION", condition)
    with pytest.raises(PipelineError) as told:
        loads(text, registry=registry({**STEPS, "named": named}))
    assert words in str(told.value)


def test_numbers_of_a_list_and_the_larger_of_two_can_be_reckoned_with() -> None:
    when = "max(named.sizes) * 2 + min(a, len(named.words)) % 3 >= -max([1, a])"
    assert loads(WHEN.replace("CONDITION", when), registry=registry({**STEPS, "named": named}))


@pytest.mark.slow
def test_of_thousands_of_mistakes_a_hundred_are_told() -> None:
    nodes = "".join(f"  n{i}: {{step: reed{i}, in: frame}}\n" for i in range(1900))
    with pytest.raises(PipelineError) as told:
        loads(f"pipeline: x\nnodes:\n{nodes}outputs: [n0]\n", registry=registry())
    assert 100 < len(told.value.problems) < 110
    assert "more than 100 mistakes" in str(told.value.problems[-1])


@pytest.mark.parametrize("value", ["!!float 1" + ":59" * 400, "0b" + "1" * 1100, "9" * 1100 + ".5"])
def test_a_number_that_is_too_long_is_not_worked_out(value: str) -> None:
    with pytest.raises(PipelineError, match=r"a number of \d+ characters; allowed are 1000"):
        loads(f"about: {value}\n{LEAF}", registry=registry())


def test_values_are_counted_while_they_come(monkeypatch: pytest.MonkeyPatch) -> None:
    counted: list[object] = []
    monkeypatch.setattr("tactile_graph.pipeline.document._measure", counted.append)
    monkeypatch.setattr("tactile_graph.pipeline.document.MOST_NODES", 200)
    with pytest.raises(PipelineError, match="more than 200 values"):
        loads(f"about: [{'1,' * 200}]\n{LEAF}", registry=registry())
    assert counted == []


def test_nothing_is_looked_up_that_is_near_a_very_long_name() -> None:
    with pytest.raises(PipelineError) as told:
        loads(LEAF.replace("read", "r" * 5_000), registry=registry())
    assert "did you mean" not in str(told.value)


@pytest.mark.parametrize(
    "text",
    [
        LEAF + "".join(f"k{i}: 1\n" for i in range(300)),
        LEAF.replace("[a]", f"[{','.join(f'x{i}' for i in range(300))}]"),
        LEAF.replace("{a:", "{" + "".join(f"n-{i}: {{step: read}}, " for i in range(300)) + "a:"),
    ],
)
def test_a_hundred_mistakes_of_any_kind_end_the_look_at_a_file(text: str) -> None:
    with pytest.raises(PipelineError, match="more than 100 mistakes") as told:
        loads(text, registry=registry())
    assert len(told.value.problems) == 101


def test_very_many_nodes_or_conditions_are_refused() -> None:
    nodes = "".join(f"  n{i}: {{}}\n" for i in range(2001))
    # With libyaml, and without.
    with pytest.raises(PipelineError, match=r":3:1: .* 2000 keys|: 2001 nodes; allowed are 2000"):
        loads(f"pipeline: x\nnodes:\n{nodes}outputs: [n0]\n", registry=registry())
    conditions = nodes.replace("{}", "a > 1")
    told = r":5:1: .* 2000 keys|: 2001 conditions; allowed are 2000"
    with pytest.raises(PipelineError, match=told):
        loads(f"{LEAF}conditions:\n{conditions}", registry=registry())


def test_conditions_that_double_with_each_name_end_soon() -> None:
    doubled = "".join(f"  c{i}: c{i + 1} and c{i + 1}\n" for i in range(12))
    with pytest.raises(PipelineError, match="longer than 2000 characters"):
        loads(f"{LEAF}conditions:\n{doubled}  c12: a > 1\n", registry=registry())
