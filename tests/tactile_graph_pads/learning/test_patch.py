"""Patches: what surrounds a contact, wherever between the cells it lies."""

import numpy as np
import pytest

from tactile_graph_pads.learning.patch import FEW, PatchKind, patches, place_terms

SHAPE = (22, 26)


def bump(x, y, width=2.0, height=50.0):
    row, column = np.mgrid[: SHAPE[0], : SHAPE[1]]
    return height * np.exp(-((column - x) ** 2 + (row - y) ** 2) / (2 * width**2))


GOOD = np.ones(SHAPE, bool)


@pytest.mark.parametrize("window", [0.0, 1.5])
def test_a_patch_moves_with_its_contact_and_does_not_know_its_height(window):
    kind = PatchKind(4, 1.0, 0.7, window)
    first, _ = patches(bump(10.0, 9.0), GOOD, np.array([(10.0, 9.0)]), kind)
    second, at = patches(bump(13.0, 11.0, height=400.0), GOOD, np.array([(13.0, 11.0)]), kind)
    assert second == pytest.approx(first, abs=1e-6)
    assert at == pytest.approx(np.array([(13.0, 11.0)]), abs=1e-6)
    between, _ = patches(bump(10.4, 9.3), GOOD, np.array([(10.4, 9.3)]), kind)
    assert between == pytest.approx(first, abs=0.01)


def test_the_window_finds_the_middle_from_beside_it():
    kind = PatchKind(4, 1.0, 1.0, 2.0)
    _, at = patches(bump(10.4, 9.3), GOOD, np.array([(11.0, 8.6)]), kind)
    assert at == pytest.approx(np.array([(10.4, 9.3)]), abs=0.01)


def test_what_lies_nearer_to_another_contact_is_left_out():
    kind = PatchKind(4)
    alone, _ = patches(bump(9.0, 9.0), GOOD, np.array([(9.0, 9.0)]), kind)
    two = bump(9.0, 9.0) + bump(20.0, 9.0)
    beside, _ = patches(two, GOOD, np.array([(9.0, 9.0), (20.0, 9.0)]), kind)
    assert beside[0] == pytest.approx(alone[0], abs=0.002)


def test_a_bad_element_takes_what_lies_beside_it():
    kind, values, good = PatchKind(3), bump(10.3, 9.4, width=3.0), GOOD.copy()
    whole, _ = patches(values, GOOD, np.array([(10.3, 9.4)]), kind)
    good[10, 11], values[10, 11] = False, 0.0
    holed, _ = patches(values, good, np.array([(10.3, 9.4)]), kind)
    zeroed, _ = patches(values, GOOD, np.array([(10.3, 9.4)]), kind)
    assert np.abs(holed - whole).max() < 0.25 * np.abs(zeroed - whole).max()


def test_points_further_apart_than_a_cell_see_smoothed_readings():
    noisy = bump(12.0, 11.0, width=5.0) + np.random.default_rng(0).normal(0.0, 5.0, SHAPE)
    clean, _ = patches(
        bump(12.0, 11.0, width=5.0), GOOD, np.array([(12.0, 11.0)]), PatchKind(3, 2.0)
    )
    seen, _ = patches(noisy, GOOD, np.array([(12.0, 11.0)]), PatchKind(3, 2.0))
    assert np.std(seen - clean) < 0.1 * clean.max()


def test_nothing_around_is_no_error():
    taken, at = patches(np.zeros(SHAPE), GOOD, np.array([(3.0, 4.0)]), PatchKind(3, 1.0, 0.5, 1.5))
    assert not taken.any()
    assert at.tolist() == [[3.0, 4.0]]


def test_place_terms_go_from_minus_one_to_one_over_the_pad():
    terms = place_terms(np.array([(0.0, 0.0), (25.0, 21.0), (12.5, 10.5)]), SHAPE)
    assert terms[:, :3].tolist() == [[1, -1, -1], [1, 1, 1], [1, 0, 0]]
    assert terms.shape == (3, 10)
    assert np.isfinite(place_terms(np.array([(0.0, 0.0)]), (1, 1))).all()


@pytest.mark.parametrize("kind", [PatchKind(3), PatchKind(4, 1.7, 0.7, 1.5)], ids=["own", "window"])
def test_many_contacts_have_the_patches_they_have_on_the_whole_pad(kind, monkeypatch):
    rng = np.random.default_rng(2)
    values, good = rng.random((40, 50)), rng.random((40, 50)) > 0.05
    # Cells as far from several contacts as from one, and two contacts in one place.
    centres = np.array([(x, y) for y in range(4, 40, 8) for x in range(4, 50, 8)], float)
    centres = np.vstack([centres, centres[:1]])
    assert len(centres) > FEW
    near, at = patches(values, good, centres, kind)
    monkeypatch.setattr("tactile_graph_pads.learning.patch.FEW", len(centres))
    monkeypatch.setattr(PatchKind, "margin", 1000)
    whole, at_whole = patches(values, good, centres, kind)
    assert near == pytest.approx(whole, abs=1e-12)
    assert at == pytest.approx(at_whole, abs=1e-12)
    assert np.abs(near).sum(axis=1).astype(bool).sum() == len(centres) - 1
