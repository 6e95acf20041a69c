"""``Work``: what items share is done once, and is the same for the same settings."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_thesis.work import Work


def test_work_shared_by_items_is_done_once() -> None:
    calls = []
    work = Work()
    for _ in range(2):
        assert work.once("x", lambda: calls.append(1) or 7) == 7
    assert calls == [1]
    assert Work(readings=12).group == 12
    assert Work(readings=100).group == 20


def test_frames_are_as_many_and_carry_the_truth() -> None:
    frames = Work(seed=4, readings=20).frames("discs", 6)
    assert [f.truth[0].name for f in frames if f.truth] == ["DISC I", "DISC II", "DISC III"] * 2
    again = Work(seed=4, readings=20).frames("discs", 6)
    assert all(
        np.array_equal(a.image.values, b.image.values) for a, b in zip(frames, again, strict=True)
    )


def test_a_study_has_randomness_of_its_own_on_the_pad_asked_for() -> None:
    def drawn(pad: Pad, rng: np.random.Generator) -> tuple[bool, float]:
        return pad == load_pad("plain"), float(rng.random())

    first = np.random.default_rng(3).random()
    work = Work(seed=3, pad_name="plain")
    assert work.on_pad(drawn) == work.on_pad(drawn) == (True, first)


def test_frames_are_read_on_the_pad_asked_for() -> None:
    usual, even = (Work(pad_name=name).frames("discs", 3) for name in ("thesis", "plain"))
    assert not np.array_equal(usual[0].image.values, even[0].image.values)


def test_a_pad_that_is_not_there_is_told() -> None:
    with pytest.raises(UsageError, match="did you mean 'thesis'"):
        Work(pad_name="thesi").pad  # noqa: B018
