"""Shipped pipelines come to the same in blocks as frame by frame, whatever comes."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_blocks import assert_blocks_are_frames
from tactile_graph import Frame, load
from tactile_graph.engine.blocks.stacked import stacked_form
from tactile_graph.plugins.registry import installed

N = 60


def strange_frames(quantity: str, shape: tuple[int, int] = (16, 16)) -> list[Frame]:
    """Return frames of discs, noise, nothing, all, holes, repeats and absurd values."""
    rng = np.random.default_rng(7)
    rows, columns = np.indices(shape)
    frames = []
    for i in range(N):
        radius = rng.uniform(0.0, 7.0)
        y, x = rng.uniform(0, shape[0]), rng.uniform(0, shape[1])
        values = 0.3 * (np.hypot(rows - y, columns - x) < radius)
        values = values + rng.normal(0.0, 1e-3, shape)
        kind = i % 12
        if kind == 3:
            values = np.zeros(shape)
        elif kind == 4:
            values[:] = 1.0
        elif kind == 5:
            values *= 1e99
        elif kind == 6:
            values = rng.random(shape)
        elif kind == 7:
            values[rng.random(shape) < 0.2] = np.nan
        elif kind == 8:
            values[:] = np.nan
        elif kind == 9:
            values = -values
        elif kind == 10:
            values = np.where(rng.random(shape) < 0.01, 1.0, 0.0)
        frames.append(Frame.of(values, 1.3, (-0.15, 0.2), quantity, index=i, time_s=0.1 * i))
    again = [frames[3], frames[3], frames[0], frames[0], *frames[20:24], *frames[20:24]]
    return [f.with_index(i) for i, f in enumerate([*frames, *again])]


def test_every_node_of_the_circles_answers_many_frames_at_once() -> None:
    for name in ("circle-1", "circle-2", "circle-3"):
        nodes = load(name).runner().plan.nodes
        assert [i.name for i in nodes if stacked_form(i.node) is None] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["circle-1", "circle-2", "circle-3"])
@pytest.mark.parametrize("shape", [(16, 16), (5, 9), (33, 40), (1, 1)])
@pytest.mark.parametrize("quantity", ["volt", "raw"])
def test_circles_come_to_the_same(
    name: str, shape: tuple[int, int], quantity: str, warm_kernels: None
) -> None:
    assert_blocks_are_frames(load(name), strange_frames(quantity, shape), size=50)


@pytest.mark.slow
@pytest.mark.parametrize("name", installed().names("pipelines"))
def test_every_pipeline_comes_to_the_same(name: str, warm_kernels: None) -> None:
    pipeline = load(name)
    if not pipeline.runner().in_blocks:
        pytest.skip("none of its steps answers many frames at once")
    frames = [f for f in strange_frames("volt") if np.abs(f.image.values).max() < 1e6][:20]
    everything = tuple(pipeline.nodes)
    assert_blocks_are_frames(pipeline, frames, size=20, only=everything)


def test_the_circles_come_to_the_same_in_plain_code(plain_kernels: None) -> None:
    assert_blocks_are_frames(load("circle-3"), strange_frames("volt", (6, 7))[:14], size=14)
