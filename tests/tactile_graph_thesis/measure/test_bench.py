"""A pad on the bench: what it reads is the pad's own forward model with its noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_thesis.measure.bench import Bench


@pytest.mark.parametrize("repeatability", [0.0, 0.05])
def test_elements_repeat_as_well_as_the_law_says_and_no_number_is_drawn_if_exactly(
    repeatability: float,
) -> None:
    pad = load_pad("thesis")
    pad = replace(pad, law=replace(pad.law, repeatability=repeatability))
    load_g = np.full(pad.geometry.shape, 100.0)
    bench = Bench(pad, np.random.default_rng(1))
    before = bench.rng.bit_generator.state
    read = bench.volts(load_g)
    same = np.random.default_rng(1)
    same.bit_generator.state = before
    siemens = pad.conductance_s(load_g, bench.built)
    if repeatability:
        siemens = siemens * np.exp(repeatability * same.standard_normal(siemens.shape))
    counts = pad.scan.counts(pad.volts_of(siemens), pad.converter, same, bench.built.noise)
    np.testing.assert_array_equal(read, pad.converter.volts(counts))


def test_an_even_pad_gives_back_the_conductances_it_was_read_with() -> None:
    pad = Pad()
    bench = Bench(pad, np.random.default_rng(0))
    load_g = np.zeros(pad.geometry.shape)
    load_g[3:6, 3:6] = 120.0
    found, valid = bench.siemens(pad.forward(load_g))
    assert valid.all()
    np.testing.assert_allclose(found, pad.conductance_s(load_g), atol=1e-12)
