"""What rises above the noise, by plain code, by loops and by machine code alike."""

import numpy as np
import pytest

from helpers_modes import held, plainly
from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Image
from tactile_graph_filters.readings.ordered import in_order
from tactile_graph_likelihood.any_pad.above_noise import AboveNoise
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.any_pad.observation.rising import EVERY, SHOWS, risen, rising
from tactile_graph_likelihood.single.density.element_terms import UNKNOWN
from tactile_graph_pads.pad import load_pad

PAD = load_pad("thesis")


def pressed(rng, shape):
    values = 1e-3 * rng.standard_normal(shape)
    rows, columns = shape
    values[rows // 4 : rows // 2, columns // 4 : columns // 2] += rng.uniform(0.001, 0.3)
    return values


def image_of(values, valid=None):
    return Image(values, (1.3, 1.3), (-0.15, -0.15), "volt", valid)


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("shape", [(0, 0), (0, 5), (1, 1), (1, 9), (3, 2), (16, 16), (65, 70)])
@pytest.mark.parametrize("share", [None, 0.0, 0.5, 0.9])
@pytest.mark.parametrize("wrong", [None, np.nan, np.inf, -1e101])
def test_plain_code_loops_and_machine_code_answer_to_the_bit(shape, share, wrong):
    rng = np.random.default_rng(2)
    values, known = pressed(rng, shape), EVERY
    if wrong is not None and values.size:
        values.flat[values.size // 2] = wrong
    if share is not None:
        known = held(rng.random(shape) < share)
    values = held(values)
    sample = in_order(values.ravel() if share is None else values[known])
    check_alike(values, known, sample)
    if wrong is None:
        hot = values.copy()
        hot[shape[0] // 3 : shape[0] // 3 + 1] += 0.02
        check_alike(held(hot), known, in_order(hot.ravel() if share is None else hot[known]))
        clipped = held(np.maximum(values, 0.0))
        check_alike(clipped, known, in_order(clipped.ravel() if share is None else clipped[known]))


def check_alike(values, known, sample):
    given = values, known, sample, SHOWS, True
    ways = [way(*given) for way in (rising.reference, plainly(rising), rising.compiled)]
    for way in ways[1:]:
        assert way[0] == ways[0][0]
        if way[0]:
            assert way[1:6] == ways[0][1:6]
            np.testing.assert_array_equal(way[6], ways[0][6])
            np.testing.assert_array_equal(way[7], ways[0][7])


def test_readings_that_rise_are_told_above_the_zero_and_others_as_none():
    values = pressed(np.random.default_rng(4), (16, 16)) + 1.5
    found = risen(image_of(values.copy()), PAD)
    assert found.zero == pytest.approx(1.5, abs=1e-3)
    np.testing.assert_array_equal(found.shows, values - found.zero > found.least)
    np.testing.assert_array_equal(found.above, np.where(found.shows, values - found.zero, 0.0))


def test_where_no_cell_is_valid_nothing_is_called_untouched():
    nothing = image_of(np.zeros((16, 16)), np.zeros((16, 16), np.bool_))
    for of in (AboveNoise(), lambda image: risen(image, PAD)):
        with pytest.raises(Degenerate, match="no cell of the image is valid, so nothing says what"):
            of(nothing)


def test_what_invalid_cells_hold_does_not_matter():
    values = pressed(np.random.default_rng(5), (16, 16))
    valid = np.ones((16, 16), np.bool_)
    valid[5] = False
    values[5] = 0.0
    other = values.copy()
    other[5, :3] = np.nan, np.inf, 1e200
    quiet, loud = (AboveNoise()(image_of(v, valid.copy())) for v in (values, other))
    assert quiet[1:] == loud[1:]
    np.testing.assert_array_equal(quiet.mask.values, loud.mask.values)
    assert not quiet.mask.values[5].any()
    assert quiet.mask.count == np.count_nonzero(quiet.mask.values)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf, 1.1e100, -1.1e100])
def test_valid_readings_must_be_numbers_of_a_pad(wrong):
    values = np.zeros((4, 4))
    values[1, 2] = wrong
    with pytest.raises(DataError, match=r"image: readings must be finite and at most 1e\+100"):
        AboveNoise()(image_of(values))


def test_whole_numbers_and_single_precision_are_read_as_they_are():
    counts = np.round(4096 * pressed(np.random.default_rng(6), (16, 16)))
    as_double = AboveNoise()(image_of(counts))
    for kind in (np.int32, np.float32):
        found = AboveNoise()(image_of(counts.astype(kind)))
        assert found[1:] == as_double[1:]
        np.testing.assert_array_equal(found.mask.values, as_double.mask.values)


@pytest.mark.parametrize("noise", [0.3, 1.0, 3.0])
def test_an_empty_pad_of_a_device_that_clips_is_not_touched(noise):
    rng = np.random.default_rng(7)
    for _ in range(10):
        values = np.maximum(np.round(rng.normal(0.0, noise, (16, 16))), 0.0)
        found = AboveNoise()(Image(values, (1.0, 1.0), (0.0, 0.0), "counts"))
        assert found.together <= 3
        assert found.rise <= 1.5


def test_what_saturates_on_a_quarter_of_the_pad_shows():
    values = np.round(np.random.default_rng(8).normal(10.0, 1.5, (16, 16)))
    values[3:12, 4:13] = 255.0
    found = AboveNoise()(Image(values, (1.0, 1.0), (0.0, 0.0), "counts"))
    assert np.array_equal(found.mask.values, values == 255.0)


def test_a_quarter_of_the_pad_dead_below_the_others_is_not_its_zero():
    rng = np.random.default_rng(5)
    values = np.rint(rng.normal(20.0, 1.5, (16, 16)))
    values[8:12, 8:12] += 200.0
    values[:8, :8] = 0.0
    found = AboveNoise()(image_of(values))
    assert (found.mask.values == (values > 100.0)).all()
    assert (observed(image_of(values), load_pad("thesis")).states[:8, :8] == UNKNOWN).all()


@pytest.mark.parametrize("offset", [0.01, 0.02, 0.05])
def test_a_hot_row_or_column_is_no_load_and_hides_none(offset):
    rng = np.random.default_rng(9)
    row, column = np.mgrid[:16, :16]
    on = np.hypot(row - 7, column - 9) < 3.0
    for load in (0.0, 0.3 * rng.lognormal(0.0, 0.3, (16, 16)) * on):
        values = 5e-4 * rng.standard_normal((16, 16)) + load
        hot = values.copy()
        hot[6] += offset
        for given in (hot, hot.T.copy()):
            found = AboveNoise()(image_of(given))
            if np.any(load):
                assert np.array_equal(
                    found.mask.values if given is hot else found.mask.values.T, on
                )
            else:
                assert found.together <= 3
                assert found.rise <= 1.5
        if np.any(load):
            above = risen(image_of(hot), PAD).above
            np.testing.assert_allclose(above, np.where(on, values, 0.0), atol=1e-3)


def seems_touched(shape, press, n, rounded):
    """Return the share of frames of noise that seem touched, one cell of them pressed or none."""
    rng, step, hits = np.random.default_rng(10), AboveNoise(), 0
    for _ in range(n):
        values = rng.normal(0.0, 20.0, shape)
        values.flat[rng.integers(values.size)] += press
        found = step(image_of(np.rint(values) if rounded else values))
        hits += found.together > 3 or found.rise > 1.5
    return hits / n


@pytest.mark.slow
@pytest.mark.parametrize("shape", [(1, 5), (1, 8), (3, 3), (3, 4), (4, 4), (5, 5), (1, 32)])
@pytest.mark.parametrize("rounded", [False, True])
def test_few_cells_are_not_touched_by_their_noise_and_are_by_a_load(shape, rounded):
    assert seems_touched(shape, 0.0, 500, rounded) < 0.05
    assert seems_touched(shape, 2000.0, 100, rounded) == 1.0


@pytest.mark.parametrize("shape", [(1, 5), (3, 3), (3, 4), (4, 4), (5, 5)])
def test_few_cells_whose_noise_is_less_than_a_count_are_not_touched_by_it(shape):
    rng, step = np.random.default_rng(0), AboveNoise()
    frames = np.rint(rng.normal(20.0, 0.5, (400, *shape)))
    seen = [step(image_of(values)) for values in frames]
    assert np.mean([f.together > 3 or f.rise > 1.5 for f in seen]) < 0.02


@pytest.mark.parametrize(
    "values",
    [
        [[34, 152, 24], [299, 722, 158], [52, 266, 17]],  # a quarter that is loaded seems untouched
        [[17, 203, 35], [253, 742, 377], [86, 473, 141]],  # all are loaded but one
        [[18, 21, 20], [22, 310, 590], [19, 280, 700]],
        [[20, 20, 21], [20, 24, 20], [20, 20, 600]],
        [[0, 0, 0], [0, 300, 0], [0, 0, 0]],
        [[0, 0, 1], [0, 1, 1], [0, 0, 0]],
    ],
)
def test_a_press_on_three_by_three_cells_shows(values):
    found = AboveNoise()(image_of(np.array(values, float)))
    assert found.together > 3 or found.rise > 1.5
    assert found.mask.values.flat[np.argmax(values)]


@pytest.mark.parametrize(("shape", "missed"), [((3, 3), 0.15), ((3, 4), 0.02), ((4, 4), 0.02)])
@pytest.mark.parametrize("peak", [100.0, 800.0])
def test_few_plain_presses_on_few_cells_go_unseen(shape, missed, peak):
    rng, step, unseen = np.random.default_rng(0), AboveNoise(), 0
    y, x = (np.mgrid[: 8 * shape[0], : 8 * shape[1]] + 0.5) / 8
    for _ in range(200):
        radius = rng.uniform(0.7, 1.0)
        row, column = rng.uniform(radius + 0.2, np.array(shape) - radius - 0.2)
        disc = (y - row) ** 2 + (x - column) ** 2 < radius**2
        load = disc.reshape(shape[0], 8, shape[1], 8).mean(axis=(1, 3))
        uneven = np.exp(rng.normal(0.0, 0.1, shape))
        found = step(image_of(np.rint(peak * load * uneven + rng.normal(20.0, 2.0, shape))))
        unseen += not (found.together > 3 or found.rise > 1.5)
    assert unseen <= missed * 200


@pytest.mark.parametrize("valid", [None, [[True, True], [False, True]]])
def test_four_cells_or_fewer_tell_no_noise(valid):
    image = image_of(np.array([[0.1, 0.0], [0.0, 2.0]]), None if valid is None else np.array(valid))
    match = rf"^{4 if valid is None else 3} valid cells tell no noise, .* at least 5 do, or a pad"
    with pytest.raises(Degenerate, match=match):
        AboveNoise()(image)
