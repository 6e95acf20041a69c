"""How often frames come, as lines before a table say it."""

from __future__ import annotations

import pytest

from tactile_graph_sources.readers.words.preamble import described
from tactile_graph_sources.readers.words.rates import frame_seconds


@pytest.mark.parametrize(
    ("text", "unit", "seconds"),
    [
        ("50", "", 0.02),
        ("50 Hz", "", 0.02),
        ("50", "Hz", 0.02),
        ("50,5 Hz", "", 1 / 50.5),
        ("50 Hz (nominal)", "", 0.02),
        ("50 Hz, 100 frames", "", 0.02),
        ("50, nominal", "", 0.02),
        ("0.5 kHz", "", 0.002),
        ("0,500 kHz", "", 0.002),
        ("0.25", "kHz", 0.004),
        ("1e3", "", 0.001),
        ("1,000.5 Hz", "", 1 / 1000.5),
        ("20 ms", "", 0.02),
        ("4", "ms", 0.004),
        ("0.02 s", "", 0.02),
        ("3000 frames/min", "", 0.02),
        ("50 frames per second", "", 0.02),
        ("50 fps", "", 0.02),
        ("50 samples / s", "", 0.02),
        ("50 1/s", "", 0.02),
        ("50/s", "", 0.02),
        ("50 s-1", "", 0.02),
        ("50 s⁻¹", "", 0.02),
        ("50", "s-1", 0.02),
        ("50 s^(-1)", "", 0.02),
        ("50 s**-1", "", 0.02),
        ("50_Hz", "", 0.02),
        ("50 Aufnahmen/s", "", 0.02),
        ("50 samples s-1", "", 0.02),
        ("50 S/s", "", 0.02),
        ("50 kS/s", "", 2e-5),
        ("50 f/s", "", 0.02),
        ("50 readings/s", "", 0.02),
        ("50 Werte/s", "", 0.02),
        ("50 Frames pro Sekunde", "", 0.02),
        ("50 images par seconde", "", 0.02),
        ("50 Hz per channel", "", 0.02),
        ("50 Hz/channel", "", 0.02),
        ("0.05 kHz/channel", "", 0.02),
        ("50 samples/s/channel", "", 0.02),
        ("50 [Hz]", "", 0.02),
        ("20 (ms)", "", 0.02),
        ("50 (nominal)", "", 0.02),
        ("50", "nominal", 0.02),
        ("50", "per channel", 0.02),
        ("50-Hz", "", 0.02),
        ("50±1 Hz", "", 0.02),
        ("20 +/- 0.5 ms", "", 0.02),
    ],
)
def test_a_rate_is_read_in_its_unit(text: str, unit: str, seconds: float) -> None:
    assert frame_seconds(text, unit) == pytest.approx(seconds)


@pytest.mark.parametrize("text", ["1,000 Hz", "50 rpm", "50 frames", "1 per 20 ms", "50.5.1 Hz",
                                  "50 Hz/1000", "-50 Hz", "50 - 100 Hz", "50-100 Hz",
                                  "5 Hz/s", "5 N/s", "50 MHz"])  # fmt: skip
def test_a_rate_that_is_not_understood_is_told_and_not_taken(text: str) -> None:
    said = described([f"Sampling rate: {text}"])
    assert said.frame_s is None
    assert said.notes == (
        f"'Sampling rate: {text}' left out, as it is no rate that is understood (such as 50 Hz)",
    )


@pytest.mark.parametrize("text", ["0", "variable", ""])
def test_a_rate_that_says_no_number_is_no_trouble(text: str) -> None:
    assert described([f"Rate: {text}"]).notes == ()


@pytest.mark.parametrize("text", ["5 N/s", "5 mm/s", "5 %/s", "3 presses/min", "9600 baud"])
def test_a_rate_of_something_else_is_left_out_in_silence(text: str) -> None:
    for word in ("Rate", "Frequency"):
        said = described([f"{word}: {text}"])
        assert (said.frame_s, said.notes) == (None, ())
    number, _, unit = text.partition(" ")
    assert described([f"Rate [{unit}]: {number}"]).notes == ()


def test_anything_a_second_is_a_rate_where_its_name_says_that_it_is_one_of_frames() -> None:
    assert described(["Sampling rate: 50 sweeps/s"]).frame_s == pytest.approx(0.02)
    said = described(["Rate: 50 sweeps/s"])
    assert said.frame_s is None
    assert said.notes == (
        "'Rate: 50 sweeps/s' left out, as it is no rate that is understood (such as 50 Hz)",
    )
