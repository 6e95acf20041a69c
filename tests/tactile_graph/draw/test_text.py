"""The graph for mermaid and Graphviz: every node, every wire, nothing that breaks their syntax."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers_draw import branched, circle_demo, registry
from tactile_graph import Frame, Image, Mask, loads
from tactile_graph.draw.blocks import blocks, wires
from tactile_graph.draw.text import graph_dot, graph_mermaid

BOX = re.compile(r'    (n\d+)(?:\(\["([^"]*)"\]\)|\["([^"]*)"\])')
ARROW = re.compile(r'    (n\d+) (-->|-\.->)(?:\|"([^"]*)"\|)? (n\d+)')
CLASS = re.compile(r"    (?:classDef \w+ [\w:#,-]+|class n\d+(?:,n\d+)* \w+)")
ODD = """
pipeline: 'quote " and \\ back'
nodes:
  end: {step: 'odd"]step', in: frame, with: {text: 'a "b" \\ #35; `c` <br/> | \\N\\'}}
  graph: {step: area_of, in: end, when: end.count > 0}
outputs: [graph]
"""


def odd(image: Image, *, text: str = "") -> Mask:
    """Return a mask."""
    return image.mask(image.values > 0)


def area_of(mask: Mask) -> float:
    """Return an area."""
    return mask.area_cm2


def odd_pipeline():
    return loads(ODD, "odd.yaml", registry(**{'odd"]step': odd}, area_of=area_of))


MAKERS = [circle_demo, branched, odd_pipeline]


def read_mermaid(text: str) -> tuple[dict[str, str], list[tuple[str, str, str, str]]]:
    """Return boxes and arrows; fail on any line that is no mermaid."""
    first, *lines = text.splitlines()
    assert first == "flowchart LR"
    names: dict[str, str] = {}
    arrows = []
    for line in lines:
        if box := BOX.fullmatch(line):
            names[box[1]] = (box[2] or box[3]).split("<br/>")[0]
        elif arrow := ARROW.fullmatch(line):
            arrows.append((arrow[1], arrow[2], arrow[3] or "", arrow[4]))
        else:
            assert CLASS.fullmatch(line), f"no mermaid: {line}"
    return names, arrows


@pytest.mark.parametrize("make", MAKERS)
def test_mermaid_has_every_node_and_every_wire(make) -> None:
    pipeline = make()
    names, arrows = read_mermaid(graph_mermaid(pipeline))
    assert list(names.values()) == [b.title for b in blocks(pipeline)]
    titles = {b.key: b.title for b in blocks(pipeline)}
    styles = {"data": "-->", "guard": "-.->", "choice": "-.->"}
    assert [(names[a], style, names[b]) for a, style, _, b in arrows] == [
        (titles[w.start], styles[w.kind], titles[w.end]) for w in wires(pipeline)
    ]


def test_mermaid_numbers_choices_and_marks_outputs_and_what_is_new() -> None:
    text = graph_mermaid(branched(), {"dear"})
    labels = [label for _, _, label, _ in read_mermaid(text)[1]]
    assert [x for x in labels if x] == ["image", "mask", "items", "choice 1", "choice 2"]
    assert re.search(r"class n\d+ new", text)
    assert re.search(r"class n\d+,n\d+,n\d+ output", text)


def test_mermaid_writes_what_it_would_read_as_its_own_by_number() -> None:
    text = graph_mermaid(odd_pipeline())
    names, _ = read_mermaid(text)
    assert "end" in names.values()
    assert "text = a #34;b#34; #92; #35;35;" in text


@pytest.mark.slow
@pytest.mark.parametrize("make", MAKERS)
def test_dot_has_every_node_and_every_wire(make) -> None:
    pipeline = make()
    text = graph_dot(pipeline)
    for block in blocks(pipeline):
        assert f'    "{block.key}" [label="{block.title}' in text
    styles = {"data": "solid", "guard": "dashed", "choice": "dotted"}
    for wire in wires(pipeline):
        assert f'    "{wire.start}" -> "{wire.end}" [style={styles[wire.kind]}' in text
    assert text.count(" -> ") - text.count("→") == len(wires(pipeline))


def test_files_are_told_as_people_write_them() -> None:
    def read(*, path: list[Path]) -> Iterator[Frame]:
        """Give frames."""
        yield from ()

    text = "pipeline: p\nsource: {step: read, with: {path: [a.npz, b.npz]}}\n"
    text += "nodes: {a: {step: odd, in: frame}}\noutputs: [a]"
    source, *_ = blocks(loads(text, registry=registry(read=read, odd=odd)))
    assert source.settings == ("path = a.npz, b.npz",)


def test_dot_escapes_quotes_and_backslashes_and_thickens_what_is_new() -> None:
    text = graph_dot(odd_pipeline(), {"end"})
    assert text.startswith('digraph "quote \\" and \\\\ back" {\n')
    assert 'a \\"b\\" \\\\ #35;' in text
    assert re.search(r'"end" \[.*penwidth=4\]', text)


@pytest.mark.parametrize("make", MAKERS)
def test_graphviz_takes_it_and_finds_the_same_graph(make) -> None:
    program = shutil.which("dot")
    if program is None:
        pytest.skip("Graphviz is not installed")
    pipeline = make()
    done = subprocess.run(
        [program, "-Tplain"], input=graph_dot(pipeline), capture_output=True, text=True, check=True
    )
    assert not done.stderr
    lines = done.stdout.splitlines()
    assert sum(line.startswith("node ") for line in lines) == len(blocks(pipeline))
    assert sum(line.startswith("edge ") for line in lines) == len(wires(pipeline))
