"""Rules about quantity and grid that only a frame can settle are settled by the first one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pytest
from annotated_types import Ge

from helpers_graphs import registry
from tactile_graph import Frame, Image, Mask, Pipeline, loads
from tactile_graph.errors import PipelineError, RuleError
from tactile_graph.steps import Grid, Quantity
from tactile_graph.steps.rules import require_square


def volts(
    image: Annotated[Image, Quantity("volt", "counts")],
) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    return image


def level(
    image: Image, *, level_v: Annotated[float | None, Quantity("volt", of="image")] = None
) -> Annotated[Mask, Grid.like("image")]:
    return image.mask(image.values > (level_v or 0.0))


def finer(
    mask: Mask, *, factor: Annotated[int, Ge(1)] = 2
) -> Annotated[Mask, Grid.like("mask", finer_by="factor")]:
    x_cm, y_cm = mask.pitch_cm
    return Mask(mask.values.repeat(factor, 0).repeat(factor, 1), (x_cm / factor, y_cm / factor))


def sixteen(image: Annotated[Image, Grid(rows=16, columns=16)]) -> int:
    return 16


def thirty_two(mask: Annotated[Mask, Grid(rows=32)]) -> int:
    return 32


def three(image: Annotated[Image, Grid(min_rows=3, min_columns=2)]) -> int:
    return 3


def pitched(image: Annotated[Image, Grid(pitch_cm=1.3)]) -> int:
    return 1


def nearly_square(image: Annotated[Image, Grid(square_to=0.03)]) -> int:
    return 1


def exactly_square(image: Annotated[Image, Grid(square_to=0.0)]) -> int:
    require_square(image)
    return 1


def simulated() -> Iterator[Annotated[Frame, Quantity("volt")]]:
    yield Frame.of(np.ones((16, 16)), quantity="volt")


REGISTRY = {
    f.__name__: f
    for f in (volts, level, finer, sixteen, thirty_two, three, pitched, nearly_square,
              exactly_square, simulated)
}  # fmt: skip


def one(nodes: str, rest: str = "", pipelines: dict[str, Path] | None = None) -> Pipeline:
    last = nodes.rpartition("\n")[2].partition(":")[0].strip()
    body = "\n".join(f"  {line.strip()}" for line in nodes.splitlines())
    text = f"pipeline: p\n{rest}\nnodes:\n{body}\noutputs: [{last}]\n"
    return loads(text, "p.yaml", registry(REGISTRY, pipelines))


def frame(shape: tuple[int, int] = (16, 16), pitch: float = 1.3, quantity: str = "volt") -> Frame:
    return Frame.of(np.ones(shape), pitch, quantity=quantity)


@pytest.mark.parametrize(
    ("nodes", "frame", "message"),
    [
        (
            "x: {step: volts, in: frame}",
            frame(quantity="gram"),
            "pipeline 'p', node 'x': step 'volts' takes volt or counts at port 'image', got a",
        ),
        (
            "x: {step: level, in: frame, with: {level_v: 1.0}}",
            frame(quantity="counts"),
            "setting 'level_v' of step 'level' takes volt at port 'image', got a frame of counts",
        ),
        (
            "v: {step: volts, in: frame}\nx: {step: level, in: v, with: {level_v: 1.0}}",
            frame(quantity="counts"),
            "node 'x': setting 'level_v' .* got a frame of counts",
        ),
        (
            "x: {step: sixteen, in: frame}",
            frame((16, 15)),
            "step 'sixteen' takes 16 x 16 cells, got a frame of 16 x 15",
        ),
        (
            "m: {step: level, in: frame}\nf: {step: finer, in: m}\nx: {step: thirty_two, in: f}",
            frame((15, 16)),
            "step 'thirty_two' takes 16 x any cells, got a frame of 15 x 16",
        ),
        (
            "x: {step: three, in: frame}",
            frame((2, 5)),
            "step 'three' takes at least 3 x 2 cells, got a frame of 2 x 5",
        ),
        (
            "x: {step: pitched, in: frame}",
            frame(pitch=1.2),
            r"step 'pitched' takes a pitch of 1.3 cm, got a frame of \(1.2, 1.2\) cm",
        ),
        (
            "x: {step: nearly_square, in: frame}",
            Frame.of(np.ones((3, 4)), (1.0, 2.0)),
            "'nearly_square' takes cells that are square to 3%, got a frame with a pitch of 1 by 2",
        ),
        (
            "x: {step: exactly_square, in: frame}",
            Frame.of(np.ones((3, 4)), (1.02, 1.0)),
            "step 'exactly_square' takes square cells, got a frame with a pitch of 1.02 by 1 cm",
        ),
    ],
    ids=range(9),
)
def test_the_first_frame_that_breaks_a_rule_is_refused(
    nodes: str, frame: Frame, message: str
) -> None:
    pipeline = one(nodes)
    with pytest.raises(RuleError, match=message):
        pipeline.run(frame)


@pytest.mark.parametrize(
    ("nodes", "outputs"),
    [
        ("s: {step: three, in: frame}\n  x: {step: exactly_square, in: frame}", "s, x"),
        (
            "s: {step: three, in: frame}\n  x: {step: exactly_square, in: frame}\n"
            "  c: {first_of: [x, s]}",
            "c",
        ),
    ],
)
def test_what_is_left_where_a_step_takes_square_cells_runs(nodes: str, outputs: str) -> None:
    pipeline = loads(f"pipeline: p\nnodes:\n  {nodes}\noutputs: [{outputs}]\n", "p.yaml",
                     registry(REGISTRY))  # fmt: skip
    wide = Frame.of(np.ones((3, 4)), (1.0, 2.0))
    assert pipeline.run(wide)[outputs[0]] == 3
    assert pipeline.run(Frame.of(np.ones((3, 4)), (1.0, 1.0))).ok


def test_where_every_output_needs_square_cells_one_frame_is_refused() -> None:
    text = (
        "pipeline: p\nnodes:\n  x: {step: exactly_square, in: frame}\n"
        "  y: {step: nearly_square, in: frame}\n  c: {first_of: [x, y]}\noutputs: [c, y]\n"
    )
    pipeline = loads(text, "p.yaml", registry(REGISTRY))
    assert pipeline.run(Frame.of(np.ones((3, 4)), (1.0, 1.02)))["c"] == 1
    with pytest.raises(RuleError, match="'nearly_square' takes cells that are square to 3%"):
        pipeline.run(Frame.of(np.ones((3, 4)), (1.0, 2.0)))


def test_a_frame_that_keeps_the_rules_runs() -> None:
    nodes = "m: {step: level, in: frame, with: {level_v: 0.5}}\nf: {step: finer, in: m}"
    assert one(f"{nodes}\nx: {{step: thirty_two, in: f}}").run(frame())["x"] == 32
    assert one("x: {step: level, in: frame}").run(frame(quantity="counts")).ok
    assert one("x: {step: nearly_square, in: frame}").run(Frame.of(np.ones((3, 4)), (1.02, 1.0))).ok


def test_a_setting_that_is_not_given_demands_nothing() -> None:
    nodes = "x: {step: level, in: frame, with: {level_v: null}}"
    assert one(nodes).run(frame(quantity="counts")).ok


def test_rules_hold_for_each_frame_of_a_stream() -> None:
    runner = one("x: {step: sixteen, in: frame}").runner()
    assert runner(frame()).ok
    with pytest.raises(RuleError, match=r"got a frame of 4 x 4"):
        runner(frame((4, 4)))
    with pytest.raises(RuleError, match=r"got a frame of 4 x 4"):
        runner(frame((4, 4)))


def test_rules_of_nodes_nobody_asked_for_are_left_alone() -> None:
    p = one("y: {step: sixteen, in: frame}\nx: {step: level, in: frame}")
    assert p.run(frame((4, 4))).ok


def test_a_source_that_names_its_quantity_does_not_vouch_for_other_frames() -> None:
    nodes = "x: {step: level, in: frame, with: {level_v: 0.5}}"
    p = one(nodes, "source: {step: simulated}")
    assert next(p.stream()).ok
    with pytest.raises(RuleError, match=r"'level_v' .* takes volt .* got a frame of counts"):
        p.run(frame(quantity="counts"))


def inner(tmp_path: Path, source: str = "") -> dict[str, Path]:
    path = tmp_path / "inner.yaml"
    path.write_text(
        f"pipeline: inner\n{source}\nnodes:\n"
        "  m: {step: level, in: frame, with: {level_v: 0.5}}\n"
        "  s: {step: sixteen, in: frame}\noutputs: [m, s]\n"
    )
    return {"inner": path}


@pytest.mark.parametrize("source", ["", "source: {step: simulated}"])
def test_rules_inside_a_used_pipeline_hold_for_the_outer_frames(
    tmp_path: Path, source: str
) -> None:
    p = one("u: {use: inner}\nx: {step: finer, in: u.m}", pipelines=inner(tmp_path, source))
    assert p.run(frame()).ok
    with pytest.raises(RuleError, match=r"node 'u/m': setting 'level_v' .* got a frame of counts"):
        p.run(frame(quantity="counts"))
    with pytest.raises(
        RuleError, match=r"node 'u/s': step 'sixteen' takes 16 x 16 cells, got a fra"
    ):
        p.run(frame((4, 4)), only=["u.s"])


def test_a_used_pipeline_is_checked_against_the_outer_source(tmp_path: Path) -> None:
    def counted() -> Iterator[Annotated[Frame, Quantity("counts")]]:
        yield frame(quantity="counts")

    text = "pipeline: p\nsource: {step: counted}\nnodes: {u: {use: inner}}\noutputs: [u.m]\n"
    found = registry({**REGISTRY, "counted": counted}, inner(tmp_path, "source: {step: simulated}"))
    with pytest.raises(PipelineError, match=r"u/m: setting 'level_v' .* takes volt .* got counts"):
        loads(text, "p.yaml", found)


def test_what_a_used_pipeline_gives_keeps_its_grid(tmp_path: Path) -> None:
    def same(a: Mask, b: Annotated[Mask, Grid.like("a")]) -> Mask:
        return a

    nodes = "nodes: {u: {use: inner}, f: {step: finer, in: u.m}, x: {step: same, in: [u.m, f]}}"
    found = registry({**REGISTRY, "same": same}, inner(tmp_path))
    with pytest.raises(
        PipelineError, match=r"needs 'b' on the same grid as 'a', but its cells are 0.5"
    ):
        loads(f"pipeline: p\n{nodes}\noutputs: [x]\n", "p.yaml", found)


def test_a_frame_that_is_no_matrix_is_refused() -> None:
    bad: Any = Frame(Image(np.zeros((0, 3))))
    with pytest.raises(
        RuleError, match=r"a frame holds values of shape \(rows, columns\), got \(0, 3"
    ):
        one("x: {step: level, in: frame}").run(bad)
