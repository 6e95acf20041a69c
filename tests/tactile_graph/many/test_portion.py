"""Frames on their way to a worker."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import Circle, Frame, Image
from tactile_graph.many.portion import Portion, packed, unpacked
from tactile_graph.wires import TrueObject


def same(a: Frame, b: Frame) -> bool:
    names = ("index", "time_s", "truth", "device_time_s", "gap", "label", "doubtful")
    valid = [f.image.valid for f in (a, b)]
    return (
        all(getattr(a, n) == getattr(b, n) for n in names)
        and a.image.values.tobytes() == b.image.values.tobytes()
        and a.image.values.flags.f_contiguous == b.image.values.flags.f_contiguous
        and (a.image.pitch_cm, a.image.quantity) == (b.image.pitch_cm, b.image.quantity)
        and (valid[0] is None) == (valid[1] is None)
        and not b.image.values.flags.writeable
    )


def frames(order: str, hole: bool, n: int = 4) -> list[Frame]:
    rng = np.random.default_rng(0)
    found = []
    for k in range(n):
        values = np.asarray(rng.random((3, 5)), order=order)  # type: ignore[call-overload]
        valid = values > 0.5 if hole and k == 2 else None
        image = Image(values, (0.5, 0.7), (0.0, 1.0), "volt", valid)
        truth = (TrueObject(Circle(1.0, 1.0, 1.0)),) if k else None
        found.append(Frame(image, k, 0.1 * k, truth, None, k == 1, "left", k == 3))
    return found


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("hole", [False, True])
def test_frames_arrive_as_they_were_sent(order: str, hole: bool) -> None:
    sent = frames(order, hole)
    came = unpacked(packed(sent))
    assert len(came) == 4
    assert all(map(same, sent, came))


def test_no_frames_are_none() -> None:
    assert unpacked(packed([])) == []


def test_frames_of_a_kind_take_little_more_than_their_values() -> None:
    sent = [Frame.of(np.ones((16, 16)), index=k) for k in range(100)]
    assert len(packed(sent)) < 1.1 * 100 * 16 * 16 * 8


def test_a_portion_is_cut_and_loses_frames() -> None:
    portion = Portion(10, 20).first(5).leaving_out(frozenset({12}))
    assert (portion.low, portion.high, portion.n_frames) == (10, 15, 5)
    assert portion.leaving_out(frozenset({13})).without == {12, 13}
