"""Pads from YAML, from load to volts and back."""

import math
from pathlib import Path

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph_pads.circuits import Divider, Feedback, Floating
from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_pads.records import RecordError

BAD = """\
about: a pad with everything wrong
geometry: {rows: 16, colums: 16, element_cm: -1}
law:
  load_g: ten
circuit: {kind: divder, bias_ohm: 33e3}
converter: {bits: 12.5}
contact: {sand: [{row: 1, column: 2, share: 3}]}
nonsense: 4
"""


@pytest.fixture
def loads():
    return np.random.default_rng(0).uniform(12.0, 500.0, (16, 16))


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "pad.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_thesis_pad_is_the_one_of_chapter_2():
    pad = load_pad("thesis")
    assert pad.geometry.shape == (16, 16)
    assert pad.geometry.size_cm == pytest.approx((20.5, 20.5))
    assert pad.law.resistance_at(100.0) == pytest.approx(80e3)
    assert pad.law.resistance_at(2000.0) == pytest.approx(1e3)
    assert isinstance(pad.circuit, Divider)
    assert pad.circuit.bias_ohm == 33e3
    assert pad.converter.step_v == pytest.approx(2.44e-3, rel=1e-3)
    assert pad.scan.samples == 100
    assert pad.contact.cardboard


def test_the_plain_pad_has_nothing_random():
    pad = load_pad("plain")
    assert pad.unevenness.sigma == pad.unevenness.voids == pad.law.repeatability == 0.0
    assert pad.scan.noise_v == 0.0
    assert pad.converter.bits is None
    assert pad.law == Pad().law


def test_one_loaded_element_divides_the_supply():
    load = np.zeros((16, 16))
    load[3, 4] = 100.0
    volts = Pad().forward(load)
    assert volts[3, 4] == pytest.approx(5.0 * 33.0 / (33.0 + 80.0))
    assert np.count_nonzero(volts) == 1


@pytest.mark.parametrize(
    "circuit", [Divider(), Divider(driver_ohm=40.0), Floating(), Feedback(driver_ohm=100.0)]
)
def test_backward_undoes_forward_through_every_circuit(circuit, loads):
    pad = Pad(circuit=circuit)
    found = pad.backward(pad.forward(loads))
    assert found.valid.all()
    assert found.residual < 1e-11
    np.testing.assert_allclose(found.load_g, loads, rtol=1e-9)


def test_forward_is_the_same_each_time_and_leaves_its_input_alone(loads):
    pad = load_pad("thesis")
    loads.setflags(write=False)
    assert (pad.forward(loads) == pad.forward(loads)).all()


def test_known_faults_are_taken_off_and_dead_elements_are_invalid(loads):
    pad = load_pad(
        {
            "defects": {
                "dead_rows": [2],
                "hot": [{"row": 5, "column": 6, "resistance_ohm": 50e3}],
                "column_gain": [1.0] * 8 + [1.4] * 8,
                "preload_g": 15,
            }
        }
    )
    volts = pad.forward(loads)
    assert (volts[2] == 0.0).all()
    assert volts[5, 6] > Pad().forward(loads)[5, 6]
    found = pad.backward(volts)
    assert not found.valid[2].any()
    assert found.valid.sum() == 15 * 16
    np.testing.assert_allclose(found.load_g[found.valid], loads[found.valid], rtol=1e-9)


def test_impossible_and_saturated_elements_are_invalid_and_hold_0():
    volts = np.zeros((16, 16))
    volts[3, 4], volts[5, 4] = 3.0, 2.5  # a column above its supply
    volts[8, 9] = 4.9999  # more than the law can give
    found = Pad().backward(volts)
    assert not found.valid[:, 4].any()
    assert not found.valid[8, 9]
    assert found.valid.sum() == 256 - 17
    assert (found.load_g == 0.0).all()


def test_an_image_of_the_pad_lies_where_the_elements_are():
    image = Pad().image(np.zeros((16, 16)))
    np.testing.assert_allclose(image.x_cm, Pad().geometry.x_cm)
    assert image.quantity == "volt"


def test_a_pad_file_of_ones_own_is_read(tmp_path):
    path = written(tmp_path, "geometry: {rows: 4, columns: 6}\ncircuit: {kind: floating}\n")
    pad = load_pad(str(path))
    assert pad.geometry.shape == (4, 6)
    assert pad.circuit == Floating()
    assert load_pad(path) == pad


def test_all_that_is_wrong_with_a_pad_file_is_said_at_once_with_line_and_column(tmp_path):
    path = written(tmp_path, BAD)
    with pytest.raises(RecordError) as caught:
        load_pad(str(path))
    text = str(caught.value)
    for part in (
        "pad.yaml:2:46: element_cm must be > 0, got -1",
        "pad.yaml:2:22: unknown key 'colums'; did you mean 'columns'?",
        "pad.yaml:4:11: load_g should be a valid number",
        "pad.yaml:5:17: kind must be one of divider, feedback, floating, got 'divder'; did you",
        "pad.yaml:6:19: bits should be a valid integer",
        "pad.yaml:7:45: share must be <= 1, got 3",
        "pad.yaml:8:1: unknown key 'nonsense'; allowed are: about, circuit",
    ):
        assert part in text
    assert len(caught.value.problems) == 7


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"circuit": {"bias_ohm": 3}}, r"pad\.circuit: 'kind' is missing"),
        ({"circuit": {"kind": "divider", "bias": 3}}, r"pad\.circuit\.bias: unknown key 'bias'; d"),
        (
            {"circuit": {"kind": "feedback", "mux_ohm": 3}},
            "key 'mux_ohm'; allowed are: bias",
        ),
        ({"law": {"load2_g": 50}}, r"pad\.law: .*give no falling resistance"),
        ({"law": {"turn_on_g": True}}, r"pad\.law\.turn_on_g: turn_on_g must be a number, got Tr"),
        ({"converter": {"low_v": 5}}, r"pad\.converter: converter: high_v must be above low_v"),
        ({"defects": {"hot": [{"row": 1, "column": 2}]}}, r"hot\[0\]: 'resistance_ohm' is missing"),
        ({"defects": {"dead_rows": [16]}}, "row 16 is not on the pad, 0 to 15"),
        ({"defects": {"noisy_rows": [99]}}, "row 99 is not on the pad, 0 to 15"),
        ({"defects": {"dead_columns": [16]}}, "column 16 is not on the pad, 0 to 15"),
        ({"defects": {"dead_elements": [[16, 0]]}}, r"element \(16, 0\) is not on the pad; rows"),
        (
            {"defects": {"row_gain": [1, 2]}},
            "row_gain: needs one factor for each of 16 rows, got 2",
        ),
        ({"contact": {"sand": [{"row": 1, "column": 16}]}}, r"contact\.sand: element \(1, 16\)"),
        (
            {"unevenness": {"bumps": [{"row": 16, "column": 1, "gain": 2}]}},
            r"unevenness\.bumps: element \(16, 1\) is not on the pad",
        ),
        (
            {"geometry": [1, 2]},
            r"pad\.geometry: geometry is a mapping of settings, got \[1, 2\]; allowed are: col",
        ),
        (
            {"circuit": 3},
            r"pad\.circuit: circuit is a mapping of settings, got 3; allowed are: bias_ohm, ",
        ),
        (
            {"geometry": {"element_cm": 1e300}},
            r"element_cm \+ gap_cm: a pitch must be within 1e-06 to 1e\+06 cm, got 1e\+300",
        ),
        ({"geometry": {"gap_cm": math.inf}}, "a pitch must be within 1e-06 to 1e.06 cm, got inf"),
        ({"geometry": {"element_cm": math.nan}}, "element_cm must be > 0, got nan"),
        (
            {"circuit": {"kind": "divider", "supply_v": math.inf}},
            r"pad\.circuit\.supply_v: supply_v must be a finite number, got inf",
        ),
    ],
)
def test_what_is_wrong_with_a_pad_given_as_a_mapping_is_said_by_its_place(data, message):
    with pytest.raises(RecordError, match=message):
        load_pad(data)


def test_a_law_may_be_told_to_have_no_saturation():
    pad = load_pad({"law": {"saturation_g": math.inf}})
    assert pad.law.load_of(pad.law.conductance_s(np.array([[1e5]]))) == pytest.approx(1e5)


def test_a_file_that_is_no_mapping_or_no_yaml_is_refused(tmp_path):
    with pytest.raises(RecordError, match=r"pad.yaml:1:1: a pad is a mapping of settings, got \[1"):
        load_pad(written(tmp_path, "- 1\n"))
    with pytest.raises(RecordError, match=r"pad.yaml:2:\d+: this is not YAML"):
        load_pad(written(tmp_path, "a: {b\nc: d]\n"))


def test_a_pad_that_is_not_there_is_said_with_what_is_near(tmp_path):
    with pytest.raises(UsageError, match="no pad named 'thesys'; did you mean 'thesis'"):
        load_pad("thesys")
    with pytest.raises(UsageError, match="this pad file cannot be read"):
        load_pad(tmp_path / "none.yaml")
