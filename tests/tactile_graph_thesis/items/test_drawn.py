"""Figures of studies: what was measured is labelled, and no legend or curve lies on another."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_thesis.items.chapter_2.section_2_2_3_samples import SampleErrors
from tactile_graph_thesis.items.chapter_2.section_2_2_3_samples import _figure as of_samples
from tactile_graph_thesis.items.chapter_4.section_4_3_4_broken_image import LOST, Broken
from tactile_graph_thesis.items.chapter_4.section_4_3_4_broken_image import _figure as of_broken
from tactile_graph_thesis.items.chapter_6.section_6_1_3_subdivision import (
    SubpixelErrors,
    ticks_about,
)
from tactile_graph_thesis.items.chapter_6.section_6_1_3_subdivision import _figure as of_subdivision


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (13.0, 48.0, [10.0, 20.0, 50.0]),
        (0.12, 3.4, [0.1, 0.2, 0.5, 1.0, 2.0, 5.0]),
        (1.0, 1.5, [1.0, 2.0]),
        (21.0, 22.0, [20.0, 50.0]),
        (99.0, 1000.0, [50.0, 100.0, 200.0, 500.0, 1000.0]),
    ],
)
def test_an_axis_has_a_label_at_or_beyond_either_end(
    low: float, high: float, ticks: list[float]
) -> None:
    assert ticks_about(low, high) == ticks


@pytest.mark.slow
def test_every_subdivision_and_decade_of_time_is_labelled() -> None:
    time_us = np.array([[14.0, 16.0, 19.0, 40.0]] * 2)
    figure = of_subdivision(SubpixelErrors((1, 2, 4, 8), np.full((2, 4, 5, 3), 0.3), time_us))
    *_, times = figure.axes
    assert [t.get_text() for t in times.get_xticklabels()] == ["1", "2", "4", "8"]
    assert [t.get_text() for t in times.get_yticklabels()] == ["10", "20", "50"]


@pytest.mark.slow
def test_legends_stand_beside_the_curves_and_equal_curves_are_both_seen() -> None:
    noise, some = np.array([2e-4, 2e-3]), np.array([1.0, 10.0])
    samples = of_samples(SampleErrors(some, noise, np.full((2, 2), 1e-3), 0.05, 2e-3, some))
    broken = of_broken(Broken(("I", "II"), np.zeros((2, 2, len(LOST), 4))))
    for figure in (samples, broken):
        (axes,) = figure.axes
        assert axes.get_legend() is None
        assert len(figure.legends) == 1
    first, _, second, _ = broken.axes[0].lines
    assert np.array_equal(first.get_ydata(), second.get_ydata())
    assert first.get_linewidth() > 2.0 * second.get_linewidth()
