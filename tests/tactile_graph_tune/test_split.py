"""Who is chosen by tells nothing of the outcome."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from helpers_tune import frames
from tactile_graph import Circle, Frame
from tactile_graph.errors import UsageError
from tactile_graph.wires import TrueObject
from tactile_graph_tune.split import halves_of, interval_of, split_of
from tactile_graph_tune.stretches import stretches_of


def test_recordings_stay_whole_on_one_side():
    given = frames(40, ("a", "b", "c", "d"))
    split = split_of(given, 0, seed=0)
    sides = [{given[k].label for k in rows} for rows in (split.choosing, split.reporting)]
    assert sides[0] & sides[1] == set()
    assert sides[0] | sides[1] == {"a", "b", "c", "d"}


def test_of_one_recording_neighbouring_frames_stay_together():
    split = split_of(frames(200), 0, seed=0)
    assert len(split.choosing) == len(split.reporting) == 100
    for start in range(0, 200, 5):
        assert len({k in split.choosing for k in range(start, start + 5)}) == 1


def test_recordings_named_for_it_report():
    split = split_of(frames(20), 8, seed=0)
    assert split.reporting.tolist() == list(range(12, 20))


@pytest.mark.parametrize(("n", "word"), [(1, "1 frame with"), (7, "7 frames with")])
def test_too_few_frames_are_refused(n, word):
    with pytest.raises(UsageError, match=f"{word}.* 8 are needed"):
        split_of(frames(n), 0, seed=0)


def test_an_interval_is_wider_where_frames_of_a_group_are_alike():
    values = np.repeat(np.random.default_rng(2).normal(size=20), 10)
    alone = interval_of(values, np.arange(200), 0)
    together = interval_of(values, np.repeat(np.arange(20), 10), 0)
    assert together.high - together.low > 2.0 * (alone.high - alone.low)
    assert alone.low < alone.mean < alone.high
    assert interval_of(values * 2.0, np.arange(200), 0, values).mean == pytest.approx(2.0)


def test_of_no_frame_that_counts_there_is_no_mean():
    nothing = interval_of(np.ones(9), np.arange(9), 0, np.zeros(9))
    assert np.isnan(nothing).all()
    once = interval_of(np.eye(9)[0], np.arange(9), 0, np.eye(9)[0])
    assert once == (1.0, 1.0, 1.0)  # in draws without that frame, too


def film(scenes: int, held: int, drift: float = 0.0) -> list[Frame]:
    """Return discs that each lie for some frames, where they drift to or from in between."""
    rng = np.random.default_rng(1)
    rows, columns = np.mgrid[:12, :12] + 0.5
    found = []
    for i in range(scenes * held):
        if i % held == 0:
            x, y = rng.uniform(2.0, 10.0, 2)
        x += drift
        values = ((rows - y) ** 2 + (columns - x) ** 2 < 4.0) + rng.normal(0.0, 0.01, (12, 12))
        truth = (TrueObject(Circle(float(x), float(y), 2.0)),)
        found.append(Frame.of(values, quantity="volt", index=i, truth=truth))
    return found


@pytest.mark.parametrize("drift", [0.0, 0.05])
def test_a_press_that_is_held_is_on_one_side(drift: float):
    given = film(15, 4, drift)
    split = split_of(given, 0, seed=0)
    press = np.arange(60) // 4
    assert not set(press[split.choosing]) & set(press[split.reporting])
    assert split.how == "by stretches of neighbouring frames"
    for half in halves_of(given, split, 0):
        assert not set(press[half]) & set(press[np.setdiff1d(split.choosing, half)])


def test_independent_frames_are_cut_as_finely_as_ever():
    assert (np.bincount(stretches_of(film(60, 1))) == 1).all()
    assert (np.bincount(stretches_of(film(200, 1))) == 5).all()


def test_where_scenes_flow_on_stretches_are_long_against_them():
    lengths = np.bincount(stretches_of(film(10, 20, 0.3)))
    assert lengths.min() >= 15
    split = split_of(film(10, 20, 0.3), 0, seed=0)
    assert split.how == "by stretches of neighbouring frames"


@pytest.mark.parametrize("n_apart", [0, 20])
def test_where_nothing_changes_it_says_so(n_apart: int):
    split = split_of(film(1, 40), n_apart, seed=0)
    assert "the scene hardly changes" in split.how
    assert len(np.unique(split.groups[split.reporting])) >= 4


def test_images_of_different_shapes_are_cut_where_the_truth_changes():
    given = film(20, 2)
    given[3:4] = [replace(given[3], image=film(1, 1)[0].image.with_values(np.ones((2, 2))))]
    assert stretches_of(given).tolist() == np.repeat(np.arange(20), 2).tolist()
