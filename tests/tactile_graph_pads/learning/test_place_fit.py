"""A correction of place: what it finds, what it states, what it leaves alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph.errors import DataError
from tactile_graph_pads.learning.place import read_place, write_place
from tactile_graph_pads.learning.place_fit import (
    LearnedPlace,
    known_contacts,
    learned_place,
    unlike_halves,
)

pytestmark = pytest.mark.slow

SHAPE = (16, 22)
GOOD = np.ones(SHAPE, bool)


def contacts(n, tail, seed=0, noise=0.2):
    """Return frames of one contact with a tail of any length to the right, and true places."""
    rng = np.random.default_rng(seed)
    row, column = np.mgrid[: SHAPE[0], : SHAPE[1]]
    frames, true = [], []
    for _ in range(n):
        x, y, length = rng.uniform(5, 15), rng.uniform(4, 12), tail * rng.uniform(0.0, 1.0)
        values = noise * rng.standard_normal(SHAPE)
        for at, part in ((x, 1.0), (x + 2.0, length)):
            values += 40.0 * part * np.exp(-((column - at) ** 2 + (row - y) ** 2) / 5.0)
        frames.append(values)
        true.append(np.array([(x, y)]))
    return frames, true


def learned(n=90, tail=0.6, seed=0, noise=0.2) -> LearnedPlace:
    frames, true = contacts(n, tail, seed, noise)
    return learned_place(known_contacts(frames, true, np.arange(n) // 3, 5.0), GOOD)


@pytest.fixture(scope="module")
def usual() -> LearnedPlace:
    return learned()


@pytest.fixture(scope="module")
def of_few() -> LearnedPlace:
    return learned(n=40)


@pytest.mark.slow
def test_what_a_tail_draws_along_is_taken_off_where_it_was_not_learned(
    usual: LearnedPlace,
) -> None:
    found = usual
    assert found.helps
    assert found.n_groups == 30
    frames, true = contacts(60, 0.6, seed=9)
    off, before, stated = [], [], []
    for values, places in zip(frames, true, strict=True):
        start = known_contacts([values], [places], np.zeros(1, np.int64), 5.0).centres
        told = found.correction.correct(values, GOOD, start)
        off.append((told.centres - places)[0])
        before.append((start - places)[0])
        stated.append(told.std_cells[0])
    assert np.hypot(*np.array(off).T).mean() < 0.3 * np.hypot(*np.array(before).T).mean()
    assert 1 / 1.5 < np.sqrt(np.mean((np.array(off) / np.array(stated)) ** 2)) < 1.5


@pytest.mark.slow
def test_the_errors_held_out_are_those_of_contacts_not_learned(usual: LearnedPlace) -> None:
    found = usual
    frames, true = contacts(200, 0.6, seed=9)
    fresh = learned_place(known_contacts(frames, true, np.arange(200), 5.0), GOOD)
    assert found.blocks.off.mean() == pytest.approx(fresh.blocks.off.mean(), rel=0.5)
    assert len(found.blocks.off) == 90
    assert found.halves.over_stated == pytest.approx(1.0)


@pytest.mark.slow
def test_an_unlike_contact_is_told_less_surely(usual: LearnedPlace) -> None:
    found = usual
    frames, true = contacts(1, 0.3, seed=5)
    at = true[0]
    usual = found.correction.correct(frames[0], GOOD, at).std_cells
    row, column = np.mgrid[: SHAPE[0], : SHAPE[1]]
    ring = 40.0 * (np.abs(np.hypot(column - at[0, 0], row - at[0, 1]) - 3.0) < 0.8)
    assert (found.correction.correct(ring, GOOD, at).std_cells > 1.5 * usual).all()


def test_no_contacts_are_no_answer(of_few: LearnedPlace) -> None:
    none = of_few.correction.correct(np.zeros(SHAPE), GOOD, np.zeros((0, 2)))
    assert none.centres.shape == none.std_cells.shape == (0, 2)


def test_halves_are_whole_groups_and_tell_each_other() -> None:
    taken, group = np.random.default_rng(0).standard_normal((60, 9)), np.repeat(np.arange(12), 5)
    folds = unlike_halves(taken, group)
    assert len(folds) == 6
    for learned_from, told in folds:
        assert (learned_from ^ told).all()
        assert not set(group[learned_from]) & set(group[told])
        assert 0.3 < told.mean() < 0.7


def test_a_correction_comes_back_from_its_file(of_few: LearnedPlace, tmp_path: Path) -> None:
    made = of_few.correction
    write_place(tmp_path / "p.npz", made)
    back = read_place(tmp_path / "p.npz")
    frames, true = contacts(1, 0.6)
    for a, b in zip(
        made.correct(frames[0], GOOD, true[0]), back.correct(frames[0], GOOD, true[0]), strict=True
    ):
        assert a == pytest.approx(b)


def test_a_file_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "p.npz").write_bytes(b"PK nonsense")
    with pytest.raises(DataError, match=r"p.npz: the correction of place cannot be read"):
        read_place(tmp_path / "p.npz")
    np.savez(tmp_path / "q.npz", weights=np.zeros(3))
    with pytest.raises(DataError, match="cannot be read"):
        read_place(tmp_path / "q.npz")


def test_places_told_of_frames_in_which_nothing_touches_are_not_held_against_them() -> None:
    frames, true = contacts(20, 0.6)
    empty = [0.2 * np.random.default_rng(9).standard_normal(SHAPE)] * 60
    known = known_contacts([*frames, *empty], [*true, *true * 3], np.arange(80) // 4, 5.0)
    assert (known.n_told, known.n_met, known.unlike) == (20, 20, False)
    beside = known_contacts(frames, [p + 9.0 for p in true], np.arange(20), 5.0)
    assert beside.n_told == 20
    assert beside.unlike
