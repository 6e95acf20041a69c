"""What is refused before the search."""

from __future__ import annotations

from dataclasses import replace

import pytest

from helpers_tune import frames
from tactile_graph import Circle, load
from tactile_graph.errors import UsageError
from tactile_graph.wires import TrueObject
from tactile_graph_tune import Request
from tactile_graph_tune.request import Free
from tactile_graph_tune.searching import searched


def test_a_truth_of_something_else_is_refused(hand_made):
    far = (TrueObject(Circle(500.0, 500.0, 1.0)),)
    others = [replace(f, truth=far if f.truth else ()) for f in frames(24)]
    request = Request(load("ladder.yaml"), rounds=1, fields=("load.total",))
    with pytest.raises(UsageError, match="no way to an answer comes within 2 cm"):
        searched(request, others, [], lambda what, n, of: None)


@pytest.mark.slow
def test_frames_held_out_that_choose_too_are_left_out_and_counted(hand_made):
    given = frames(48)
    scaled = [replace(f, image=f.image.with_values(f.image.values * 1.5)) for f in frames(24)]
    request = Request(load("ladder.yaml"), rounds=1, fields=("load.total",))
    found = searched(request, given[:24], [*given[:6], *scaled], lambda what, n, of: None)
    assert found.how == "recordings named for it, less 4 of their frames that choose, too"
    assert len(found.split.reporting) == 26


@pytest.mark.slow
def test_frames_that_two_recordings_hold_are_taken_once_and_counted(hand_made):
    given = frames(48, ("one", "two"))
    again = [replace(f, label="two") for f in given[:6]]
    scaled = [
        replace(f, image=f.image.with_values(f.image.values * 1.5), label="two") for f in given[24:]
    ]
    request = Request(load("ladder.yaml"), rounds=1, fields=("load.total",))
    found = searched(request, [*given[:24], *again, *scaled], [], lambda what, n, of: None)
    assert found.how == "recording by recording, less 4 frames that two of them hold"


def test_frames_held_out_without_a_truth_are_refused_by_what_would_help(hand_made):
    untold = [replace(f, truth=None) for f in frames(8)]
    request = Request(load("ladder.yaml"), rounds=1)
    with pytest.raises(UsageError, match="--held-out: none of 8 frames has a truth to report on"):
        searched(request, frames(24), untold, lambda what, n, of: None)


@pytest.mark.slow
@pytest.mark.parametrize(("given", "taken"), [(0.5, None), (1.5, 0.4)])
def test_of_free_values_that_come_to_the_same_the_given_or_the_middle_one_is_taken(
    hand_made, given, taken
):
    """Every cell that is pressed holds 1 V or more; nothing is as heavy as 1.5 V."""
    pipeline = load("ladder.yaml").with_settings({"footprint.level_v": given})
    free = (Free("footprint.level_v", (0.3, 0.4, 0.6)),)
    request = Request(pipeline, rounds=1, fields=("load.total",), free=free, most_us=1e9,
                      most_missed=1.0, most_false=1.0)  # fmt: skip
    found = searched(request, frames(24), [], lambda what, n, of: None)
    assert found.variants[found.chosen.variant].settings.get("footprint.level_v") == taken
    alike = (0.3, 0.4, 0.6) if taken else (given, 0.3, 0.4, 0.6)
    assert found.as_good == {"footprint.level_v": alike}
