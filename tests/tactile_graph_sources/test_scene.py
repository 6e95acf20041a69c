"""Scenes by name, from a file or from a mapping."""

import math
from pathlib import Path

import pytest

from tactile_graph.errors import TactileGraphError, UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph.wires import Circle, Polygon, Rectangle
from tactile_graph_pads.records import RecordError
from tactile_graph_sources.scene import Disc, Plate, Scene, Slab, load_scene

DISC = {"shape": "disc", "weight_g": 10, "radius_cm": 3}


def test_every_shipped_scene_loads_and_says_what_it_is():
    names = installed().names("scenes")
    assert {"disc-1", "discs", "threshold-discs", "rectangle-2", "two-objects"} <= set(names)
    for name in names:
        assert load_scene(name).about


@pytest.mark.parametrize(
    ("name", "weight_g", "radius_cm"),
    [("disc-1", 1860, 6.8), ("disc-2", 6360, 5.1), ("disc-3", 6810, 7.7)],
)
def test_the_discs_are_those_of_table_4_2(name, weight_g, radius_cm):
    (disc,) = load_scene(name).objects
    assert isinstance(disc, Disc)
    assert (disc.weight_g, disc.radius_cm) == (weight_g, radius_cm)


def test_the_rectangles_are_those_of_table_4_6():
    sizes = [load_scene(f"rectangle-{n}").objects[0] for n in (1, 2)]
    assert all(isinstance(s, Slab) for s in sizes)
    assert [(s.weight_g, s.length_cm, s.breadth_cm) for s in sizes] == [
        (3000, 16, 7),
        (1500, 14, 3),
    ]


def test_groups_follow_in_turn_and_round_again():
    scene = load_scene("discs")
    assert [scene.group(k)[0].name for k in range(4)] == ["DISC I", "DISC II", "DISC III", "DISC I"]
    assert load_scene("empty").group(7) == ()


def test_a_scene_file_of_ones_own_is_read(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("objects: [{shape: disc, weight_g: 10, radius_cm: 3, place: [4, 5]}]\n")
    assert load_scene(str(path)).objects == (Disc(weight_g=10.0, radius_cm=3.0, place=(4.0, 5.0)),)
    path.write_text("objects:\n  - {shape: disc, weight_g: 10, radius: 3}\n")
    with pytest.raises(RecordError, match=r"mine.yaml:2:33: unknown key 'radius'; did you mean 'r"):
        load_scene(str(path))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (
            {"objects": [{**DISC, "radius": 3}]},
            r"scene\.objects\[0\]\.radius: unknown key 'radius'",
        ),
        (
            {"objects": [{**DISC, "x_cm": 3}]},
            r"\.x_cm: unknown key 'x_cm'; its centre is place: \[x, y\], in cm",
        ),
        (
            {"objects": [{**DISC, "shape": "disk"}]},
            "shape must be one of disc, ellipse, polygon, r",
        ),
        ({"objects": [{"weight_g": 1}]}, "'shape' is missing, it says which kind"),
        ({"objects": [{**DISC, "place": "here"}]}, r"place should be 'random' or .* got 'here'"),
        ({"objects": [{**DISC, "radius_cm": 0}]}, "radius_cm must be > 0, got 0"),
        ({"objects": [{"shape": "disc", "radius_cm": 1}]}, "'weight_g' is missing"),
        (
            {"objects": [{"shape": "polygon", "weight_g": 1, "sides": 5}]},
            "a polygon takes either corners_cm or both sides and radius_cm",
        ),
        (
            {
                "objects": [
                    {"shape": "polygon", "weight_g": 1, "corners_cm": [[0, 0], [1, 1], [2, 2]]}
                ]
            },
            "all corners lie on one line",
        ),
        (
            {"objects": [{"shape": "rectangle", "weight_g": 1, "length_cm": 3, "breadth_cm": 5}]},
            "length_cm is the longer side, got 3 by 5",
        ),
        (
            {
                "objects": [
                    {"shape": "ellipse", "weight_g": 1, "semi_major_cm": 3, "semi_minor_cm": 5}
                ]
            },
            "semi_major_cm is the longer half axis, got 3 and 5",
        ),
        ({"objects": [DISC], "in_turn": [[DISC]]}, "a scene takes objects or in_turn, not both"),
        ({"hold": 0}, "hold must be >= 1, got 0"),
    ],
)
def test_what_is_wrong_with_a_scene_is_said_by_its_place(data, message):
    with pytest.raises(RecordError, match=message):
        load_scene(data)


def test_a_scene_that_is_not_there_is_said_with_what_is_near(tmp_path):
    with pytest.raises(UsageError, match="no scene named 'disk-1'; did you mean 'disc-1'"):
        load_scene("disk-1")
    with pytest.raises(UsageError, match="no scene named 'zzz'; there are: at-rest, bayes"):
        load_scene("zzz")
    with pytest.raises(UsageError, match="this scene file cannot be read"):
        load_scene(str(tmp_path / "none.yaml"))


def test_footprints_lie_at_their_place_and_turn_as_seen():
    assert Disc(weight_g=1.0, radius_cm=2.0).footprint(3.0, 4.0, 9.9) == Circle(3.0, 4.0, 2.0)
    slab = Slab(weight_g=1.0, length_cm=4.0, breadth_cm=2.0).footprint(1.0, 2.0, 0.3)
    assert slab == Rectangle(1.0, 2.0, 4.0, 2.0, 0.3)
    plate = Plate(weight_g=1.0, sides=5, radius_cm=3.0).footprint(7.0, 8.0, math.pi / 2)
    assert isinstance(plate, Polygon)
    assert (plate.x_cm, plate.y_cm) == pytest.approx((7.0, 8.0))
    assert plate.xy_cm[0] == pytest.approx((7.0, 5.0))  # a quarter turn up, and y runs down
    assert plate.area_cm2 == pytest.approx(2.5 * 9.0 * math.sin(2 * math.pi / 5))


def test_given_corners_come_to_lie_with_their_centroid_at_the_place():
    corners = ((0.0, 0.0), (3.0, 0.0), (0.0, 6.0))
    plate = Plate(weight_g=1.0, corners_cm=corners).footprint(5.0, 5.0, 0.0)
    assert isinstance(plate, Polygon)
    assert plate.xy_cm.tolist() == [[4.0, 3.0], [7.0, 3.0], [4.0, 9.0]]


def test_stacked_weights_add_to_the_object():
    assert Disc(weight_g=100.0, radius_cm=1.0, stacked_g=(50.0, 25.0)).total_g == 175.0
    assert Scene().group(0) == ()


def test_a_polygon_of_absurd_size_is_refused(tmp_path: Path) -> None:
    """Its area would be no number that is finite."""
    path = tmp_path / "a.yaml"
    path.write_text(
        "scene: a\nobjects:\n"
        "  - [{shape: polygon, name: p, weight_g: 475, sides: 5, radius_cm: 1e308}]\n"
    )
    with pytest.raises(TactileGraphError, match="radius_cm"):
        load_scene(str(path))
