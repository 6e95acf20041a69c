"""Faults of a pad as built."""

import numpy as np
import pytest

from tactile_graph_pads.defects import Defects, Hot
from tactile_graph_pads.geometry import Geometry

PAD = Geometry()


def test_a_pad_without_faults_changes_nothing():
    built = Defects().built(PAD, np.random.default_rng(0))
    assert (built.gain == 1.0).all()
    assert (built.leak_s == 0.0).all()
    assert (built.preload_g == 0.0).all()
    assert (built.noise == 1.0).all()


def test_dead_lines_and_elements_conduct_nothing_not_even_a_leak():
    faults = Defects(
        dead_rows=(2,), dead_columns=(15,), dead_elements=((4, 5),), hot=(Hot(2, 3, 1e3),)
    )
    built = faults.built(PAD)
    assert (built.gain[2] == 0.0).all()
    assert (built.gain[:, 15] == 0.0).all()
    assert built.gain[4, 5] == 0.0
    assert (built.gain == 0.0).sum() == 16 + 15 + 1
    assert (built.leak_s == 0.0).all()


def test_a_hot_element_has_its_leak():
    built = Defects(hot=(Hot(2, 3, 2e3),)).built(PAD)
    assert built.leak_s[2, 3] == pytest.approx(5e-4)
    assert built.leak_s.sum() == pytest.approx(5e-4)


def test_row_and_column_gains_multiply():
    rows, columns = tuple(np.linspace(0.5, 1.5, 16)), tuple(np.linspace(1.0, 3.0, 16))
    built = Defects(row_gain=rows, column_gain=columns).built(PAD)
    np.testing.assert_allclose(built.gain, np.outer(rows, columns))


def test_random_gains_have_the_structure_asked_for():
    rng = np.random.default_rng(0)
    lines = np.log(Defects(row_gain_sigma=0.3).built(Geometry(400, 4), rng).gain)
    assert (lines == lines[:, :1]).all()
    assert lines[:, 0].std() == pytest.approx(0.3, rel=0.15)
    elements = np.log(Defects(element_gain_sigma=0.4).built(Geometry(60, 60), rng).gain)
    assert elements.std() == pytest.approx(0.4, rel=0.1)
    assert (Defects(column_gain_sigma=0.3).built(PAD).gain == 1.0).all()


def test_a_preload_can_vary_from_element_to_element():
    built = Defects(preload_g=20.0, preload_sigma=0.8).built(PAD, np.random.default_rng(1))
    assert np.median(built.preload_g) == pytest.approx(20.0, rel=0.2)
    assert built.preload_g.max() > 60.0
    assert (Defects(preload_g=20.0, preload_sigma=0.8).built(PAD).preload_g == 20.0).all()


def test_noisy_rows_scatter_more():
    noise = Defects(noisy_rows=(3,), noise_factor=10.0).built(PAD).noise
    assert (noise[3] == 10.0).all()
    assert (np.delete(noise, 3, axis=0) == 1.0).all()
