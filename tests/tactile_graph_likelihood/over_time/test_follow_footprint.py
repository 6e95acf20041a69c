"""An outline over time: rest, moves, other objects, and what is remembered of the sizes."""

import numpy as np
import pytest

from helpers_likelihood import drawn, made
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Image
from tactile_graph_likelihood.over_time.at_rest import AtRest
from tactile_graph_likelihood.over_time.follow_footprint import FollowFootprint
from tactile_graph_likelihood.single.readings import readings_of

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

PITCH_CM = 1.3


def noisy(image, rng, scatter=0.034):
    return image.with_values(image.values * np.exp(scatter * rng.standard_normal((16, 16))))


def test_frames_at_rest_do_not_sharpen_what_gains_blur():
    rng = np.random.default_rng(1)
    image, step = drawn(Circle(10.0, 9.5, 5.5), 60.0, rng), made(FollowFootprint, on_pad="whole")
    found = [step(noisy(image, rng), gap_s=0.1) for _ in range(8)]
    assert [f.frames for f in found] == list(range(1, 9))
    assert [f.moved for f in found] == [True] + [False] * 7
    assert found[-1].shape.radius_std_cm > 0.9 * found[0].shape.radius_std_cm


def test_where_readings_scatter_error_and_deviation_fall_with_frames():
    first, last, stated = [], [], []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        image = drawn(Circle(10.0, 9.5, 5.5), 60.0, rng, 0.1, 0.02)
        step = made(FollowFootprint, on_pad="whole", sigma=0.1, frame_sigma=0.4)
        found = [step(noisy(image, rng, 0.4), gap_s=0.1) for _ in range(12)]
        assert found[-1].frames == 12
        off = [np.hypot(f.shape.x_cm - 10.0, f.shape.y_cm - 9.5) for f in (found[0], found[-1])]
        first.append(off[0])
        last.append(off[1])
        stated.append(found[-1].shape.centre_std_cm / found[0].shape.centre_std_cm)
    assert np.mean(last) < 0.7 * np.mean(first)
    assert max(stated) < 0.75


def test_a_move_by_half_a_cell_is_noticed_with_its_first_frame():
    for seed in range(6):
        rng = np.random.default_rng(seed)
        step = made(FollowFootprint, on_pad="whole")
        image = drawn(Circle(10.0, 9.5, 5.5), 60.0, rng)
        for _ in range(3):
            step(noisy(image, rng), gap_s=0.1)
        found = step(drawn(Circle(10.0 + 0.5 * PITCH_CM, 9.5, 5.5), 60.0, rng), gap_s=0.1)
        assert found.moved
        assert found.frames == 1
        assert found.shape.x_cm == pytest.approx(10.65, abs=0.3)


def test_a_slide_that_keeps_the_gains_is_noticed_too():
    for seed in range(4):
        step = made(FollowFootprint, on_pad="whole")
        first = drawn(Circle(10.0, 9.5, 5.5), 60.0, np.random.default_rng(seed))
        slid = drawn(Circle(10.65, 9.5, 5.5), 60.0, np.random.default_rng(seed))  # the same gains
        step(first, gap_s=0.1)
        step(noisy(first, np.random.default_rng(9)), gap_s=0.1)
        assert step(slid, gap_s=0.1).moved


def test_a_slow_slide_that_keeps_the_gains_is_followed():
    """By a twelfth of a cell a frame, few elements change each time."""
    off = []
    for seed in range(6):
        step = made(FollowFootprint, on_pad="whole")
        for k in range(24):
            disc = Circle(9.0 + 0.1 * k, 9.5, 3.0)
            image = drawn(disc, 60.0, np.random.default_rng(seed))
            alone = made(FollowFootprint, on_pad="whole")(image)
            followed = step(image, gap_s=0.1)
            off.append((followed.shape.x_cm - disc.x_cm, alone.shape.x_cm - disc.x_cm))
    rms_followed_cm, rms_alone_cm = np.sqrt(np.mean(np.square(off), axis=0))
    assert rms_followed_cm < 1.15 * rms_alone_cm


def test_more_weight_is_no_move_but_shows_in_the_load():
    rng, step = np.random.default_rng(2), made(FollowFootprint, on_pad="whole")
    image = drawn(Circle(10.0, 9.5, 5.5), 60.0, rng)
    step(image, gap_s=0.1)
    found = step(image.with_values(1.5 * image.values), gap_s=0.1)
    assert not found.moved
    rest = AtRest(readings_of(image, 0.3, 5.0), 0.034, np.log(5.0))
    heavier = readings_of(image.with_values(1.5 * image.values), 0.3, 5.0)
    rest.add(heavier)
    assert rest.averaged.logs == pytest.approx(heavier.logs)


def test_sizes_of_the_same_object_are_learned_from_placement_to_placement():
    rng, step = np.random.default_rng(3), made(FollowFootprint, on_pad="whole")
    found = [step(drawn(Circle(8.0 + 0.6 * k, 9.5, 5.5), 60.0, rng)) for k in range(8)]
    assert [f.placements for f in found] == list(range(1, 9))
    assert found[-1].shape.radius_std_cm < 0.6 * found[0].shape.radius_std_cm
    assert found[-1].shape.radius_cm == pytest.approx(5.5, abs=0.06)


def test_another_object_does_not_inherit_them():
    rng, step = np.random.default_rng(4), made(FollowFootprint, on_pad="whole")
    step(drawn(Circle(10.0, 9.5, 5.5), 60.0, rng))
    found = step(drawn(Circle(10.0, 9.5, 3.5), 60.0, rng))
    assert found.placements == 1
    assert found.shape.radius_cm == pytest.approx(3.5, abs=0.3)


def test_where_gains_stay_with_the_pad_less_is_learned():
    stated = {}
    for fixed in (0.0, 0.5):
        rng, step = np.random.default_rng(5), made(FollowFootprint, on_pad="whole", fixed=fixed)
        found = [step(drawn(Circle(10.0, 9.5, 5.5), 60.0, rng)) for _ in range(6)]
        stated[fixed] = found[-1].shape.radius_std_cm
    assert stated[0.5] > 1.3 * stated[0.0]


def test_an_empty_frame_ends_a_rest():
    rng, step = np.random.default_rng(6), made(FollowFootprint, on_pad="whole")
    image = drawn(Circle(10.0, 9.5, 5.5), 60.0, rng)
    step(image)
    with pytest.raises(Degenerate, match="no element bears a load"):
        step(Image(np.zeros((16, 16)), (1.3, 1.3), (-0.15, -0.15), "gram"))
    again = step(image)
    assert again.moved
    assert again.frames == 1


def test_a_long_gap_makes_a_move_likelier():
    rng = np.random.default_rng(7)
    image = drawn(Circle(10.0, 9.5, 5.5), 60.0, rng)
    readings = readings_of(image, 0.3, 5.0)
    rest = AtRest(readings, 0.034, np.log(5.0))
    odds = rest.log_odds_of_move(readings)
    assert -100.0 < odds < -10.0
    step = made(FollowFootprint, on_pad="whole", rest_s=1.0)
    step(image, gap_s=0.1)
    assert not step(image, gap_s=0.5 * -odds).moved
    assert step(image, gap_s=3.0 * -odds).moved
    assert step(image, gap_s=1e6).moved
