"""volts, decouple and force one after the other: the way back from a converter to loads."""

import numpy as np
import pytest

from tactile_graph_filters.readings.decouple import Decouple
from tactile_graph_filters.readings.force import Force
from tactile_graph_filters.readings.volts import Volts
from tactile_graph_pads.pad import load_pad

CIRCUITS = {
    "divider": {"kind": "divider"},
    "driven": {"kind": "divider", "driver_ohm": 40.0},
    "floating": {"kind": "floating"},
    "feedback": {"kind": "feedback"},
}


def blobs(peak_g):
    y, x = np.mgrid[0:16, 0:16]
    spots = [(4, 4, 1.0), (11, 5, 0.5), (8, 12, 0.8)]
    return sum(a * peak_g * np.exp(-((y - i) ** 2 + (x - j) ** 2) / 4.0) for i, j, a in spots)


@pytest.mark.parametrize("circuit", CIRCUITS)
def test_without_noise_every_circuit_is_undone(circuit):
    spec = {"circuit": CIRCUITS[circuit], "converter": {"bits": None}}
    pad, load = load_pad(spec), blobs(600.0) + 20.0
    counts = pad.converter.counts(pad.forward(load))
    image = Decouple(pad=spec)(Volts(pad=spec)(pad.image(counts, "counts")))
    assert image.quantity == "siemens"
    assert image.values == pytest.approx(pad.conductance_s(load), rel=1e-9)
    grams = Force(pad=spec)(image)
    assert grams.quantity == "gram"
    assert grams.values == pytest.approx(load, rel=1e-8)
    assert (grams.pitch_cm, grams.origin_cm) == ((1.3, 1.3), pad.geometry.origin_cm)


def test_decoupling_takes_away_the_error_that_the_column_makes():
    spec = {"converter": {"bits": 12, "low_v": 0.0, "high_v": 5.0}}
    pad, load = load_pad(spec), blobs(900.0) + 30.0
    counts = pad.converter.counts(pad.forward(load))
    volts = Volts(pad=spec)(pad.image(counts, "counts"))
    decoupled = Force(pad=spec)(Decouple(pad=spec)(volts)).values
    naive_s = volts.values / (5.0 - volts.values) / pad.circuit.bias_ohm
    naive = Force(pad=spec)(pad.image(naive_s, "siemens")).values
    loaded = load > 100.0
    errors = [np.abs(found - load)[loaded] / load[loaded] for found in (naive, decoupled)]
    assert errors[0].mean() > 0.3
    assert errors[1].mean() < 0.03
