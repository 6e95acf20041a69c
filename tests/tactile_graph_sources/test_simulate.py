"""The simulate source: physics, truth and repeatability."""

import math

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph.steps import Report
from tactile_graph.steps.signature import Kind, read_signature
from tactile_graph.wires import Circle, Ellipse, Frame, Rectangle
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.simulate import simulate

DISC = {"shape": "disc", "weight_g": 1860, "radius_cm": 5.1, "place": [10.0, 9.0]}


def frames(n=3, seed=0, **settings) -> list[Frame]:
    source = simulate(frames=n, rng=np.random.default_rng(seed), report=Report(), **settings)
    return list(source)


def test_it_is_a_source_with_plain_settings():
    signature = read_signature("simulate", simulate)
    assert signature.kind is Kind.SOURCE
    assert [s.name for s in signature.settings] == [
        "scene", "pad", "frames", "sigma", "voids", "output",
    ]  # fmt: skip
    assert (signature.rng, signature.report) == ("rng", "report")


def test_the_same_seed_gives_the_same_bits_and_another_seed_others():
    one, same, other = (frames(4, seed, scene="discs") for seed in (7, 7, 8))
    for a, b in zip(one, same, strict=True):
        assert a.image.values.tobytes() == b.image.values.tobytes()
        assert a.truth == b.truth
    assert one[0].truth != other[0].truth


def test_asking_for_more_frames_does_not_change_the_first():
    few, many = frames(2), frames(5)
    assert few[1].image.values.tobytes() == many[1].image.values.tobytes()


def test_a_place_wholly_off_the_pad_is_refused_before_the_first_frame():
    scene = {"in_turn": [[DISC], [{**DISC, "place": [200, 3]}]]}
    with pytest.raises(UsageError, match=r"object 1 of placement 2: at place \[200, 3\]"):
        frames(1, scene=scene)


def test_every_frame_carries_its_truth_number_and_time():
    taken = frames(4, scene="discs")
    assert [f.index for f in taken] == [0, 1, 2, 3]
    assert taken[1].time_s == pytest.approx(51.2)
    names = [f.truth[0].name for f in taken]
    assert names == ["DISC I", "DISC II", "DISC III", "DISC I"]
    assert taken[1].truth[0].weight_g == 6360
    assert taken[1].truth[0].shape.radius_cm == 5.1


def test_volts_on_the_plain_pad_are_the_forward_model_of_the_coverage():
    (frame,) = frames(1, scene={"objects": [DISC]}, pad="plain")
    pad = load_pad("plain")
    covered = coverage_cm2(Circle(10.0, 9.0, 5.1), pad.geometry)
    expected = pad.forward(1860.0 * covered / covered.sum())
    np.testing.assert_allclose(frame.image.values, expected, rtol=1e-12)
    assert frame.image.quantity == "volt"
    assert frame.image.pitch_cm == (1.3, 1.3)
    assert frame.image.origin_cm == (-0.15, -0.15)
    assert 0.0 < frame.image.peak < 5.0


def test_the_load_found_back_from_the_volts_is_the_weight():
    (frame,) = frames(1, scene={"objects": [{**DISC, "weight_g": 6360}]}, pad="plain")
    found = load_pad("plain").backward(frame.image.values)
    assert found.load_g.sum() == pytest.approx(6360.0, rel=1e-9)


def test_counts_are_volts_in_steps_of_the_converter():
    (volts,) = frames(1, scene="disc-1")
    (counts,) = frames(1, scene="disc-1", output="counts")
    assert counts.image.quantity == "counts"
    np.testing.assert_allclose(
        (counts.image.values - 2048.0) * 10.0 / 4096.0, volts.image.values, atol=1e-12
    )


def test_an_empty_pad_stays_below_the_threshold_of_the_thesis():
    for frame in frames(3, scene="empty"):
        assert np.abs(frame.image.values).max() < 0.01
        assert frame.truth == ()


def test_without_unevenness_no_covered_element_is_dark():
    (frame,) = frames(1, scene="disc-2", sigma=0.0, voids=0.0)
    shape = frame.truth[0].shape
    covered = coverage_cm2(shape, load_pad("thesis").geometry)
    assert (frame.image.values[covered > 0.9] > 0.1).all()
    assert (frame.image.values[covered == 0.0] < 0.01).all()


def test_voids_and_sigma_make_the_footprint_uneven():
    (even,) = frames(1, scene="disc-3", sigma=0.0, voids=0.0)
    (uneven,) = frames(1, scene="disc-3", sigma=1.0, voids=0.2)
    assert even.truth == uneven.truth
    inside = coverage_cm2(even.truth[0].shape, load_pad("thesis").geometry) > 0.99
    assert (uneven.image.values[inside] < 0.01).mean() > 0.1
    assert (even.image.values[inside] > 0.1).all()
    assert uneven.image.values[inside].std() > 3.0 * even.image.values[inside].std()


def test_a_held_placement_changes_only_in_its_readings():
    one, two, three = frames(3, scene={"objects": [{**DISC, "place": "random"}], "hold": 2})
    assert one.truth == two.truth
    assert three.truth != one.truth
    assert not (one.image.values == two.image.values).all()
    dark = one.image.values < 0.005
    assert (two.image.values[dark] < 0.01).all()


def test_repeatability_scatters_each_reading():
    pad = {"law": {"repeatability": 0.1}, "converter": {"bits": None}, "scan": {"noise_v": 0}}
    taken = frames(60, scene={"objects": [DISC], "hold": 60}, pad=pad)
    resistance = np.array(
        [load_pad(pad).circuit.inverse(f.image.values / 5).siemens for f in taken]
    )
    loaded = resistance[:, resistance[0] > 0.0]
    assert np.log(loaded).std(axis=0).mean() == pytest.approx(0.1, rel=0.1)


def test_a_grain_of_sand_takes_nearly_all_and_foam_evens():
    (sand,) = frames(1, scene="sand")
    row, column = np.unravel_index(sand.image.values.argmax(), (16, 16))
    assert (row, column) == (5, 5)
    assert sand.image.peak > 4.0
    hard = frames(1, scene={"objects": [DISC]})[0].image
    soft = frames(1, scene={"objects": [DISC], "foam_cm": 1.5})[0].image
    assert soft.peak < hard.peak
    assert np.count_nonzero(soft.values > 0.01) > np.count_nonzero(hard.values > 0.01)


def test_several_objects_lie_together_with_their_weights():
    for frame in frames(5, scene="two-objects"):
        disc, slab = frame.truth
        assert isinstance(disc.shape, Circle)
        assert isinstance(slab.shape, Rectangle)
    scene = {"objects": [{**DISC, "radius_cm": 3, "place": [4, 4]},
                         {**DISC, "radius_cm": 3, "place": [15, 15]}]}  # fmt: skip
    (both,) = frames(1, scene=scene, pad="plain")
    loads = load_pad("plain").backward(both.image.values).load_g
    assert loads[:8, :8].sum() == pytest.approx(1860.0)
    assert loads[8:, 8:].sum() == pytest.approx(1860.0)


def test_stacked_weights_count_in_the_truth_and_move_the_pressure():
    stacked = {**DISC, "stacked_g": [1000, 500], "stack_offset_cm": 1.0}
    (frame,) = frames(1, scene={"objects": [stacked]}, pad="plain")
    assert frame.truth[0].weight_g == 3360
    (even,) = frames(1, scene={"objects": [{**DISC, "weight_g": 3360}]}, pad="plain")
    assert not np.allclose(frame.image.values, even.image.values, rtol=0.01)
    assert load_pad("plain").backward(frame.image.values).load_g.sum() == pytest.approx(3360.0)


@pytest.mark.parametrize(
    ("thing", "part"),
    [
        (DISC, Circle(10.0, 9.0, 5.1 * 0.8)),
        (
            {"shape": "rectangle", "weight_g": 900, "length_cm": 10, "breadth_cm": 4,
             "place": [10.0, 9.0], "angle_deg": 0.0},
            Rectangle(10.0, 9.0, 8.0, 4.0, 0.0),
        ),
        (
            {"shape": "rectangle", "weight_g": 900, "length_cm": 4.5, "breadth_cm": 4,
             "place": [10.0, 9.0], "angle_deg": 0.0},
            Rectangle(10.0, 9.0, 3.6, 4.0, 0.0),
        ),
        (
            {"shape": "ellipse", "weight_g": 900, "semi_major_cm": 5, "semi_minor_cm": 3,
             "place": [10.0, 9.0], "angle_deg": 30.0},
            Ellipse(10.0, 9.0, 4.0, 2.4, math.radians(30.0)),
        ),
        (
            {"shape": "polygon", "weight_g": 900, "place": [10.0, 9.0], "angle_deg": 0.0,
             "corners_cm": [[-3, -3], [3, -3], [3, 3], [-3, 3]]},
            Rectangle(10.0, 9.0, 4.8, 4.8, 0.0),
        ),
    ],
    ids=["disc", "rectangle", "rectangle, now broader than long", "ellipse", "polygon"],
)  # fmt: skip
def test_the_part_that_touches_bears_all_and_the_truth_keeps_the_whole(thing, part):
    (frame,) = frames(1, scene={"objects": [{**thing, "touches": 0.8}]}, pad="plain")
    pad = load_pad("plain")
    covered = coverage_cm2(part, pad.geometry)
    wanted = thing["weight_g"] * covered / covered.sum()
    found = pad.backward(frame.image.values).load_g
    assert found == pytest.approx(wanted, rel=0.05, abs=1.0)
    (whole,) = frames(1, scene={"objects": [thing]}, pad="plain")
    assert str(frame.truth[0]) == str(whole.truth[0])


def test_a_pad_on_which_objects_lean_moves_the_pressure_anew_each_time():
    pad = {"contact": {"lean_cm": 1.0}}
    off = []
    for frame in frames(60, scene={"objects": [DISC]}, pad=pad):
        load = load_pad(pad).backward(frame.image.values).load_g
        image = frame.image
        off.append([(load.sum(0) @ image.x_cm) / load.sum() - 10.0,
                    (load.sum(1) @ image.y_cm) / load.sum() - 9.0])  # fmt: skip
    assert np.std(off, axis=0) == pytest.approx([0.9, 0.9], abs=0.25)
    assert np.abs(np.mean(off, axis=0)).max() < 0.4


def test_strays_are_read_off_the_object_only():
    pad = {"unevenness": {"strays": 0.1}}
    (frame,) = frames(1, scene={"objects": [DISC]}, pad=pad)
    (clean,) = frames(1, scene={"objects": [DISC]}, pad={})
    off = coverage_cm2(Circle(10.0, 9.0, 5.1), load_pad(pad).geometry) == 0.0
    assert (clean.image.values[off] < 0.01).all()
    assert 0.02 < (frame.image.values[off] > 0.01).mean() < 0.2


def test_faults_of_the_pad_show_in_every_frame():
    pad = {
        "defects": {
            "dead_rows": [3],
            "hot": [{"row": 12, "column": 12, "resistance_ohm": 1e3}],
            "element_gain_sigma": 0.4,
        },
        "scan": {"noise_v": 0},
        "converter": {"bits": None},
    }
    one, two = frames(2, scene={"objects": [DISC]}, pad=pad)
    assert (one.image.values[3] == 0.0).all()
    assert one.image.values[12, 12] > 4.5
    assert (one.image.values == two.image.values).all()


def test_the_report_knows_how_many_frames_to_expect():
    report = Report()
    list(simulate(frames=4, rng=np.random.default_rng(0), report=report))
    assert report.n_expected == 4


def test_a_scene_that_is_not_there_is_refused():
    with pytest.raises(UsageError, match="did you mean 'disc-1'"):
        frames(1, scene="disk-1")
