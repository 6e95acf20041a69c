"""Frames count for as many as they stand for."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_tune import frames
from tactile_graph.errors import UsageError
from tactile_graph_tune.search.oracle import Bound, Options
from tactile_graph_tune.shares import EMPTY, Share, parse_share, weights_of
from tactile_graph_tune.table.kinds import Truths

MADE = frames(24, ("easy one", "easy two", "hard"))
SIDES = (np.arange(0, 24, 2), np.arange(1, 24, 2))


def test_without_shares_every_frame_counts_for_one() -> None:
    assert (weights_of(MADE, (), SIDES) == 1.0).all()


def test_shares_hold_on_either_side_and_the_rest_is_left_to_the_others() -> None:
    shares = (Share(EMPTY, 0.7), Share("easy *", 0.2))
    weights = weights_of(MADE, shares, SIDES)
    for rows in SIDES:
        assert weights[rows].mean() == pytest.approx(1.0)
        part = {"empty": 0.0, "easy": 0.0, "hard": 0.0}
        for k in rows:
            part["empty" if not MADE[k].truth else MADE[k].label.split()[0]] += weights[k] / len(
                rows
            )
        assert list(part.values()) == pytest.approx([0.7, 0.2, 0.1])


def test_the_first_share_that_names_a_frame_has_it() -> None:
    weights = weights_of(MADE, (Share("hard", 0.5), Share(EMPTY, 0.3)), SIDES)
    hard = [f.label == "hard" for f in MADE]
    assert weights[hard].sum() == pytest.approx(12.0)


@pytest.mark.parametrize(
    ("shares", "message"),
    [
        ((Share("hrad", 0.5),), "--share hrad=0.5: no frame is of it; did you mean 'hard'"),
        ((Share("hard", 0.5), Share("easy *", 0.6)), "come to 110 %, more than all"),
        ((Share("hard", 1.0),), r"hard 100 % are all, but 16 frames are of none"),
        ((Share("*", 0.5),), r"leave 50 %, but every frame is of one of these kinds"),
    ],
)
def test_shares_that_cannot_be_are_told(shares: tuple[Share, ...], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        weights_of(MADE, shares, SIDES)


def test_a_side_without_a_kind_is_told() -> None:
    with pytest.raises(UsageError, match="but none among the 8 that choose"):
        weights_of(MADE, (Share("hard", 0.5),), (np.arange(8), np.arange(8, 24)))


@pytest.mark.parametrize("text", ["hard", "=0.5", "hard=0", "hard=1.2", "hard=many", "hard=nan"])
def test_what_spells_no_share_is_told(text: str) -> None:
    with pytest.raises(UsageError, match="must be empty=SHARE or LABEL=SHARE"):
        parse_share(text)


def test_a_label_may_hold_an_equals_sign() -> None:
    assert parse_share("weight=3=0.25") == Share("weight=3", 0.25)


def test_a_frame_that_counts_for_three_is_three_frames() -> None:
    rng = np.random.default_rng(5)
    n_each = np.array([1, 3, 2, 1, 4, 1])
    full = np.array([True, True, False, True, False, True])
    times, losses = rng.uniform(1.0, 9.0, (3, 6)), rng.uniform(0.0, 2.4, (3, 6)).clip(max=2.0)
    failed = rng.random((3, 6)) < 0.4
    weighed = Truths(full, 2.0, n_each.astype(float))
    repeated = Truths(np.repeat(full, n_each), 2.0, np.ones(n_each.sum()))

    def each(columns: np.ndarray) -> np.ndarray:
        return np.repeat(columns, n_each, axis=1)

    found = weighed.means(times, losses, failed)
    whole = repeated.means(each(times), each(losses), each(failed))
    for mine, its in zip(found, whole, strict=True):
        assert mine == pytest.approx(its)
    bounds = (Bound(Options(times, losses), weighed),
              Bound(Options(each(times), each(losses)), repeated))  # fmt: skip
    for error in (0.6, 1.0):
        mine, its = (bound.time_at(error, 0.3) for bound in bounds)
        assert mine == pytest.approx(its, rel=1e-5, nan_ok=True)
    assert bounds[0].least_error == pytest.approx(bounds[1].least_error)
