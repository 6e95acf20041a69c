"""Who is chosen by tells nothing of the outcome."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_tune import frames
from tactile_graph.errors import UsageError
from tactile_graph_tune.split import interval_of, split_of


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
