"""Reliefs are learned, go on beyond what was touched, and tell objects and strangers apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from helpers_reliefs import (
    SHAPE,
    STRIP,
    STRIP_LAW,
    THINGS,
    Pad,
    Thing,
    as_presses,
    bowl,
    disc,
    pressed_on_a_strip,
    relief,
)
from tactile_graph_classifiers.reliefs import learning
from tactile_graph_classifiers.reliefs.beyond import deepest, extend
from tactile_graph_classifiers.reliefs.choosing_law import chosen_law
from tactile_graph_classifiers.reliefs.kernels import NODES
from tactile_graph_classifiers.reliefs.learning import learn_reliefs, learned, unlearned_pad
from tactile_graph_classifiers.reliefs.leaving_out import left_out_misfits, parts_of
from tactile_graph_classifiers.reliefs.naming import misfits_to
from tactile_graph_classifiers.reliefs.presses import Presses
from tactile_graph_classifiers.reliefs.relief import still


def test_a_relief_goes_on_as_it_rises_and_never_touches():
    whole, press = bowl(), np.array([[10.0, 6.0, 0.0, 0.4, 0.0, 0.0]])
    found = relief(np.where(whole < 0.4, whole, 0.45), press, [1.0])
    extend(found, as_presses(np.zeros((1, *SHAPE)), [[0, 0, *SHAPE]], press[:, :2]))
    touched = whole < 0.39
    np.testing.assert_array_equal(found.depth[touched], whole[touched])
    beyond = found.depth[30, 36:41]  # from 2 to 3.3 cells
    assert (np.diff(beyond) > 0.0).all()
    assert beyond[-1] > 0.6
    assert found.depth[~touched].min() >= 0.39


def test_presses_that_fit_badly_tell_of_no_place():
    presses = np.array([[10.0, 6.0, 0.0, deep, 0.0, 0.0] for deep in (0.4, 0.4, 0.4, 9.0)])
    found = relief(bowl(), presses, [1.0, 1.0, 1.0, 50.0])
    boxes = np.array([[2, 5, 8, 10]] * 4)
    below = deepest(found, as_presses(np.zeros((4, *SHAPE)), boxes, presses[:, :2]))
    assert below.max() == 0.4
    assert below[30, 30 + 4 * NODES] == 0.4
    assert below[30, 30 + 6 * NODES] == -np.inf  # beside the box


def test_still_cells_have_their_misfit_by_themselves():
    values = np.zeros((1, *SHAPE))
    values[0, 4:6, 4:8] = 0.5
    values[0, 0, :] = 0.01
    presses = as_presses(values, [[0, 0, *SHAPE]], [[6.0, 5.0]])
    misfits, n_felt = still(presses, np.full(values.shape, 200.0**2))
    assert misfits[0] == pytest.approx(20 * 2.0**2)
    assert n_felt[0] == 8


@pytest.mark.parametrize("n", [1, 4, 5, 12, 25, 26])
def test_presses_are_left_out_in_runs_of_like_length(n):
    parts = parts_of(n)
    assert (np.diff(parts) >= 0).all()
    counts = np.bincount(parts)
    assert len(counts) == min(n, 5)
    assert np.ptp(counts) <= 1


@pytest.mark.slow
def test_objects_are_learned_told_apart_and_found_again_when_left_out():
    shown = pressed_on_a_strip(THINGS, 12, seed=5)
    all_presses = [Presses.of(some[:10], STRIP.full_scale) for some in shown]
    reliefs, pad = learn_reliefs(all_presses, STRIP_LAW, lambda _: None)
    left = left_out_misfits(reliefs, all_presses, pad, lambda _: None)
    for k, some in enumerate(shown):
        far = misfits_to(reliefs, pad, Presses.of(some[10:], STRIP.full_scale))
        assert (far.argmin(axis=1) == k).all()
        assert (far[:, 1 - k] > 3.0 * far[:, k]).all()
        assert np.isfinite(left[k]).all()
        assert np.median(left[k]) < 2.0 * np.median(far[:, k])


@pytest.mark.slow
def test_noise_near_zero_is_not_taken_for_readings_that_vary():
    coarse = replace(STRIP, full_scale=150.0, noise_counts=1.0, zero_counts=0.0)
    pad = Pad(coarse, np.random.default_rng(5))
    shown = [[np.array(pad.press(t).image.values, float) for _ in range(10)] for t in THINGS]
    all_presses = [Presses.of(some, coarse.full_scale) for some in shown]
    _, learned_pad = learn_reliefs(all_presses, STRIP_LAW, lambda _: None)
    assert np.sqrt(learned_pad.variances[0]) == pytest.approx(1.0 / 150.0, rel=0.4)
    assert np.sqrt(learned_pad.variances[1]) < 0.15


def test_the_round_that_explains_most_is_kept(monkeypatch):
    values = np.zeros((8, *SHAPE))
    values[:, 4:8, 6:12] = 0.5
    presses = as_presses(values, [[1, 3, 10, 12]] * 8, [[9.0, 6.0]] * 8)
    vary = iter([0.3, 0.1, 0.7])

    def worked_on(presses, pad, before, place=0):
        it = before or relief(bowl(), np.zeros((8, 6)), np.zeros(8), usual=0.0)
        it.usual += 1.0  # in place, as rounds do
        return it

    monkeypatch.setattr(learning, "learned", worked_on)
    monkeypatch.setattr(learning, "improved", lambda pad, *_: replace(
        pad, variances=np.array([1e-6, next(vary) ** 2, 1e-6])))  # fmt: skip
    monkeypatch.setattr(learning, "refit", lambda *_: None)
    (found,), pad = learn_reliefs([presses], STRIP_LAW, lambda _: None)
    assert (found.usual, round(float(np.sqrt(pad.variances[1])), 6)) == (2.0, 0.1)


@pytest.mark.slow
def test_the_law_comes_out_of_the_presses():
    all_presses = [Presses.of(some, STRIP.full_scale)
                   for some in pressed_on_a_strip(THINGS, 12, seed=8)]  # fmt: skip
    law = chosen_law(all_presses, lambda _: None)
    assert law.blur_cells == pytest.approx(STRIP.blur_cells, rel=0.2)
    assert law.power == pytest.approx(STRIP.law, abs=0.15)


@pytest.mark.slow
def test_a_small_object_that_reads_full_scale_is_learned():
    (shown,) = pressed_on_a_strip([Thing("coin", disc(0.8), 0.6)], 12, seed=6)
    presses = Presses.of(shown, STRIP.full_scale)
    assert np.median(presses.values.max(axis=(1, 2))) > 0.99
    found = learned(presses, unlearned_pad([presses], STRIP_LAW))
    assert np.median(found.misfits / presses.n_cells()) < 2.0
