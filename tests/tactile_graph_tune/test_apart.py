"""No frame that is chosen by is reported on."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from helpers_cli import call
from helpers_tune import frames
from tactile_graph import Frame
from tactile_graph.errors import UsageError
from tactile_graph_tune.apart import check_recordings, without_repeats, without_seen


@pytest.fixture
def named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A recording, a copy of it, a link to it and another one of its size."""
    monkeypatch.chdir(tmp_path)
    np.save("a.npy", np.ones((9, 2, 2)))
    np.save("other.npy", np.zeros((9, 2, 2)))
    shutil.copy("a.npy", "copy.npy")
    Path("link.npy").symlink_to("a.npy")


@pytest.mark.usefixtures("named")
@pytest.mark.parametrize(
    ("choosing", "held_out", "message"),
    [
        (["a.npy"], ["a.npy"], "--held-out a.npy: is the same file as a.npy, which is chosen by"),
        (["other.npy", "./a.npy"], ["link.npy"], "is the same file as ./a.npy"),
        (["other.npy", "a.npy"], ["copy.npy"], "has the same content as a.npy"),
        (["other.npy"], ["a.npy", "copy.npy"], "hold each recording out once"),
        (["other.npy", "a.npy", "copy.npy"], [], "copy.npy: has the same content as a.npy; of"),
        (["a.npy", "copy.npy"], ["other.npy"], ""),
        (["a.npy", "other.npy"], [], ""),
        (["a.npy"], ["missing.npy"], ""),
    ],
)
def test_a_recording_that_is_chosen_by_is_not_reported_on(
    choosing: list[str], held_out: list[str], message: str
) -> None:
    if not message:
        check_recordings(choosing, held_out)
        return
    with pytest.raises(UsageError) as raised:
        check_recordings(choosing, held_out)
    assert message in str(raised.value)


def test_of_a_converted_copy_the_frames_that_choose_are_left_out() -> None:
    given = frames(12)
    fresh = [replace(f, image=f.image.with_values(f.image.values * 1.5)) for f in given]
    assert without_seen(given, fresh) == fresh
    left = without_seen(given[:6], [*given, *fresh])
    seen = {f.image.values.tobytes() for f in given[:6] if f.truth}
    assert not any(f.truth and f.image.values.tobytes() in seen for f in left)
    assert [f for f in left if not f.truth] == [f for f in [*given, *fresh] if not f.truth]


def test_where_nothing_else_is_held_out_it_says_what_to_do() -> None:
    with pytest.raises(UsageError, match=r"all 8 frames .* are chosen by: name a recording of oth"):
        without_seen(frames(12), frames(12))


def test_of_two_recordings_that_hold_a_frame_only_one_keeps_it() -> None:
    one = [replace(f, label="one") for f in frames(12)]
    fresh = [replace(f, image=f.image.with_values(f.image.values * 1.5)) for f in frames(6)]
    two = [replace(f, label="two") for f in [*frames(6), *fresh]]
    left = without_repeats([*one, *two])
    assert left[:12] == one
    assert left[12:] == [f for f in two if not f.truth or f in two[6:]]
    assert without_repeats(frames(200))[199].index == 199  # in one recording they may recur


def test_a_recording_of_which_another_holds_all_is_refused() -> None:
    both = [replace(f, label=label) for label in ("one.npz", "two.npz") for f in frames(12)]
    with pytest.raises(UsageError, match=r"two.npz: all 8 frames .* of one.npz; .* give each once"):
        without_repeats(both)


def test_what_leaves_all_cells_alike_is_no_frame_of_another_recording() -> None:
    def alike(label: str, frame: Frame) -> Frame:
        return replace(frame, label=label, image=frame.image.with_values(np.zeros((4, 4))))

    one = [replace(f, label="one") for f in frames(12)]
    light = [alike(label, f) for label in ("one", "two") for f in frames(12) if f.truth]
    assert without_repeats([*one, *light]) == [*one, *light]


def test_the_command_refuses_it(hand_made: Path) -> None:
    Path("one.txt").write_text("1\n" * 9)
    got = call("tune", "ladder.yaml", "one.txt", "--held-out", "one.txt")
    assert got.exit_code == 2
    assert "--held-out one.txt: is the same file as one.txt" in " ".join(got.output.split())
    assert "leave --held-out away" in " ".join(got.output.split())
