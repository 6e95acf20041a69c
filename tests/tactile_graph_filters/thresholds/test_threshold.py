import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import references_filters as references
from helpers_filters import image_of, same_grid
from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph.wires import Image
from tactile_graph.wires.stacks import ImageStack
from tactile_graph_filters.thresholds.levelled_masks import LevelledMaskStack
from tactile_graph_filters.thresholds.threshold import (
    Threshold,
    any_at_least,
    at_least,
    footprint,
    footprints,
)

VALUES = [[0.0, 0.01, 0.02], [-1.0, 5.0, 0.009]]


def test_cells_at_or_above_the_level_are_on():
    image = image_of(VALUES)
    mask = Threshold(level_v=0.01)(image)
    assert mask.values.tolist() == [[False, True, True], [False, True, False]]
    assert same_grid(image, mask)
    assert not mask.values.flags.writeable


def test_above_asks_to_exceed_the_level():
    mask = Threshold(level_v=0.01, above=True)(image_of(VALUES))
    assert mask.values.tolist() == [[False, False, True], [False, True, False]]
    assert Threshold(level=0.0, above=True)(image_of([[0.0, 5e-324]])).values.tolist() == [
        [False, True]
    ]


def test_level_is_in_the_images_own_unit():
    counts = image_of([[24, 25, 26]], "counts")
    assert Threshold(level=25)(counts).values.tolist() == [[False, True, True]]


def test_images_of_whole_numbers_are_taken():
    image = Image(np.array([[1, 2], [3, 4]], np.int16), quantity="counts")
    assert Threshold(level=2.5)(image).values.tolist() == [[False, False], [True, True]]


def test_invalid_cells_are_never_on():
    image = image_of([[0.0, 3.0, 3.0]], valid=[[False, False, True]])
    assert Threshold(level=-1.0)(image).values.tolist() == [[False, False, True]]


def test_an_image_without_a_valid_cell_is_degenerate():
    image = image_of([[0.0, 0.0]], valid=[[False, False]])
    with pytest.raises(Degenerate, match="no cell of the image is valid, so it has no footprint"):
        Threshold(level=1.0)(image)


def test_nan_in_a_valid_cell_is_never_silently_off():
    image = image_of([[1.0, 2.0], [math.nan, math.nan]])
    with pytest.raises(DataError, match=r"row 1, column 0: must be a number, got nan \(and 1 more"):
        Threshold(level=1.0)(image)


def test_nan_in_an_invalid_cell_does_no_harm():
    image = image_of([[math.nan, 2.0]], valid=[[False, True]])
    assert Threshold(level=1.0)(image).values.tolist() == [[False, True]]


def test_infinity_is_above_every_level():
    assert Threshold(level=1.0)(image_of([[math.inf, -math.inf]])).values.tolist() == [
        [True, False]
    ]


def test_a_pad_that_stays_empty_gives_the_same_mask_until_something_lies_there_again():
    step = Threshold(level=1.0)
    empty = [step(image_of(np.full((3, 4), 0.1 * i))) for i in range(3)]
    assert empty[0] is empty[1] is empty[2]
    assert empty[0].count == 0
    assert step(image_of(np.eye(3, 4))).values.tolist() == np.eye(3, 4, dtype=bool).tolist()
    assert step(image_of(np.zeros((3, 4)))).count == 0


def test_an_empty_mask_lies_on_the_grid_of_its_own_image():
    step = Threshold(level=1.0)
    for image in (
        Image(np.zeros((3, 4))),
        Image(np.zeros((4, 3))),
        Image(np.zeros((4, 3)), (0.5, 1.0)),
        Image(np.zeros((4, 3)), (0.5, 1.0), (2.0, 0.0)),
    ):
        assert same_grid(step(image), image)


def test_what_comes_after_an_empty_pad_is_looked_at_in_full():
    step = Threshold(level=1.0)
    step(Image(np.zeros((2, 2))))
    valid = np.array([[True, True], [True, False]])
    assert step(Image(np.array([[0.0, 2.0], [0.0, 2.0]]), valid=valid)).count == 1
    step(Image(np.zeros((2, 2))))
    with pytest.raises(DataError, match="row 0, column 1: must be a number, got nan"):
        step(Image(np.array([[0.0, math.nan], [0.0, 0.0]])))
    step(Image(np.zeros((2, 2))))
    with pytest.raises(Degenerate):
        step(Image(np.zeros((2, 2)), valid=np.zeros((2, 2), bool)))


@pytest.mark.parametrize("odd", [math.inf, -math.inf])
def test_infinity_is_no_reading_that_noise_is_told_by(odd):
    values = np.random.default_rng(0).normal(0.0, 1.0, (9, 9))
    values[3:6, 3:6] += 200.0
    values[4, 2] = odd
    with pytest.raises(DataError, match=f"row 4, column 2: must be a number, got {odd}"):
        Threshold(level="auto")(Image(values))
    bad = np.zeros((9, 9), bool)
    bad[4, 2] = True
    assert Threshold(level="auto")(Image(values, valid=~bad)).count == 9


@pytest.mark.parametrize("number", [0.5, 1.0, math.inf, math.nan, -math.inf])
def test_any_at_least_plain_and_compiled(number):
    values = np.array([[0.0, 0.5], [number, 0.0]])
    expected = not number < 1.0
    assert any_at_least.loops(values, 1.0) == any_at_least.compiled(values, 1.0) == expected


def test_a_level_must_be_given():
    with pytest.raises(ValueError, match="level_v or level must be given, got neither"):
        Threshold()


def test_of_both_levels_one_is_for_volts_and_one_for_all_else():
    values = np.array([[0.5, 2.0]])
    step = Threshold(level_v=1.0, level=0.1)
    assert step(Image(values, quantity="volt")).count == 1
    assert step(Image(values, quantity="counts")).count == 2


def test_a_level_in_volts_alone_is_for_volts():
    with pytest.raises(RuleError, match="level_v is for images in volt, got gram"):
        Threshold(level_v=1.0)(Image(np.ones((1, 2)), quantity="gram"))


def test_auto_finds_what_stands_out_of_the_noise_and_says_the_level():
    rng = np.random.default_rng(2)
    values = 700.0 + rng.normal(0.0, 3.0, (20, 30))
    values[4:9, 5:12] += 400.0
    mask = Threshold(level="auto")(Image(values, quantity="counts"))
    assert mask.count == 35
    assert 715.0 < mask.level < 760.0
    assert (
        mask.assumed
        == f"cells from {mask.level:.4g} counts on, which is above the frame's own noise"
    )
    again = pickle.loads(pickle.dumps(mask))
    assert (again.level, again.quantity, again.count) == (mask.level, "counts", 35)
    shifted = Threshold(level="auto")(Image(3.0 * values - 50.0))
    assert np.array_equal(shifted.values, mask.values)


@pytest.mark.parametrize("values", [np.zeros((4, 4)), np.full((4, 4), 7.0), np.zeros((1, 1))])
def test_auto_finds_nothing_where_nothing_differs(values):
    assert Threshold(level="auto")(Image(values)).count == 0


def test_auto_says_where_a_share_of_the_peak_decides():
    rng = np.random.default_rng(2)
    values = rng.normal(0.0, 0.1, (16, 16))
    values[3:7, 3:7] += 100.0
    values[10:14, 9:13] += 2.0
    light = np.where(values > 50.0, 2.0, values)
    step = Threshold(level="auto")
    masks = [step(Image(its, quantity="gram")) for its in (values, light)]
    assert [mask.count for mask in masks] == [16, 32]
    noise = "above the frame's own noise"
    assert masks[0].assumed.endswith(f"{noise}: 3 % of the peak, as that is more")
    assert masks[1].assumed.endswith(noise)
    each = step.stacked(ImageStack(np.stack([values, light]), quantity="gram")).values
    assert [mask.assumed for mask in each] == [mask.assumed for mask in masks]
    assert [mask.assumed for mask in each.take(np.array([1]))] == [masks[1].assumed]
    assert [mask.assumed for mask in LevelledMaskStack.of(masks)] == [m.assumed for m in masks]


def test_one_level_of_a_recording_says_where_a_share_of_the_peak_decides(tmp_path):
    rng = np.random.default_rng(2)
    frames = rng.normal(0.0, 0.1, (4, 16, 16))
    frames[:, 3:7, 3:7] += 100.0
    np.savez(tmp_path / "r.npz", frames=frames, pitch_cm=1.0, quantity="gram")
    mask = Threshold(level="auto", noise_of=tmp_path / "r.npz")(Image(frames[0], quantity="gram"))
    assert mask.assumed.endswith("r.npz, 4 frames: 3 % of the peak, as that is more")


def test_auto_finds_nothing_in_noise_alone():
    for seed in range(30):
        noise = np.random.default_rng(seed).normal(0.0, 1.0, (16, 16))
        assert Threshold(level="auto")(Image(noise)).count == 0


def test_auto_says_that_few_cells_cannot_tell_a_load_from_noise():
    values = np.array([[0.0, 0.6, 1.2], [50.3, 49.1, 50.0], [49.7, 50.2, 49.5]])
    with pytest.raises(Degenerate, match="9 cells, of which some seem to bear a load, are too few"):
        Threshold(level="auto")(image_of(values))
    surely = values.copy()
    surely[0] /= 10.0
    assert Threshold(level="auto")(image_of(surely)).count == 6


def test_auto_says_nothing_of_loads_on_an_empty_pad_of_few_cells():
    rng = np.random.default_rng(0)
    n_untold = 0
    for values in rng.normal(0.0, 1.0, (300, 3, 3)):
        try:
            mask = Threshold(level="auto")(image_of(values))
        except Degenerate:
            n_untold += 1
        else:
            assert mask.count == 0
            assert mask.assumed.endswith("; no reading is so high")
    assert n_untold <= 3


def test_auto_leaves_invalid_cells_out_of_account():
    values = np.zeros((4, 4))
    values[0, 0], values[1, 1] = 1e6, 1.0
    valid = np.ones((4, 4), bool)
    valid[0, 0] = False
    assert np.argwhere(Threshold(level="auto")(Image(values, valid=valid)).values).tolist() == [
        [1, 1]
    ]


def test_the_level_must_be_finite():
    with pytest.raises(ValueError, match="the level must be a finite number, got nan"):
        Threshold(level=math.nan)


@pytest.mark.slow
@given(arrays(np.float64, (5, 7)), st.floats(allow_nan=False))
def test_it_compares_as_the_reference_does(values, level):
    pytest.importorskip("numba")
    outs = np.empty((3, 5, 7), bool)
    kernels = (references.at_least, at_least.loops, at_least.compiled)
    counts = {which(values, level, out) for which, out in zip(kernels, outs, strict=True)}
    assert counts == {-1 if np.isnan(values).any() else int(np.sum(values >= level))}
    assert np.array_equal(outs[0], outs[1])
    assert np.array_equal(outs[0], outs[2])


@pytest.mark.slow
@pytest.mark.usefixtures("plain_kernels")
def test_footprints_of_a_stack_are_those_of_its_frames():
    values = np.random.default_rng(2).random((4, 3, 5))
    values[1, 0, 0] = np.nan
    valid = np.ones(values.shape, bool)
    valid[2], valid[3, 1] = False, False
    for known, done in ((None, [True, False, True, True]), (valid, [True, False, False, True])):
        answered = footprints(ImageStack(values, valid=known), 0.4)
        assert answered.done.tolist() == done
        for k in np.flatnonzero(done):
            one = footprint(Image(values[k], valid=None if known is None else known[k]), 0.4)
            assert np.array_equal(answered.values.values[k], one.values)
            assert answered.values.counts[k] == one.count
