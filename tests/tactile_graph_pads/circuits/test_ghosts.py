"""Readings where one object's rows cross another's columns: of a floating matrix, of no other."""

import re

import numpy as np
import pytest

from helpers_ghosts import DIAGONAL, SIDE, alone, divider, network, share
from helpers_ghosts import read as image_of
from helpers_modes import plainly
from tactile_graph_pads.circuits.ghosts import (
    EVERY,
    GHOSTS,
    NONE,
    UNTOLD,
    ghosts,
    ghosts_in,
    ghosts_told,
)


def read(shares, **told):
    """Return readings above what most elements read bare, and which show."""
    values = image_of(shares, **told).values
    above = values - np.median(values[-3:])
    shows = above > 2.5
    return np.where(shows, above, 0.0), shows


def of(above, shows, known=EVERY):
    """Return what plain code finds; loops find the same."""
    found = ghosts.reference(above, shows, known)
    assert plainly(ghosts)(above, shows, known) == found
    return found


@pytest.mark.parametrize("rest", [1e-7, 3e-7, 1e-6])
@pytest.mark.parametrize("gains", [0.05, 0.25, 0.5])
def test_two_on_a_diagonal_of_a_floating_matrix_make_ghosts(rest, gains):
    for seed in range(5):
        assert of(*read(share(DIAGONAL), rest=rest, gains=gains, seed=seed)) == GHOSTS


@pytest.mark.parametrize("circuit", [alone, divider])
def test_they_make_none_on_other_pads(circuit):
    for seed in range(10):
        assert of(*read(share(DIAGONAL), gains=0.5, seed=seed, circuit=circuit)) == NONE


def test_one_object_tells_nothing_whatever_the_pad():
    for circuit in (network, alone):
        assert of(*read(share([(8.0, 8.0, 3.0)]), circuit=circuit)) == UNTOLD
    assert of(np.zeros((16, 16)), np.zeros((16, 16), np.bool_)) == UNTOLD
    assert of(np.ones((1, 9)), np.ones((1, 9), np.bool_)) == UNTOLD


def test_an_angle_is_no_ghost_though_its_arms_cross():
    """An L has rows of one arm and columns of the other where it is bare."""
    angle = np.zeros((SIDE, SIDE))
    angle[2:13, 2:5] = angle[10:13, 2:13] = 1.0
    assert of(*read(angle, circuit=alone)) == NONE


def test_what_reads_around_objects_too_is_no_ghost():
    """Under a cover loads fade out to all sides, not along rows and columns alone."""
    above, _ = read(share(DIAGONAL), circuit=alone)
    y, x = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    far = np.min([np.hypot(x - cx, y - cy) for cx, cy, _ in DIAGONAL], axis=0)
    faded = np.maximum(above, 0.3 * above.max() * np.exp(-far / 8.0))
    assert of(faded, faded > 2.5) == NONE


def test_a_light_object_at_a_crossing_is_no_ghost():
    loads = share(DIAGONAL) + 0.2 * share([(11.3, 4.1, 2.3)])
    assert of(*read(loads, circuit=alone)) == NONE


def test_elements_that_do_not_count_tell_nothing():
    above, shows = read(share(DIAGONAL))
    known = np.ones_like(shows)
    known[:8, 8:] = known[8:, :8] = False
    assert of(above, shows, known) == UNTOLD


def recorded(circuit, lying, n=12):
    """Return frames of an object and another on a diagonal of it, above what elements rest at."""
    values = np.stack([image_of(share(lying), seed=k, circuit=circuit).values for k in range(n)])
    return values - np.median(values[:, -3:])


def test_several_frames_are_said_to_hold_ghosts():
    every = np.ones((SIDE, SIDE), np.bool_)
    assert ghosts_in(recorded(network, DIAGONAL), 2.5, every) == (12, 12)
    assert ghosts_in(recorded(alone, DIAGONAL), 2.5, every) == (0, 12)
    assert ghosts_in(recorded(network, DIAGONAL[:1]), 2.5, every) == (0, 0)
    assert ghosts_in(np.empty((0, SIDE, SIDE)), 2.5, every) == (0, 0)
    words = r"^12 of 20 frames .* may be a matrix without isolation; .*circuit: \{kind: floating"
    assert re.search(words, ghosts_told(12, 20))
    assert ghosts_told(2, 2) == ghosts_told(9, 20) == ghosts_told(0, 0) == ""
