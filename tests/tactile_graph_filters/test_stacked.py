"""Masks of several frames at once are those of one after the other, also where rows are words."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_filters import ELEMENTS, image_of, random_mask
from tactile_graph.errors import DataError, Degenerate
from tactile_graph.testing.same import same
from tactile_graph.wires.stacks import ImageStack, MaskStack
from tactile_graph_filters.morphology.close import Close
from tactile_graph_filters.morphology.dilate import Dilate
from tactile_graph_filters.morphology.elements import parse_element
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_filters.morphology.erosion import make_plan
from tactile_graph_filters.morphology.open import Open
from tactile_graph_filters.morphology.packed import combined, doubled
from tactile_graph_filters.morphology.subdivide import subdivide, subdivide_stacked
from tactile_graph_filters.thresholds.threshold import Threshold

pytestmark = pytest.mark.usefixtures("plain_kernels")

WIDTHS = (1, 5, 31, 32, 33, 64, 65)
"""Around half a word and a whole one."""


def three(columns: int, share: float = 0.7) -> list:
    return [random_mask(seed, (6, columns), share) for seed in range(3)]


def assert_same(stack: MaskStack, masks: list) -> None:
    assert len(stack) == len(masks)
    for k, mask in enumerate(masks):
        found = stack[k]
        assert np.array_equal(found.values, mask.values)
        assert found.count == stack.counts[k] == int(mask.values.sum())
        assert (found.pitch_cm, found.origin_cm) == (mask.pitch_cm, mask.origin_cm)


@pytest.mark.parametrize("columns", WIDTHS)
@pytest.mark.parametrize("factor", [1, 2, 3])
def test_cells_cut_finer(columns, factor):
    masks = three(columns)
    found = subdivide_stacked(MaskStack.of(masks), factor=factor)
    assert_same(found, [subdivide(mask, factor=factor) for mask in masks])


@pytest.mark.parametrize("element", ELEMENTS, ids=str)
@pytest.mark.parametrize("columns", [5, 33, 64, 65])
@pytest.mark.parametrize("border", [False, True])
def test_eroded_and_dilated(element, columns, border):
    for step, share in ((Erode, 0.9), (Dilate, 0.1)):
        masks = three(columns, share)
        each = step(element=element, border=border)
        assert_same(each.stacked(MaskStack.of(masks)), [each(mask) for mask in masks])


@pytest.mark.parametrize("columns", [33, 65])
@pytest.mark.parametrize("element", ["disc5", [[1, 0, 0]]], ids=str)
def test_opened_and_closed(element, columns):
    for step in (Open, Close):
        masks = three(columns)
        each = step(element=element)
        assert_same(each.stacked(MaskStack.of(masks)), [each(mask) for mask in masks])


def test_a_word_is_doubled_bit_by_bit():
    words = np.random.default_rng(1).integers(0, 1 << 32, 50, dtype=np.uint64)
    for word, twice in zip(words.tolist(), doubled(words).tolist(), strict=True):
        assert twice == sum((word >> k & 1) * 0b11 << 2 * k for k in range(32))
    assert doubled(np.array([(1 << 32) - 1], np.uint64)).tolist() == [(1 << 64) - 1]


def test_rows_or_elements_wider_than_a_word_are_left_to_cells():
    wide = parse_element([[1] + [0] * 128])
    assert wide.reach[1] == 64
    assert combined(MaskStack.of(three(5)), wide, dilate=False) is None
    assert combined(MaskStack.of(three(65)), parse_element("cross3"), dilate=False) is None
    fits = combined(MaskStack.of(three(64)), parse_element([[1] + [0] * 126]), dilate=True)
    assert fits is not None


def test_a_step_that_turns_all_cells_over_reads_no_other_plane():
    plan = make_plan(parse_element("square3"), parse_element("square3"))
    turned = plan[plan[:, 1] < 0]
    assert turned[:, 1:].tolist() == [[-1, 0, 0, 0, 0, 0]]


@pytest.mark.parametrize("quantity", ["volt", "gram"])
@pytest.mark.parametrize("settings", [{"level_v": 0.5}, {"level": 0.5}], ids=str)
def test_levels_of_frames_are_those_of_each(settings, quantity):
    """A level in volts alone says nothing of grams: those frames are left to the step."""
    values = np.random.default_rng(3).random((3, 4, 5))
    images = [image_of(each, quantity) for each in values]
    found = Threshold(**settings).stacked(ImageStack.of(images))
    if quantity == "gram" and "level_v" in settings:
        assert found is NotImplemented
    else:
        assert found.done.all()
        assert_same(found.values, [Threshold(**settings)(image) for image in images])


def strange_values(shape: tuple[int, int], dtype: str) -> np.ndarray:
    """Return frames of noise, loads, nothing, one value, steps, dead cells and dead lines."""
    rng = np.random.default_rng(5)
    values = rng.normal(20.0, 2.0, (24, *shape))
    values[::2, : shape[0] // 2, : shape[1] // 2] += rng.uniform(0.0, 60.0, (12, 1, 1))
    values[4] = 0.0
    values[5:7] = 7.0
    values[8:10] = np.round(values[8:10])
    values[10:12] = np.maximum(values[10:12], 20.0)
    values[12, rng.random(shape) < 0.1] = 1.0
    values[13, 0], values[14, :, -1] = 3.0, 20.0
    values[15, rng.random(shape) < 0.02] = 60.0
    values = values.clip(0, 120).astype(dtype)
    if values.dtype.kind == "f":
        values[16, 0, 0], values[17, 0, 0], values[18] = np.nan, np.inf, 1e36
    return values


@pytest.mark.slow
@pytest.mark.parametrize("dtype", ["f8", "f4", "i2", "u1"])
@pytest.mark.parametrize("shape", [(16, 16), (5, 9), (3, 3), (1, 4), (1, 1)])
@pytest.mark.parametrize("holes", [False, True])
def test_levels_above_each_frame_s_noise_are_those_of_each(dtype, shape, holes):
    values = strange_values(shape, dtype)
    valid = np.random.default_rng(9).random(values.shape) < 0.8 if holes else None
    if valid is not None:
        valid[19] = False
    stack = ImageStack(values, (0.5, 0.4), (0.1, 0.2), "gram", valid)
    step = Threshold(level_v=0.5, level="auto")
    found = step.stacked(stack)
    for k, image in enumerate(stack):
        try:
            expected = step(image)
        except (Degenerate, DataError):
            assert not found.done[k]
        else:
            assert found.done[k]
            assert same(found.values[k], expected)
            assert found.values[k].count == expected.count
            assert found.values[k].assumed == expected.assumed
    rows = np.flatnonzero(found.done)
    some = found.values.take(rows)
    assert all(map(same, some, [step(stack[i]) for i in rows.tolist()]))
    assert same([*some.field("level")], [mask.level for mask in some])
    assert same([*some.field("count")], [mask.count for mask in some])


@pytest.mark.slow
def test_the_level_of_a_recording_is_told_by_stacks(tmp_path):
    noise = np.random.default_rng(2).normal(5.0, 1.0, (30, 8, 8))
    np.savez(tmp_path / "noise.npz", frames=noise, pitch_cm=1.0, quantity="gram")
    step = Threshold(level="auto", noise_of=tmp_path / "noise.npz")
    stack = ImageStack(strange_values((8, 8), "f8")[:16], quantity="gram")
    found = step.stacked(stack)
    assert found.done.all()
    assert all(map(same, found.values, map(step, stack)))
    assert found.values[0].above != Threshold(level="auto")(stack[0]).above
    of_volts = ImageStack(noise[:4], quantity="volt")
    assert step.stacked(of_volts) is NotImplemented
