"""A calibration reads safely outside its range, survives its file, and agrees with ``force``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tactile_graph.errors import RuleError, UsageError
from tactile_graph.wires import Image
from tactile_graph_filters.readings.force import Force
from tactile_graph_pads.calibration.calibration import (
    Calibration,
    Origin,
    Provenance,
    calibration_text,
    load_calibration,
    write_calibration,
)
from tactile_graph_pads.calibration.curves import Isotonic, Polynomial, PowerLaw
from tactile_graph_pads.calibration.fit import calibrated
from tactile_graph_pads.calibration.points import Observation, points_of
from tactile_graph_pads.records import RecordError


def made(kind: str, reading: str = "volt") -> Calibration:
    loads = np.geomspace(12.0, 700.0, 9)
    volts = 2.5 * loads**1.46 / (loads**1.46 + 1200.0)
    seen = [Observation(float(g), np.full(4, v)) for g, v in zip(loads, volts, strict=True)]
    return calibrated(points_of(seen), kind, reading, observations=seen)  # type: ignore[arg-type]


KINDS = ("polynomial", "isotonic", "sums", "power")


@pytest.mark.parametrize("kind", KINDS)
def test_readings_outside_the_range_have_a_stated_answer(kind: str) -> None:
    curve = made(kind)
    below, zero, light, above = -1.0, 0.0, 0.5 * curve.from_reading, np.nextafter(curve.up_to, 9)
    load, valid = curve.grams_of(np.array([below, zero, light, curve.up_to, above]))
    assert valid.tolist() == [True, True, True, True, False]
    assert load[0] == load[1] == load[4] == 0.0
    assert 0.0 < load[2] < curve.points[0].load_g
    assert load[3] > 300.0


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@given(readings=arrays(np.float64, 12, elements=st.floats(allow_nan=True, allow_infinity=True)))
@settings(max_examples=40)
def test_no_reading_gives_nan_or_a_negative_load(kind: str, readings: np.ndarray) -> None:
    load, valid = made(kind).grams_of(readings)
    assert np.isfinite(load).all()
    assert (load >= 0.0).all()
    assert not valid[np.isnan(readings)].any()
    assert (load[~valid] == 0.0).all()


@pytest.mark.parametrize("kind", KINDS)
def test_loads_never_fall_with_the_reading(kind: str) -> None:
    curve = made(kind)
    load = curve.grams_of(np.linspace(-0.1, curve.up_to, 3000)).load_g
    assert (np.diff(load) >= -1e-9).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_gives_the_calibration_back(kind: str, tmp_path: Path) -> None:
    curve = replace(made(kind), about="pad in the lab")
    write_calibration(tmp_path / "c.yaml", curve)
    assert load_calibration(tmp_path / "c.yaml") == curve
    assert [p.name for p in tmp_path.iterdir()] == ["c.yaml"]


@pytest.mark.parametrize("kind", KINDS)
def test_the_step_force_reads_the_same_grams(kind: str) -> None:
    curve = made(kind)
    readings = np.linspace(-0.2, 1.1 * curve.up_to, 400).reshape(20, 20)
    own = curve.grams_of(readings)
    step = Force(**curve.force_settings())(Image(readings, quantity="volt"))
    assert step.valid is not None
    np.testing.assert_array_equal(step.valid, own.valid)
    off = abs(step.values - own.load_g)
    # a power law goes to force as 64 straight lines
    assert off.max() < (0.01 * own.load_g.max() if kind == "power" else 1e-9)


def test_the_file_shows_a_node_ready_for_use() -> None:
    text = calibration_text(made("polynomial"))
    node = text.split("In a pipeline:")[1].splitlines()[0]
    with_ = yaml.safe_load(node)["force"]["with"]
    assert set(with_) == {"polynomial", "up_to"}
    assert len(with_["polynomial"]) == 6
    assert "in: decoupled" in calibration_text(made("power", "siemens"))


def as_data(curve: Calibration) -> dict[str, object]:
    return dict(yaml.safe_load(calibration_text(curve)))


def test_all_that_is_wrong_with_a_file_is_said_by_line(tmp_path: Path) -> None:
    data = as_data(made("polynomial"))
    data["reading"] = "ohm"
    data["up_to"] = -1.0
    data["colour"] = "red"
    path = tmp_path / "bad.yaml"
    path.write_text(yaml.safe_dump(data, sort_keys=False))
    with pytest.raises(RecordError) as error:
        load_calibration(path)
    text = str(error.value)
    assert "bad.yaml:" in text
    for part in ("reading", "got 'ohm'", "up_to must be > 0, got -1.0", "colour"):
        assert part in text


def test_a_file_that_is_not_there_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="this calibration file cannot be read"):
        load_calibration(tmp_path / "none.yaml")


def test_another_yaml_file_is_no_calibration() -> None:
    with pytest.raises(RecordError, match="'format' is missing"):
        load_calibration({"pipeline": "circle-1"})


def test_a_curve_that_falls_is_refused() -> None:
    data = as_data(made("polynomial"))
    data["fit"] = {"kind": "polynomial", "coefficients": [0.0, 1.0, -1.0]}
    with pytest.raises(RecordError, match=r"grams must rise with the reading from 0 to up_to"):
        load_calibration(data)


def test_points_that_fall_are_refused() -> None:
    data = as_data(made("isotonic"))
    data["fit"] = {"kind": "isotonic", "points": [[0, 0], [1, 5], [1, 6]]}
    with pytest.raises(RecordError, match=r"must rise, got \(1, 6\) after \(1, 5\)"):
        load_calibration(data)


def test_points_start_at_nothing() -> None:
    data = as_data(made("isotonic"))
    data["fit"] = {"kind": "isotonic", "points": [[1, 5], [2, 6]]}
    with pytest.raises(RecordError, match=r"must start at \(0, 0\), got \(1.0, 5.0\)"):
        load_calibration(data)


def test_a_range_of_nothing_is_refused() -> None:
    data = as_data(made("polynomial"))
    data["from_reading"] = 99.0
    with pytest.raises(RecordError, match="from_reading must be below up_to"):
        load_calibration(data)


def test_each_fit_is_what_it_is_called() -> None:
    kinds = (Polynomial, Isotonic, Isotonic, PowerLaw)
    for kind, cls in zip(KINDS, kinds, strict=True):
        assert isinstance(made(kind).fit, cls)


@pytest.mark.parametrize("kind", KINDS)
def test_the_step_force_reads_the_file_itself(kind: str, tmp_path: Path) -> None:
    curve = made(kind)
    write_calibration(tmp_path / "c.yaml", curve)
    image = Image(np.linspace(0.0, curve.up_to, 64).reshape(8, 8), quantity="volt")
    by_file = Force(calibration=tmp_path / "c.yaml")(image)
    assert np.array_equal(by_file.values, Force(**curve.force_settings())(image).values)


def test_the_step_force_refuses_another_quantity_than_the_file_was_made_of(tmp_path: Path) -> None:
    write_calibration(tmp_path / "c.yaml", made("isotonic"))
    step = Force(calibration=tmp_path / "c.yaml")
    with pytest.raises(RuleError, match="the calibration reads volt, got counts"):
        step(Image(np.ones((2, 2)), quantity="counts"))


def with_offset() -> Calibration:
    offset = ((0.1, 0.2), (0.3, 0.4), (0.5, 0.6))
    return replace(made("isotonic"), offset=offset, provenance=Provenance(empty=Origin("e.npz")))


def test_a_file_keeps_what_the_empty_pad_reads_and_the_step_force_takes_it_off(
    tmp_path: Path,
) -> None:
    curve = with_offset()
    path = tmp_path / "c.yaml"
    write_calibration(path, curve)
    assert load_calibration(path) == curve
    readings = np.linspace(0.2, 2.0, 6).reshape(3, 2)
    image = Image(readings, quantity="volt")
    above = curve.grams_of(readings - np.array(curve.offset)).load_g
    np.testing.assert_allclose(Force(calibration=path)(image).values, above)
    plain = curve.grams_of(readings).load_g
    np.testing.assert_allclose(Force(calibration=path, tared=True)(image).values, plain)
    with pytest.raises(RuleError, match="empty pad of 3 x 2 elements reads, got an image of 2 x 2"):
        Force(calibration=path)(Image(np.ones((2, 2)), quantity="volt"))


def test_a_file_without_an_offset_is_as_it_was() -> None:
    data = as_data(made("isotonic"))
    assert "offset" not in data
    assert "empty" not in data["provenance"]  # type: ignore[operator]
    assert load_calibration(data).offset == ()


@pytest.mark.parametrize(
    ("offset", "match"),
    [([[1, 2], [3]], "offset: its rows must be of one length"),
     ([[1.0, float("nan")]], "offset: every element must be a finite number")],
)  # fmt: skip
def test_an_offset_that_no_pad_can_have_is_refused(offset: object, match: str) -> None:
    with pytest.raises(RecordError, match=match):
        load_calibration({**as_data(made("isotonic")), "offset": offset})


def test_tared_is_said_of_a_calibration() -> None:
    with pytest.raises(ValueError, match="tared belongs to calibration, which is not given"):
        Force(tared=True)
