import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_filters import drawn, image_of
from helpers_objects import Spot
from tactile_graph import loads
from tactile_graph.draw.display import Label, Outline, Rim, display_list
from tactile_graph.errors import DataError
from tactile_graph.wires import Frame, Image, Mask
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_tracking.track import Track
from tactile_graph_tracking.tracked_object import TrackedObject

DT = 0.02


def states(tracks):
    return {t.id: t.state for t in tracks.tracks}


def ids_by_name(tracks):
    return {t.contact.name: t.id for t in tracks.tracks if t.state != "leaves"}


def test_an_object_appears_rests_moves_rests_and_leaves_once():
    track = Track(patience_s=0.1)
    seen = []
    at = [2.0] * 10 + [2.0 + 0.4 * k for k in range(1, 11)] + [6.0] * 40
    for x in at:
        tracks = track([Spot(x, 3.0)], gap_s=DT)
        seen.append(tracks.tracks[0].state)
        assert states(tracks) == {1: seen[-1]}
    assert seen[0] == "appears"
    assert set(seen[1:10]) == {"rests"}
    assert set(seen[12:20]) == {"moves"}
    assert seen[-1] == "rests"
    after = [track([], gap_s=DT) for _ in range(10)]
    assert [states(t) for t in after].count({1: "leaves"}) == 1
    assert all(t.count == 0 for t in after)
    assert states(after[5]) == {1: "leaves"}
    gone = after[5].tracks[0]
    assert (gone.x_cm, gone.y_cm) == (6.0, 3.0)


@pytest.mark.parametrize("pitch_cm", [(10.0, 10.0), (4.0, 10.0)])
@pytest.mark.parametrize("gate_cm", ["auto", 2.6])
def test_on_large_cells_the_gate_grows_with_their_pitch(pitch_cm, gate_cm):
    track = Track(gate_cm=gate_cm)
    for k in range(12):
        values = np.zeros((14, 4))
        values[k : k + 2, 1:3] = 5.0
        image = Image(values, pitch_cm)
        tracks = track(contacts(image, image.mask(values > 0)).contacts, gap_s=0.1)
    assert (tracks.n_so_far == 1) is (gate_cm == "auto")


def test_on_usual_cells_the_gate_that_is_found_is_2_6_cm():
    off = [2.59, 2.61]
    for x, n in zip(off, (1, 2), strict=True):
        track = Track()
        for at in (0.0, x):
            values = np.eye(1)
            image = Image(values, (1.3, 1.3), (at, 0.0))
            tracks = track(contacts(image, image.mask(values > 0)).contacts, gap_s=DT)
        assert tracks.n_so_far == n


def test_velocity_and_age_are_in_true_time():
    track = Track()
    now, x = 0.0, 1.0
    for gap in [None, 0.02, 0.05, 0.02, 0.1, 0.01, 0.02, 0.04] * 3:
        now += gap or 0.0
        x = 1.0 + 5.0 * now
        tracks = track([Spot(x, 9.0 - x)], gap_s=gap if gap is not None else 0.0)
    one = tracks.tracks[0]
    assert one.id == 1
    assert (one.vx_cm_s, one.vy_cm_s) == pytest.approx((5.0, -5.0), rel=0.05)
    assert one.speed_cm_s == pytest.approx(5.0 * math.sqrt(2), rel=0.05)
    assert one.age_s == pytest.approx(now)
    assert (one.x_cm, one.y_cm) == (x, 9.0 - x)


@pytest.mark.parametrize("dt_s", [0.02, 0.1, 0.2, 1.0])
@pytest.mark.parametrize("patience_s", [0.05, 0.5])
def test_velocity_is_true_however_far_apart_frames_come(dt_s, patience_s):
    track = Track(patience_s=patience_s)
    for k in range(14):
        tracks = track([Spot(4.0 + 0.4 * k, 5.0)], gap_s=None if k == 0 else dt_s)
    (one,) = tracks.tracks
    assert (one.vx_cm_s, one.vy_cm_s) == pytest.approx((0.4 / dt_s, 0.0), rel=0.01)


def test_dropped_frames_change_no_velocity():
    track, before_s = Track(patience_s=0.05), 0.0
    for k in (0, 1, 2, 3, 8, 9):
        tracks = track([Spot(4.0 + 0.4 * k, 5.0)], gap_s=k * DT - before_s)
        before_s = k * DT
        assert k == 0 or tracks.tracks[0].vx_cm_s == pytest.approx(20.0, rel=0.02)


def test_after_a_long_gap_velocity_is_the_mean_since():
    track = Track(patience_s=0.05)
    for k in range(10):
        track([Spot(4.0 + 0.4 * k, 5.0)], gap_s=DT)
    tracks = track([Spot(8.6, 5.0)], gap_s=10.0)
    assert states(tracks) == {1: "rests"}
    assert tracks.tracks[0].vx_cm_s == pytest.approx(0.1, abs=0.01)


@pytest.mark.parametrize("pause_s", [0.6, 10.0, 1e9])
def test_how_fast_it_goes_after_a_pause_is_seen_soon(pause_s):
    track = Track(patience_s="auto", rest_cm_s="auto")
    for k in range(30):
        gap_s = pause_s if k == 15 else DT
        tracks = track([Spot(4.0 + 0.1 * k, 5.0)], gap_s=gap_s)
        if k == 15:
            assert tracks.tracks[0].vx_cm_s == pytest.approx(0.1 / pause_s, rel=0.01)
        elif k > 20:
            assert states(tracks) == {1: "moves"}
            assert tracks.tracks[0].vx_cm_s == pytest.approx(5.0, rel=0.2)


@pytest.mark.parametrize("within_s", [0.0, 2e-4])
@pytest.mark.parametrize(("n_in_one", "stalls"), [(10, False), (50, True)])
def test_frames_that_come_in_bursts_gain_no_speed(within_s, n_in_one, stalls):
    """Each burst is handed over when its last frame is taken; or one is, after others came even."""
    track, speeds, last_s, dt_s = Track(), [], 0.0, 0.01
    for k in range(1, 401):
        taken_s = k * dt_s
        end_s = math.ceil((k - 0.5) / n_in_one) * n_in_one * dt_s
        in_one = not stalls or 200 < k <= 200 + n_in_one
        now_s = end_s - (end_s - taken_s) / dt_s * within_s if in_one else taken_s
        (one,) = track([Spot(2.0 + 5.0 * taken_s, 5.0)], gap_s=now_s - last_s).tracks
        last_s = now_s
        speeds.append(one.vx_cm_s)
    assert one.id == 1
    assert max(speeds[20:]) < 7.0
    assert speeds[-1] == pytest.approx(5.0, rel=0.1)


def test_an_object_that_appears_within_a_burst_has_no_speed_from_it():
    track = Track()
    for k in range(100):
        track([], gap_s=0.1 if k % 10 == 0 else 0.0)
    for k in range(5):
        (one,) = track([Spot(4.0 + 0.05 * k, 5.0)], gap_s=1e-4).tracks
    assert one.speed_cm_s < 0.1
    (one,) = track([Spot(4.7, 5.0)], gap_s=0.1).tracks
    assert one.vx_cm_s == pytest.approx(5.0, rel=0.1)


def test_farther_apart_than_their_patience_objects_are_expected_where_they_go():
    """It gains less than a gate from frame to frame, and goes more than two in the end."""
    track, x_cm = Track(patience_s=0.05, gate_cm=1.0), 0.0
    for k in range(4):
        x_cm += 0.8 * k
        assert ids_by_name(track([Spot(x_cm, 5.0, name="goes")], gap_s=1.0)) == {"goes": 1}


def test_an_object_unseen_for_a_while_comes_back_under_its_id_where_it_went():
    track = Track(patience_s=0.5)
    for k in range(20):
        track([Spot(1.0 + 0.3 * k, 5.0)], gap_s=DT)
    for _ in range(15):  # 4.5 cm on, well beyond the gate of where it was last seen
        assert track([], gap_s=DT).tracks == ()
    tracks = track([Spot(1.0 + 0.3 * 35, 5.0)], gap_s=DT)
    assert states(tracks) == {1: "moves"}


def test_a_gap_in_the_recording_makes_nobody_leave_who_is_there_after_it():
    track = Track(patience_s=0.1)
    track([Spot(2.0, 2.0), Spot(8.0, 8.0)], gap_s=None)
    tracks = track([Spot(8.1, 8.0)], gap_s=60.0)
    assert states(tracks) == {1: "leaves", 2: "rests"}


def test_ids_are_never_given_again():
    track = Track(patience_s=0.0)
    for n in range(1, 6):
        tracks = track([Spot(2.0, 2.0)], gap_s=DT)
        assert states(tracks) == {n: "appears"}
        assert tracks.n_so_far == n
        track([], gap_s=DT)


@pytest.mark.parametrize("areas", [(10.0, 10.0), (10.0, 14.0)])
def test_objects_that_cross_keep_their_ids(areas):
    """One from the left, one from above, past the same place a moment apart."""
    track = Track()
    for k in range(60):
        along = -3.0 + 0.12 * k
        spots = [
            Spot(8.0 + along, 8.0, areas[0], "across"),
            Spot(8.0, 8.35 + along, areas[1], "down"),
        ]
        tracks = track(spots[:: (-1) ** k], gap_s=DT)
        if k == 0:
            first = ids_by_name(tracks)
        assert ids_by_name(tracks) == first


def test_objects_that_swap_places_behind_a_blind_moment_are_told_apart_by_area():
    track = Track()
    for _ in range(5):
        first = track([Spot(4.0, 4.0, 5.0, "s"), Spot(5.5, 4.0, 20.0, "l")], gap_s=DT)
    after = track([Spot(5.3, 4.0, 5.0, "s"), Spot(4.2, 4.0, 20.0, "l")], gap_s=DT)
    assert ids_by_name(after) == ids_by_name(first)


spots = st.lists(st.builds(Spot, st.floats(0, 20), st.floats(0, 20), st.floats(1, 60)), max_size=6)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(spots, st.sampled_from([None, 0.0, 0.02, 1.0])), max_size=8), st.randoms()
)
@pytest.mark.slow
def test_the_order_of_contacts_within_a_frame_changes_nothing(story, random):
    one, other = Track(), Track()
    for frame, gap in story:
        mixed = list(frame)
        random.shuffle(mixed)
        a, b = one(frame, gap_s=gap), other(mixed, gap_s=gap)
        assert [t.columns_shown and [getattr(t, c) for c in t.columns_shown] for t in a.tracks] == [
            [getattr(t, c) for c in t.columns_shown] for t in b.tracks
        ]


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(spots, st.sampled_from([None, 0.0, -1.0, 0.02, 1.0, 1e4])), max_size=10))
def test_whatever_comes_every_contact_has_one_id_and_all_is_finite(story):
    track, given_up = Track(most=8), set()
    for frame, gap in story:
        tracks = track(frame, gap_s=gap)
        here = [t for t in tracks.tracks if t.state != "leaves"]
        assert len(here) == tracks.count <= len(frame)
        assert {id(t.contact) for t in here} <= {id(s) for s in frame}
        assert len({t.id for t in tracks.tracks}) == len(tracks.tracks)
        assert not given_up & {t.id for t in tracks.tracks}
        given_up |= {t.id for t in tracks.tracks if t.state == "leaves"}
        assert len(track._all) <= 8
        for t in tracks.tracks:
            assert 1 <= t.id <= tracks.n_so_far
            assert np.isfinite([t.vx_cm_s, t.vy_cm_s, t.age_s]).all()


@settings(max_examples=25, deadline=None)
@given(st.lists(st.booleans(), min_size=20, max_size=40), st.integers(0, 99))
def test_dropped_frames_change_no_id(kept, seed):
    """Three objects a gate and more apart, slower than a gate in the longest gap."""
    noise = np.random.default_rng(seed).normal(0.0, 0.05, (len(kept), 3, 2))
    track, last = Track(), 0.0
    for k, keep in enumerate([True, *kept[1:]]):
        if not keep:
            continue
        now = k * DT
        at = [(2.0 + 2.0 * now, 3.0), (10.0, 4.0 + 3.0 * now), (15.0, 15.0)]
        frame = [
            Spot(x + dx, y + dy, 10.0, name)
            for (x, y), (dx, dy), name in zip(at, noise[k], "abc", strict=True)
        ]
        tracks = track(frame, gap_s=now - last)
        last = now
        assert ids_by_name(tracks) == {"a": 1, "b": 2, "c": 3}


def test_an_object_is_told_of_only_once_confirmed_and_its_age_counts_from_the_start():
    track = Track(confirm_frames=3, patience_s=0.0)
    track([Spot(12.0, 12.0), Spot(2.0, 2.0)], gap_s=DT)
    assert track([Spot(2.0, 2.0)], gap_s=DT) == ((), 0, 0)
    tracks = track([Spot(2.0, 2.0)], gap_s=DT)
    assert states(tracks) == {1: "appears"}
    assert tracks.tracks[0].age_s == pytest.approx(2 * DT)


def test_of_too_many_those_unseen_longest_leave():
    track = Track(most=2, patience_s=10.0)
    track([Spot(1.0, 1.0)], gap_s=DT)
    track([Spot(8.0, 8.0)], gap_s=DT)
    assert states(track([Spot(15.0, 15.0)], gap_s=DT)) == {1: "leaves", 3: "appears"}


def test_the_state_a_resting_object_is_in_does_not_flicker_at_the_limit():
    """Between the limit and half as much again an object keeps the state it has."""
    for start, expected in ((0.0, "rests"), (0.2, "moves")):
        track, x = Track(rest_cm_s=5.0), 0.0
        for k in range(150):
            x += start if k < 50 else 6.0 * DT
            tracks = track([Spot(x, 5.0)], gap_s=DT)
        assert tracks.tracks[0].state == expected


@pytest.mark.parametrize("noise_cm", [0.01, 0.15])
@pytest.mark.parametrize("dt_s", [0.01, 0.02, 0.1])
def test_the_speed_of_rest_follows_from_how_centres_scatter(noise_cm, dt_s):
    """Slow objects move where centres are sure, and none that rests stirs where they are not."""
    rng = np.random.default_rng(5)
    track, seen = Track(rest_cm_s="auto"), [Counter(), Counter()]
    for k in range(120):
        off = rng.normal(0.0, noise_cm, (2, 2))
        spots = [Spot(4.0 + off[0, 0], 4.0 + off[0, 1])]
        spots += [Spot(4.0 + 10.0 * dt_s * k + off[1, 0], 12.0 + off[1, 1])]
        for one in track(spots, gap_s=dt_s).tracks:
            seen[one.id - 1][one.state] += 1
    assert seen[0] == {"appears": 1, "rests": 119}
    assert seen[1]["moves"] >= 105


@pytest.mark.parametrize("dt_s", [0.02, 0.1])
def test_a_misplaced_centre_makes_no_object_that_moves_rest(dt_s):
    rng, track, seen = np.random.default_rng(7), Track(rest_cm_s="auto", gate_cm=9.0), []
    for k in range(75):
        x = 4.0 + 8.0 * dt_s * k + (1.5 if k in (40, 41) else 0.0)
        off = rng.normal(0.0, 0.03, 2)
        seen.append(track([Spot(x + off[0], 4.0 + off[1])], gap_s=dt_s).tracks[0].state)
    assert set(seen[45:]) == {"moves"}


def test_sure_centres_let_objects_move_slowly():
    track = Track(rest_cm_s="auto")
    for k in range(100):
        tracks = track([Spot(4.0 + 2.0 * DT * k, 4.0)], gap_s=DT)
    assert states(tracks) == {1: "moves"}


@pytest.mark.parametrize(("dt_s", "frames"), [(0.2, 2), (0.02, 3)])
def test_an_object_unseen_in_one_frame_keeps_its_id_at_any_rate(dt_s, frames):
    track = Track(patience_s="auto")
    for seen in (True, False, True):
        tracks = track([Spot(4.0, 4.0)] if seen else [], gap_s=dt_s)
    assert states(tracks) == {1: "rests"}
    told = [states(track([], gap_s=dt_s)) for _ in range(frames)]
    assert told == [*[{}] * (frames - 1), {1: "leaves"}]


def test_ports_for_an_image_or_a_mask_take_a_track():
    found = contacts(image_of([[1.0, 2.0]]), drawn("##")).contacts
    one = Track()(found).tracks[0]
    assert TrackedObject.provides == {Image: "image", Mask: "mask"}
    assert one.image.total == 3.0
    assert one.mask.count == 2
    assert one.area_cm2 == found[0].area_cm2


def test_what_has_no_centre_is_refused():
    with pytest.raises(DataError, match=r"track: item 1 must have x_cm and y_cm .* got a str"):
        Track()(["here"])
    with pytest.raises(DataError, match="track: item 2: its centre must be finite"):
        Track()([Spot(1.0, 1.0), Spot(math.inf, 1.0)])


PIPELINE = """
pipeline: followed
conditions: {touched: footprint.count > 0}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.5}}
  contacts: {step: contacts, in: [frame, footprint], when: touched}
  tracks: {step: track, in: contacts.contacts, with: {patience_s: 1}}
  sizes: {step: subdivide, in: tracks.tracks, each: true}
outputs: [tracks, sizes]
"""


def pad(time_s, *cells):
    values = np.zeros((8, 8))
    for cell in cells:
        values[cell] = 1.0
    return Frame.of(values, 1.3, quantity="volt", time_s=time_s)


def test_in_a_pipeline_skipped_frames_pass_with_their_true_time():
    """Skipped frames run no step: the gap the tracker is told spans them."""
    run = loads(PIPELINE).runner()
    assert states(run(pad(0.0, (2, 2)))["tracks"]) == {1: "appears"}
    assert "tracks" not in run(pad(0.4))
    again = run(pad(0.8, (2, 2)))["tracks"]
    assert states(again) == {1: "rests"}
    assert again.tracks[0].age_s == pytest.approx(0.8)
    assert "tracks" not in run(pad(1.2))
    other = run(pad(2.4, (6, 6)))
    assert states(other["tracks"]) == {1: "leaves", 2: "appears"}
    assert len(other["sizes"]) == 2


def test_a_source_without_time_counts_frames():
    run = loads(PIPELINE.replace("patience_s: 1", "frame_s: 0.5, patience_s: 1")).runner()
    ages = [run(pad(None, (2, 2)))["tracks"].tracks[0].age_s for _ in range(3)]
    assert ages == pytest.approx([0.0, 0.5, 1.0])


def test_where_times_are_there_only_now_and_then_none_is_counted_twice():
    run = loads(PIPELINE).runner()
    for k in range(6):
        frame = pad(None if k % 2 else k * DT, (2, 2))
        tracks = run(frame)["tracks"]
        assert tracks.tracks[0].age_s == pytest.approx(k * DT)


def test_a_track_is_drawn_with_its_number_and_the_way_it_goes():
    mask = Mask(np.ones((1, 1), bool))
    contact = type("Contact", (), {"mask": mask})()
    moving = TrackedObject(7, "moves", 1.0, 2.0, 3.0, 10.0, -20.0, 1.0, contact)
    rim, way, word = display_list([moving])
    assert (type(rim), type(way), word) == (Rim, Outline, Label(2.0, 3.0, "7"))
    assert way.drawn_cm.tolist() == [[2.0, 3.0], [3.0, 1.0]]
    resting = TrackedObject(8, "rests", 1.0, 2.0, 3.0, 0.0, 0.0, 1.0, contact)
    assert [type(r) for r in display_list([resting])] == [Rim, Label]
