"""Units as vendors spell them."""

from __future__ import annotations

import pytest

from tactile_graph_sources.readers.words.units import (
    length_cm,
    length_unit,
    pressure_unit,
    taken_as_they_are,
)


@pytest.mark.parametrize(
    ("text", "unit", "cm"),
    [
        ("5.08 mm", "", 0.508),
        ("0.127 centimeters", "", 0.127),
        ("0,86", "cm", 0.86),
        ("0.5 inches", "", 1.27),
        ("800 \u00b5m", "", 0.08),
        ("800 um", "", 0.08),
        ("800 micrometers", "", 0.08),
        ("1 metre", "", None),
        ("wide", "", None),
        ("0 mm", "", None),
        ("1.2.3 mm", "", None),
        ("5 furlongs", "", None),
    ],
)
def test_lengths_become_centimetres_or_nothing(text: str, unit: str, cm: float | None) -> None:
    assert length_cm(text, unit) == (None if cm is None else pytest.approx(cm))


@pytest.mark.parametrize("name", ["x_um", "x [\u00b5m]", "y (\u03bcm)", r"x_\xb5m"])
def test_a_name_may_end_with_micrometres(name: str) -> None:
    assert length_unit(name) == 1e-4


@pytest.mark.parametrize("text", ["raw", "", "sensels", "kilofoo"])
def test_units_that_are_no_pressure_are_raw(text: str) -> None:
    assert pressure_unit(text) == ("raw", 1.0)


@pytest.mark.parametrize(
    ("text", "factor"),
    [
        ("kPa", 1.0),
        ("N/cm²", 10.0),
        ("N / cm^ 2", 10.0),
        (r"N/cm\xb2", 10.0),
        ("PSI", 6.894757293),
        ("lbs/in²", 6.894757293),
        ("lbf/in2", 6.894757293),
        ("kgf/cm^2", 98.0665),
        ("gf/cm²", 0.0980665),
        ("cmH2O", 0.0980665),
        ("inH2O", 0.24908891),
        ("inHg", 3.386389),
        ("Torr", 0.1333224),
        ("Pascals", 1e-3),
    ],
)
def test_pressures_have_a_factor_to_kilopascal(text: str, factor: float) -> None:
    assert pressure_unit(text) == ("kilopascal", pytest.approx(factor))


@pytest.mark.parametrize("text", ["furlongs", "kohm"])
def test_values_in_a_unit_that_nobody_knows_are_told(text: str) -> None:
    assert taken_as_they_are(text)[0].startswith(f"values in {text!r}")


@pytest.mark.parametrize("text", ["", "a.u.", "raw", "1", "kPa", "mV"])
def test_values_without_a_unit_or_in_a_known_one_are_not_told(text: str) -> None:
    assert taken_as_they_are(text) == ()
