"""Pipelines within pipelines: several inputs, and contacts that keep their masks."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame, Skip, load, loads
from tactile_graph.errors import PipelineError
from tactile_graph.pipeline.graph import FRAME
from tactile_graph.pipeline.idle import idle_settings
from tactile_graph.testing import isolated
from tactile_graph.wires import Image, Mask

INNER = """\
pipeline: inner
nodes:
  footprint: {step: threshold, in: frame, with: {level: 0.5}}
  opened: {step: open, in: footprint}
  load: {step: load, in: frame}
  found: {step: masked_sum, in: {image: frame, mask: opened}}
outputs: [found]
"""
OWN = """\
pipeline: own
nodes:
  found: {step: threshold, in: frame, with: {level: 0.5}}
  cells: {first_of: [frame.mask, found]}
  sum: {step: masked_sum, in: {image: frame, mask: cells}}
outputs: [sum]
"""
VALUES = np.zeros((8, 8))
VALUES[1:4, 1:4], VALUES[5:8, 4:8] = 2.0, 1.0
VALUES[1, 6] = 0.2


def masked_sum(image: Image, mask: Mask) -> float:
    """Return the sum of the readings of the cells that are on."""
    return float(image.values[mask.values].sum())


def wide(image: Image, *, least: int = 0) -> Mask:
    """Return all cells, or skip images of few."""
    if image.values.size < least:
        raise Skip("too few cells")
    return image.mask(np.ones(image.shape, bool))


def twice(image: Image) -> Image:
    """Return the image with doubled readings."""
    return image.with_values(2.0 * image.values)


def place(frame: Frame) -> str:
    """Return all that the frame has beside its readings."""
    names = [f.name for f in fields(Frame) if f.name not in ("image", "mask")]
    return " ".join(getattr(frame, name) for name in names)


def pair(image: Image) -> list[Image]:
    """Return the image twice."""
    return [image, image]


def made(tmp_path: Path, nodes: str, outputs: str = "u") -> Any:
    for name, text in (("inner", INNER), ("own", OWN)):
        (tmp_path / f"{name}.yaml").write_text(text)
    text = f"pipeline: p\nnodes:\n{nodes}\noutputs: [{outputs}]\n"
    steps = {"masked_sum": masked_sum, "wide": wide, "twice": twice}
    return loads(text, str(tmp_path / "p.yaml"), isolated(steps))


def run(tmp_path: Path, nodes: str, outputs: str = "u", frame: Frame | None = None) -> Any:
    return made(tmp_path, nodes, outputs).run(frame or Frame.of(VALUES, quantity="volt"))


ALL = "  all: {step: wide, in: frame}\n"
CONTACTS = """\
  touched: {step: threshold, in: frame, with: {level: 0.1}}
  objects: {step: contacts, in: [frame, touched], with: {connectivity: 4, margin: 1}}
"""


@pytest.mark.slow
def test_a_wired_value_takes_the_place_of_a_node_and_of_what_only_that_needs(
    tmp_path: Path,
) -> None:
    own = run(tmp_path, "  u: {use: inner.yaml}")
    assert own["u"] == pytest.approx(9 * 2.0)  # opening takes off what lies at the rim
    result = run(tmp_path, ALL + "  u: {use: inner.yaml, in: {opened: all}}")
    assert result["u"] == pytest.approx(VALUES.sum())
    assert "u/footprint" not in [e.node for e in result.explain()]
    both = "  u: {use: inner.yaml, in: {frame: doubled, opened: all}}"
    twice = "  doubled: {step: twice, in: frame}\n"
    result = run(tmp_path, ALL + twice + both)
    assert result["u"] == pytest.approx(2 * VALUES.sum())


def test_what_cannot_take_a_nodes_place_is_told_at_load(tmp_path: Path) -> None:
    for wrong, told in {
        "  u: {use: inner.yaml, in: {footprint: frame}}": "frame is a Frame, but stands for "
        "'footprint', a Mask",
        ALL + "  u: {use: inner.yaml, in: {opened: all}, with: {opened.element: square3}}": (
            "'opened' does not run: 'in' takes its place"
        ),
        ALL + "  u: {use: inner.yaml, in: {opened: all}, with: {footprint.level: 1}}": (
            "'footprint' does not run: nothing needs it here"
        ),
    }.items():
        with pytest.raises(PipelineError) as caught:
            made(tmp_path, wrong)
        assert told in str(caught.value)


def test_a_setting_from_outside_of_a_node_that_does_not_run_is_refused(tmp_path: Path) -> None:
    pipeline = made(tmp_path, ALL + "  u: {use: inner.yaml, in: {opened: all}}")
    for name, why in (("opened.element", "'in' takes its place"), ("footprint.level", "nothing")):
        told = f"setting u/{name}: '{name.partition('.')[0]}' does not run: {why}"
        with pytest.raises(PipelineError, match=told):
            pipeline.with_settings({f"u/{name}": "square3" if "element" in name else 1})


@pytest.mark.parametrize("more", ["", ", each: true"])
def test_no_node_is_left_that_reads_one_that_is_gone(tmp_path: Path, more: str) -> None:
    left = "  idle: {step: open, in: footprint}\n  idler: {step: open, in: idle}\noutputs"
    (tmp_path / "left.yaml").write_text(INNER.replace("outputs", left))
    nodes = CONTACTS + ALL + "  masks: {step: wide, in: objects.contacts, each: true}\n"
    given = "masks" if more else "all"
    nodes += f"  u: {{use: left.yaml, in: {{opened: {given}}}{more}}}"
    pipeline = made(tmp_path, nodes)
    inner = pipeline.nodes["u"].inner or pipeline
    assert all(r.node in {FRAME, *inner.nodes} for n in inner.nodes.values() for r in n.wires())
    assert [n for n in inner.nodes if n.endswith(("footprint", "idle", "idler"))] == []
    assert any(n.endswith("load") for n in inner.nodes)  # it reads nothing that is gone


@pytest.mark.slow
def test_settings_of_nodes_that_nothing_needs_are_known(tmp_path: Path) -> None:
    nodes = (
        CONTACTS + "  u: {use: inner.yaml}\n  v: {use: own.yaml, in: objects.contacts, each: true}"
    )
    names = ["touched.level", "u/opened.element", "v/found.level", "objects.margin"]
    for outputs, idle in {"u": [names[0], *names[2:]], "v": names[1:2], "u, v": []}.items():
        assert idle_settings(made(tmp_path, nodes, outputs), names) == idle


@pytest.mark.parametrize("more", ["", ", in: objects.contacts, each: true"])
def test_two_outputs_that_would_have_one_name_are_told(tmp_path: Path, more: str) -> None:
    both = OWN.replace("outputs: [sum]", "  cells_count: {step: load, in: frame}\n")
    (tmp_path / "both.yaml").write_text(
        both + "outputs: [cells_count, found, found.count, cells.count]"
    )
    nodes = f"  u: {{use: both.yaml{more}}}"
    told = r"outputs 'cells_count' and 'cells.count' of .* would both be u.cells_count here"
    with pytest.raises(PipelineError, match=told):
        made(tmp_path, CONTACTS + nodes, "u.found")


def test_a_pipeline_runs_for_each_item_of_several_lists(tmp_path: Path) -> None:
    nodes = CONTACTS + (
        "  masks: {step: wide, in: objects.contacts, each: true, with: {least: 20}}\n"
        "  u: {use: inner.yaml, each: true, in: {frame: objects.contacts, opened: masks}}"
    )
    result = run(tmp_path, nodes)
    first, small, last = result["u"]
    assert (first, last) == (pytest.approx(18.0), pytest.approx(12.0))
    assert small.reason == "too few cells"


def test_one_frame_may_serve_all_items(tmp_path: Path) -> None:
    nodes = CONTACTS + (
        "  masks: {step: wide, in: objects.contacts, each: true}\n"
        "  u: {use: inner.yaml, each: true, in: {frame: frame, opened: masks}}"
    )
    frame = Frame.of(VALUES, quantity="volt")
    failed = run(tmp_path, nodes, frame=frame).outcome("u")  # masks of boxes on the whole frame
    assert "boolean index did not match" in str(failed.error)


def test_a_contact_keeps_its_mask_as_the_inner_frame(tmp_path: Path) -> None:
    result = run(tmp_path, CONTACTS + "  u: {use: own.yaml, in: objects.contacts, each: true}")
    assert result["u"] == (pytest.approx(18.0), pytest.approx(0.2), pytest.approx(12.0))
    inner = result.inner["u"][1]
    assert isinstance(inner.frame.mask, Mask)
    assert inner.frame.mask.count == 1
    assert inner.outcome("found").reason == "nothing asked for it"  # it has a mask already


def test_the_frame_of_an_item_has_all_else_of_the_frame_that_is_under_way(tmp_path: Path) -> None:
    text = """
pipeline: inner
nodes:
  place: {step: place, in: frame}
  sure: {step: place, in: frame, when: not frame.doubtful}
outputs: [place, sure]
"""
    (tmp_path / "inner.yaml").write_text(text)
    text = """
pipeline: p
nodes:
  once: {use: inner.yaml, in: frame}
  pair: {step: pair, in: frame}
  each: {use: inner.yaml, in: pair, each: true}
outputs: [once.place, once.sure, each.place, each.sure]
"""
    its: dict[str, Any] = {f.name: f.name for f in fields(Frame) if f.name not in ("image", "mask")}
    registry = isolated({"place": place, "pair": pair})
    result = loads(text, str(tmp_path / "p.yaml"), registry).run(Frame(Image(VALUES), **its))
    assert result["each.place"] == (result["once.place"],) * 2 == (" ".join(its),) * 2
    assert "each.sure" not in result
    assert "once.sure" not in result


def test_a_frame_that_is_whole_has_none_so_the_pipeline_finds_its_own(tmp_path: Path) -> None:
    made(tmp_path, ALL, "all")
    result = load(tmp_path / "own.yaml", isolated({"masked_sum": masked_sum})).run(
        Frame.of(VALUES, quantity="volt")
    )
    assert result["sum"] == pytest.approx(30.0)


def test_a_single_contact_gives_its_mask_where_the_pipeline_is_put_in_once(tmp_path: Path) -> None:
    nodes = CONTACTS + (
        "  second: {step: pick_contact, in: objects.contacts, with: {rank: 3, by: peak}}\n"
        "  u: {use: own.yaml, in: second}"
    )
    assert run(tmp_path, nodes)["u"] == pytest.approx(0.2)


def test_equal_images_with_other_masks_are_not_taken_for_each_other(tmp_path: Path) -> None:
    values = np.ones((2, 4))
    nodes = (
        "  parts: {step: halves, in: frame}\n"
        "  u: {use: inner.yaml, each: true, in: {frame: frame, opened: parts}}"
    )

    def halves(image: Image) -> list[Mask]:
        """Return the left half, and the left three quarters."""
        return [image.mask(np.arange(4)[None] < n + np.zeros((2, 1))) for n in (2, 3)]

    (tmp_path / "inner.yaml").write_text(INNER)
    registry = isolated({"masked_sum": masked_sum, "halves": halves})
    text = f"pipeline: p\nnodes:\n{nodes}\noutputs: [u]\n"
    runner = loads(text, str(tmp_path / "p.yaml"), registry).runner()
    for _ in range(2):
        assert runner(Frame.of(values, quantity="volt"))["u"] == (4.0, 6.0)
