"""The loaded group is found in a frame, and frames that cannot calibrate are refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from helpers_calibration import counting_pad, frame, on_four
from tactile_graph.errors import DataError
from tactile_graph.wires import Circle, Frame, Image, TrueObject
from tactile_graph_pads.calibration.groups import GroupReader, empty_of
from tactile_graph_pads.pad import load_pad

PAD = load_pad("plain")


def test_the_strongest_group_is_found_and_averaged() -> None:
    (seen,) = GroupReader().observations([frame(PAD, 400.0, corner=(9, 2))], 400.0, "a.npz")
    assert seen.load_g == 100.0
    np.testing.assert_allclose(seen.readings, PAD.forward(on_four(PAD, 400.0))[3:5, 4:6].ravel())


def test_frames_of_one_placement_are_averaged_into_one_observation() -> None:
    frames = [frame(PAD, 400.0, k, corner=(9, 2)) for k in range(3)]
    moved = [frame(PAD, 400.0, 3 + k, corner=(1, 1)) for k in range(2)]
    assert len(list(GroupReader().observations([*frames, *moved, frames[0]], 400.0, "a"))) == 3


def test_the_same_elements_under_an_object_put_down_anew_are_another_placement() -> None:
    truth = (TrueObject(Circle(1.0, 1.0, 1.0), 400.0),)
    frames = [replace(frame(PAD, 400.0, k), truth=truth) for k in range(2)]
    again = replace(frames[0], truth=(TrueObject(Circle(1.1, 1.0, 1.0), 400.0),))
    assert len(list(GroupReader().observations([*frames, again], None, "a"))) == 2


def test_loads_come_from_the_truth_and_empty_frames_are_left_out() -> None:
    frames = [frame(PAD, g, k, truth=True) for k, g in enumerate((0.0, 100.0, 200.0))]
    seen = list(GroupReader().observations(frames, None, "a"))
    assert [s.load_g for s in seen] == [25.0, 50.0]


def test_counts_become_volts_by_the_pad_and_conductance_when_decoupled() -> None:
    pad = counting_pad()
    frames = [frame(pad, 400.0, quantity="counts")]
    true = on_four(PAD, 400.0)
    (volt,) = GroupReader(pad=pad).observations(frames, 400.0, "a")
    np.testing.assert_allclose(volt.readings, PAD.forward(true)[3:5, 4:6].ravel(), atol=1.3e-3)
    (siemens,) = GroupReader(pad=pad, decouple=True).observations(frames, 400.0, "a")
    np.testing.assert_allclose(siemens.readings, 1 / 80e3, rtol=5e-3)


def test_the_empty_pad_is_taken_off() -> None:
    empty = np.full((16, 16), 0.3)
    image = frame(PAD, 400.0).image
    raised = Frame(image.with_values(image.values + empty))
    rest = empty_of([Frame(image.with_values(empty))], "e")
    (seen,) = GroupReader(empty=rest).observations([raised], 400.0, "a")
    (plain,) = GroupReader().observations([frame(PAD, 400.0)], 400.0, "a")
    np.testing.assert_allclose(seen.readings, plain.readings)
    with pytest.raises(DataError, match=r"on one group.* take off what the empty pad reads"):
        list(GroupReader().observations([raised], 400.0, "a"))


def test_a_whole_pad_can_be_the_group() -> None:
    values = PAD.forward(np.full((16, 16), 20.0))
    even = Frame(PAD.image(values))
    (seen,) = GroupReader(group=None).observations([even], 5120.0, "a")
    assert seen.load_g == 20.0
    assert seen.readings.size == 256


def test_a_place_can_be_told() -> None:
    (seen,) = GroupReader((1, 1), (3, 4), decouple=False).observations([one_element()], 90.0, "a")
    assert seen.load_g == 90.0
    assert seen.readings.size == 1


def one_element() -> Frame:
    load = np.zeros((16, 16))
    load[3, 4] = 90.0
    return Frame(PAD.image(PAD.forward(load)))


def refused(reader: GroupReader, one: Frame, load_g: float | None = 100.0) -> None:
    list(reader.observations([one], load_g, "a.npz"))


def test_a_load_spread_wider_than_the_group_is_refused() -> None:
    values = PAD.forward(np.full((16, 16), 20.0))
    with pytest.raises(DataError, match=r"a.npz, frame 0: the load is not on one group: the 2x2"):
        refused(GroupReader(), Frame(PAD.image(values)))


def test_saturated_readings_are_refused_by_the_pads_converter() -> None:
    pad = counting_pad()
    counts = np.full((16, 16), 2048.0)
    counts[3:5, 4:6] = 4094.8  # the mean of samples that noise cut off
    with pytest.raises(
        DataError, match=r"saturated: under 100 g an element reads 4094.8, and 4095"
    ):
        refused(GroupReader(pad=pad), Frame(pad.image(counts, "counts")))


def test_saturated_readings_are_refused_by_the_full_scale_told() -> None:
    values = np.zeros((16, 16))
    values[3:5, 4:6] = 255.0
    with pytest.raises(DataError, match=r"saturated: .* 255 is all it can; leave this load out"):
        refused(GroupReader(full_scale=255.0), Frame(Image(values)))


def test_impossible_volts_cannot_be_decoupled() -> None:
    values = np.zeros((16, 16))
    values[3:5, 4:6] = 2.6
    with pytest.raises(DataError, match="impossible for the pad's divider circuit"):
        refused(GroupReader(pad=PAD, decouple=True), Frame(PAD.image(values)))


def test_grams_cannot_be_decoupled() -> None:
    with pytest.raises(DataError, match="only counts and volts can be decoupled, got gram"):
        refused(GroupReader(pad=PAD, decouple=True), Frame(PAD.image(np.ones((16, 16)), "gram")))


def test_a_frame_without_a_known_load_is_refused() -> None:
    with pytest.raises(DataError, match="has no known load: give it as FILE=GRAMS"):
        refused(GroupReader(), frame(PAD, 100.0), None)


@pytest.mark.parametrize("value", [0.0, -0.2])
def test_a_load_that_reads_nothing_is_refused(value: float) -> None:
    still = Frame.of(np.full((4, 4), value), quantity="volt")
    with pytest.raises(DataError, match=r"^a, frame 0: 100 g read nothing \(.*did the load lie"):
        list(GroupReader().observations([still], 100.0, "a"))


def test_two_objects_are_one_too_many() -> None:
    two = replace(frame(PAD, 100.0), truth=(TrueObject(Circle(1, 1, 1), 5.0),) * 2)
    with pytest.raises(DataError, match="holds 2 objects, a calibration takes one"):
        refused(GroupReader(), two, None)


def test_an_object_of_unknown_weight_is_refused() -> None:
    unknown = replace(frame(PAD, 100.0), truth=(TrueObject(Circle(1, 1, 1)),))
    with pytest.raises(DataError, match="its object has no known weight"):
        refused(GroupReader(), unknown, None)


def test_missing_elements_are_refused() -> None:
    valid = np.ones((16, 16), dtype=bool)
    valid[0, 0] = False
    with pytest.raises(DataError, match="1 elements are missing"):
        refused(GroupReader(), Frame(Image(np.ones((16, 16)), valid=valid)))


def test_groups_must_lie_on_the_pad() -> None:
    with pytest.raises(DataError, match=r"a group of 17x2 is larger than \(16, 16\)"):
        refused(GroupReader((17, 2)), frame(PAD, 100.0))
    with pytest.raises(DataError, match=r"a group at \(15, 3\) reaches over the edge"):
        refused(GroupReader(at=(15, 3)), frame(PAD, 100.0))
    empty = empty_of([Frame(Image(np.zeros((3, 3))))], "e")
    with pytest.raises(DataError, match=r"0: has 16 x 16 elements, but e has 3 x 3: recordings"):
        refused(GroupReader(empty=empty), frame(PAD, 100.0))


def test_an_empty_pad_in_another_unit_is_refused_unless_the_pad_turns_one_into_the_other() -> None:
    pad = counting_pad()
    rest = empty_of([frame(pad, 0.0)], "e")
    counts = frame(pad, 400.0, quantity="counts")
    with pytest.raises(DataError, match="frame 0: holds counts, but e volt: convert one of them"):
        refused(GroupReader(empty=rest), counts)
    (seen,) = GroupReader(empty=rest, pad=pad).observations([counts], 400.0, "a")
    true = PAD.forward(on_four(PAD, 400.0)) - PAD.forward(on_four(PAD, 0.0))
    np.testing.assert_allclose(seen.readings, true[3:5, 4:6].ravel(), atol=1.3e-3)


def test_an_element_missing_in_the_empty_pad_does_not_count_as_0() -> None:
    valid = np.ones((4, 4), np.bool_)
    valid[1, 2] = False
    whole = Frame(Image(np.full((4, 4), 100.0)))
    lacking = Frame(Image(np.where(valid, 104.0, 0.0), valid=valid))
    with pytest.raises(DataError, match=r"^e: 1 element is missing in all 2 frames .* row 1, col"):
        empty_of([lacking, lacking], "e")
    seen = empty_of([whole, lacking, lacking], "e").image
    assert seen.values[1, 2] == 100.0
    assert seen.values[0, 0] == 104.0


def test_an_empty_recording_holds_frames() -> None:
    with pytest.raises(DataError, match=r"^e: holds no frame"):
        empty_of([], "e")
