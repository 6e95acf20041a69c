"""Steps ``correct_readings`` and ``threshold_learned``: readings as a learned pad says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph.errors import DataError, RuleError, UsageError
from tactile_graph.wires import Image
from tactile_graph_filters.readings.correct_readings import CorrectReadings
from tactile_graph_filters.thresholds.threshold_learned import ThresholdLearned
from tactile_graph_pads.learned import Elements, write_elements

SHAPE = (4, 5)


@pytest.fixture
def pad(tmp_path: Path) -> str:
    """Offsets 0 to 19, gain 2 in column 3, (1, 2) dead; touched from 6."""
    gain = np.ones(SHAPE)
    gain[:, 3] = 2.0
    state = np.full(SHAPE, "good", dtype="U8")
    state[1, 2] = "dead"
    table = Elements(np.arange(20.0).reshape(SHAPE), np.ones(SHAPE), gain, state)
    write_elements(tmp_path / "table.csv", table)
    path = tmp_path / "pad.yaml"
    path.write_text("""
learned:
  {reading: volt, rows: 4, columns: 5, pitch_cm: [1, 1], origin_cm: [0, 0], elements: table.csv,
   noise: 1.0, touched_from: 6.0, gain_of: volt}
""")
    return str(path)


def image(values: np.ndarray, quantity: str = "volt", valid: np.ndarray | None = None) -> Image:
    return Image(values, (1.0, 1.0), (0.0, 0.0), quantity, valid)


def test_offset_goes_gain_is_divided_and_what_is_dead_is_invalid(pad: str) -> None:
    found = CorrectReadings(pad=pad)(image(np.arange(20.0).reshape(SHAPE) + 8.0))
    assert found.valid is not None
    assert np.argwhere(~found.valid).tolist() == [[1, 2]]
    assert found.values[1, 2] == 0.0
    assert found.values[0].tolist() == [8.0, 8.0, 8.0, 4.0, 8.0]
    assert found.quantity == "volt"


def test_gains_of_grams_leave_volts_alone_and_even_grams(pad: str) -> None:
    text = Path(pad).read_text()
    Path(pad).write_text(text.replace("gain_of: volt", "gain_of: gram"))
    step = CorrectReadings(pad=pad)
    assert step(image(np.full(SHAPE, 30.0))).values[0].tolist() == [30.0, 29.0, 28.0, 27.0, 26.0]
    grams = step(image(np.full(SHAPE, 30.0), "gram"))
    assert grams.values[0].tolist() == [30.0, 30.0, 30.0, 15.0, 30.0]


def test_where_every_element_is_good_and_every_cell_valid_all_stay_so(pad: str) -> None:
    table = Elements(np.full(SHAPE, 2.0), np.ones(SHAPE), np.full(SHAPE, 4.0),
                     np.full(SHAPE, "good", dtype="U8"))  # fmt: skip
    write_elements(Path(pad).with_name("table.csv"), table)
    given = np.arange(20.0).reshape(SHAPE)
    found = CorrectReadings(pad=pad)(image(given))
    assert found.valid is None
    assert np.array_equal(found.values, (given - 2.0) / 4.0)
    assert (found.pitch_cm, found.quantity) == ((1.0, 1.0), "volt")


def test_what_came_in_invalid_stays_so(pad: str) -> None:
    valid = np.ones(SHAPE, bool)
    valid[0, 0] = False
    found = CorrectReadings(pad=pad)(image(np.full(SHAPE, 30.0), valid=valid))
    assert found.valid is not None
    assert (~found.valid).sum() == 2
    assert found.values[0, 0] == 0.0


def test_other_shapes_quantities_and_numbers_are_refused(pad: str) -> None:
    step = CorrectReadings(pad=pad)
    with pytest.raises(RuleError, match=r"the pad has 4 x 5 elements, got \(3, 3\)"):
        step(image(np.zeros((3, 3))))
    with pytest.raises(RuleError, match="was learned from volt, got counts"):
        step(image(np.zeros(SHAPE), "counts"))
    path = Path(pad)
    path.write_text(path.read_text().replace("pitch_cm: [1, 1]", "pitch_cm: [0.5, 1]"))
    with pytest.raises(RuleError, match=r"at a pitch of 0.5 x 1 cm, got 0.6 x 1 cm"):
        CorrectReadings(pad=pad)(Image(np.zeros(SHAPE), (0.6, 1.0), (0.0, 0.0), "volt"))
    values = np.zeros(SHAPE)
    values[2, 3] = np.nan
    with pytest.raises(DataError, match="row 2, column 3"):
        step(image(values))
    with pytest.raises(UsageError, match="was not learned from recordings"):
        CorrectReadings(pad="thesis")


def test_the_level_is_the_learned_one(pad: str) -> None:
    values = np.zeros(SHAPE)
    values[2, 1:4] = 5.9, 6.0, 13.0
    assert ThresholdLearned(pad=pad)(image(values)).values[2].tolist() == [0, 0, 1, 1, 0]
    assert ThresholdLearned(pad=pad, times=2.0)(image(values)).count == 1
    with pytest.raises(RuleError, match="was learned from volt, got raw"):
        ThresholdLearned(pad=pad)(image(values, "raw"))


def test_a_stuck_element_may_be_kept_for_the_circuit_and_goes_behind_it(pad: str) -> None:
    table = Path(pad).parent / "table.csv"
    table.write_text(table.read_text().replace("2,1,11,1,1,good", "2,1,11,1,1,stuck"))
    volts = image(np.full(SHAPE, 30.0))
    kept = CorrectReadings(pad=pad, keep_stuck=True)(volts)
    assert kept.valid is not None
    assert kept.valid[2, 1]
    assert kept.values[2, 1] == 30.0  # as it reads: its rest is no offset
    assert np.argwhere(~kept.valid).tolist() == [[1, 2]]
    behind = CorrectReadings(pad=pad)(image(np.full(SHAPE, 5.0), "siemens"))
    assert behind.valid is not None
    assert np.argwhere(~behind.valid).tolist() == [[1, 2], [2, 1]]
    assert behind.values[0].tolist() == [5.0] * 5
