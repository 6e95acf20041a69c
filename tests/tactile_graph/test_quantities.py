"""Quantities are those that plugins offer, whoever asks first."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tactile_graph.quantities import is_quantity, unit_of, unknown_quantity
from tactile_graph.vocabulary import QUANTITIES, UNITS, Vocabulary, words_and_unit


def test_a_quantity_has_its_unit_or_is_its_own() -> None:
    assert [unit_of(q) for q in ("volt", "counts", "nobody's")] == ["V", "counts", "nobody's"]
    assert is_quantity("gram")
    assert not is_quantity("grams")


def test_an_unknown_quantity_is_told_with_what_is_near_or_with_all() -> None:
    assert unknown_quantity(["volt", "gram"]) == ""
    assert unknown_quantity(["volt", "grams"]) == "unknown quantity 'grams'; did you mean 'gram'?"
    assert "binary, counts, gram, " in unknown_quantity(["x"])


@pytest.mark.parametrize(
    "code",
    [
        "import tactile_graph; print(tactile_graph.Frame.of([[1.0]], quantity='volt').image.unit)",
        "from tactile_graph.vocabulary import QUANTITIES; print(QUANTITIES['volt'])",
    ],
)
def test_plugins_are_found_where_a_name_is_read_before_there_is_any(code: str) -> None:
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "V"


def test_words_are_a_mapping_of_what_was_entered() -> None:
    words = Vocabulary()
    words.enter("ell", "ell")
    assert dict(words) == {"ell": "ell"}
    assert len(words) == 1
    assert "yard" not in words
    assert {"cm", "cm2"} <= set(UNITS)
    assert "volt" in QUANTITIES


def test_a_units_name_alone_is_no_field_of_it() -> None:
    assert words_and_unit("cm") == ("cm", "")
    assert words_and_unit("vx_cm_s") == ("vx", "cm/s")


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("pressure_n_cm2", ("pressure", "N/cm²")),
        ("torque_n_cm", ("torque", "")),
        ("impulse_n_s", ("impulse", "")),
        ("centre_v_cm", ("centre v", "cm")),
        ("speed_mm_s", ("speed", "mm/s")),
        ("gain_v_g", ("gain", "V/g")),
        ("mean_load_g_cm2", ("mean load", "g/cm²")),
        ("turn_deg_s", ("turn", "°/s")),
        ("n_s", ("n", "s")),
        ("left_cm", ("left", "cm")),
    ],
)
def test_a_unit_before_the_unit_is_that_per_it(name: str, expected: tuple[str, str]) -> None:
    assert words_and_unit(name) == expected
