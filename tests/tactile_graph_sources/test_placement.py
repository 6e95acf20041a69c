"""Objects are put down on the pad, and apart."""

import math
from contextlib import nullcontext

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph.wires import Circle, Ellipse, Rectangle
from tactile_graph_pads.geometry import Geometry
from tactile_graph_sources import placement
from tactile_graph_sources.placement import are_apart, check_places, place
from tactile_graph_sources.scene import Disc, Oval, Plate, Scene, Slab

PAD = Geometry()
ONE = placement._place_one
THINGS = [
    Disc(weight_g=1.0, radius_cm=7.7),
    Slab(weight_g=1.0, length_cm=16.0, breadth_cm=7.0),
    Oval(weight_g=1.0, semi_major_cm=8.0, semi_minor_cm=2.0),
    Plate(weight_g=1.0, sides=5, radius_cm=5.0),
]


@pytest.mark.parametrize("thing", THINGS)
def test_a_random_place_keeps_the_whole_object_on_the_pad_and_reaches_all_of_it(thing):
    rng = np.random.default_rng(0)
    outlines = [place([thing], PAD, 0.0, rng)[0].outline_cm(200) for _ in range(200)]
    for xy in outlines:
        assert (xy >= -1e-9).all()
        assert (xy <= 20.5 + 1e-9).all()
    low, high = np.min([o.min(axis=0) for o in outlines]), np.max([o.max() for o in outlines])
    assert low < 0.5
    assert high > 20.0


def test_a_random_angle_takes_every_direction():
    rng = np.random.default_rng(0)
    slab = Slab(weight_g=1.0, length_cm=8.0, breadth_cm=2.0)
    angles = [place([slab], PAD, 0.0, rng)[0].angle_deg for _ in range(300)]
    assert min(angles) < -80.0
    assert max(angles) > 80.0
    assert np.mean(angles) == pytest.approx(0.0, abs=8.0)


def test_given_place_and_angle_are_kept_even_beyond_the_pad():
    slab = Slab(weight_g=1.0, length_cm=8.0, breadth_cm=2.0, place=(0.0, 4.0), angle_deg=30.0)
    (shape,) = place([slab], PAD, 0.0, np.random.default_rng(0))
    assert shape == Rectangle(0.0, 4.0, 8.0, 2.0, math.radians(30.0))


def test_objects_keep_their_distance():
    rng = np.random.default_rng(0)
    discs = [Disc(weight_g=1.0, radius_cm=2.0)] * 4
    for _ in range(20):
        shapes = place(discs, PAD, 1.0, rng)
        for i, one in enumerate(shapes):
            for other in shapes[:i]:
                assert math.hypot(one.x_cm - other.x_cm, one.y_cm - other.y_cm) >= 5.0


def test_an_object_too_large_for_the_pad_is_named():
    big = Disc(weight_g=1.0, radius_cm=11.0, name="plate")
    with pytest.raises(UsageError, match=r"object 1 \(plate\) does not fit on the pad of 20.5 by"):
        place([big], PAD, 0.0, np.random.default_rng(0))


@pytest.mark.parametrize(
    ("thing", "off"),
    [
        (Disc(weight_g=1.0, radius_cm=2.0, place=(200.0, 3.0)), True),
        (Disc(weight_g=1.0, radius_cm=2.0, place=(22.4, 3.0)), False),
        (Disc(weight_g=1.0, radius_cm=2.0, place=(-1.5, -1.5)), True),  # beside the corner
        (Slab(weight_g=1.0, length_cm=8.0, breadth_cm=2.0, place=(9.0, -3.0), angle_deg=0.0), True),
        (Slab(weight_g=1.0, length_cm=8.0, breadth_cm=2.0, place=(9.0, -3.0)), False),
        (Plate(weight_g=1.0, sides=5, radius_cm=5.0, place=(9.0, 26.0)), True),
        (Disc(weight_g=1.0, radius_cm=2.0), False),
    ],
)
def test_a_place_wholly_off_the_pad_is_refused(thing, off):
    for scene, at in (
        (Scene(objects=(THINGS[0], thing)), "object 2: at place"),
        (Scene(in_turn=((THINGS[0],), (thing,))), "object 1 of placement 2: at place"),
    ):
        told = pytest.raises(UsageError, match=at + r" .* wholly off the pad of 20.5 by 20.5 cm")
        with told if off else nullcontext():
            check_places(scene, PAD)


def test_objects_that_find_no_room_are_named(monkeypatch):
    monkeypatch.setattr(placement, "MOST_TRIES", 40)
    two = [Disc(weight_g=1.0, radius_cm=7.0)] * 2
    with pytest.raises(UsageError, match="object 2 found no place 0 cm apart from the 1 before"):
        place(two, PAD, 0.0, np.random.default_rng(0))


FULL = [Disc(weight_g=1.0, radius_cm=2.5)] * 7
"""Seven discs, of which the first six often leave no place for the last."""


def test_a_scene_whose_last_object_finds_no_place_starts_anew(monkeypatch):
    monkeypatch.setattr(placement, "MOST_TRIES", 40)
    starts = []
    for seed in range(8):
        calls = []
        monkeypatch.setattr(
            placement, "_place_one", lambda n, *a, c=calls: c.append(n) or ONE(n, *a)
        )
        shapes = place(FULL, PAD, 0.2, np.random.default_rng(seed))
        assert len(shapes) == len(FULL)
        for i, one in enumerate(shapes):
            assert all(are_apart(one, other, 0.2) for other in shapes[:i])
        starts.append(calls.count(0))
        assert place(FULL, PAD, 0.2, np.random.default_rng(seed)) == shapes
    assert max(starts) > 1


def test_a_scene_that_needs_one_start_draws_as_one_object_after_the_other():
    rng = np.random.default_rng(3)
    shapes = []
    for thing in FULL[:3]:
        shapes.append(ONE(len(shapes), thing, shapes, PAD, 0.2, rng))
    again = np.random.default_rng(3)
    assert place(FULL[:3], PAD, 0.2, again) == shapes
    assert again.random() == rng.random()


@pytest.mark.parametrize(
    ("one", "other", "by_cm", "apart"),
    [
        (Circle(0, 0, 1), Circle(2.01, 0, 1), 0.0, True),
        (Circle(0, 0, 1), Circle(1.99, 0, 1), 0.0, False),
        (Circle(0, 0, 1), Circle(2.5, 0, 1), 0.4, True),
        (Circle(0, 0, 1), Circle(2.5, 0, 1), 0.6, False),
        (Rectangle(0, 0, 4, 2, 0.0), Circle(3.01, 0, 1), 0.0, True),
        (Rectangle(0, 0, 4, 2, math.pi / 4), Rectangle(3, 3, 4, 2, math.pi / 4), 1.0, True),
        (Ellipse(0, 0, 4, 1, 0.0), Ellipse(0, 2.1, 4, 1, 0.0), 0.0, True),
        (Ellipse(0, 0, 4, 1, 0.0), Ellipse(0, 1.9, 4, 1, 0.0), 0.0, False),
        (Ellipse(0, 0, 4, 1, math.pi / 2), Ellipse(0, 2.1, 4, 1, math.pi / 2), 0.0, False),
    ],
)
def test_two_outlines_are_apart_where_a_straight_gap_runs_between(one, other, by_cm, apart):
    assert are_apart(one, other, by_cm) is apart
    assert are_apart(other, one, by_cm) is apart


def test_what_has_its_centre_on_the_pad_is_not_looked_at_further(monkeypatch):
    monkeypatch.delattr(placement, "are_apart")  # it takes most of the time that truth takes
    assert not placement.is_off(Circle(5.0, 5.0, 1.0), (0.0, 20.8, 20.8, 0.0))
