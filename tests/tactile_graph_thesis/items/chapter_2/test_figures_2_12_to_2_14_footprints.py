"""Sand takes an object's image away, foam evens it out and blurs its edge."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph_pads.geometry import Geometry
from tactile_graph_pads.pad import load_pad
from tactile_graph_thesis.items.chapter_2.figures_2_12_to_2_14_footprints import (
    GRAIN,
    bump,
    edge_contrast,
    foam,
    unevenness,
)

PAD = load_pad("thesis")


def rng() -> np.random.Generator:
    return np.random.default_rng(3)


def test_the_weight_stays_the_same_and_most_of_it_goes_to_the_grain() -> None:
    found = bump(PAD, rng())
    assert found.before_g.sum() == pytest.approx(2000.0)
    assert found.after_g.sum() == pytest.approx(2000.0)
    assert found.after_g[GRAIN.row, GRAIN.column] >= 0.9 * 2000.0
    assert found.after_v.argmax() == GRAIN.row * 16 + GRAIN.column


def test_the_disc_without_sand_does_not_rest_on_one_element() -> None:
    found = bump(load_pad("plain"), rng())
    assert found.before_g.max() < 0.2 * 2000.0


def test_a_pad_without_the_grains_element_is_told() -> None:
    flat = replace(load_pad("plain"), geometry=Geometry(5, 40, 0.8, 0.45))
    with pytest.raises(UsageError, match="not on the pad of 5 rows and 40 columns"):
        bump(flat, rng())


def test_foam_keeps_the_weight_and_reaches_beyond_the_disc() -> None:
    found = foam(PAD, rng())
    assert found.after_g.sum() == pytest.approx(1860.0)
    outside = found.covered == 0.0
    assert found.before_g[outside].sum() == 0.0
    assert found.after_g[outside].sum() > 100.0


def test_foam_evens_out_and_blurs() -> None:
    found = foam(PAD, rng())
    assert unevenness(found.after_v, found.covered) < 0.6 * unevenness(
        found.before_v, found.covered
    )
    assert edge_contrast(found.after_v, found.covered) < 0.8 * edge_contrast(
        found.before_v, found.covered
    )


def test_a_sharp_even_footprint_has_full_contrast_and_no_unevenness() -> None:
    covered = np.zeros((8, 8))
    covered[2:6, 2:6] = 1.0
    assert edge_contrast(covered, covered) == 1.0
    assert unevenness(covered, covered) == 0.0
    assert edge_contrast(np.ones((8, 8)), covered) == 0.0
