"""The picture of a calibration has axes, units, a legend, and what was measured."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph_pads.calibration.fit import calibrated
from tactile_graph_pads.calibration.plot import (
    check_picture,
    draw_calibration,
    new_figure,
    save_calibration_plot,
)
from tactile_graph_pads.calibration.points import Observation, points_of


def made():
    rng = np.random.default_rng(0)
    seen = [
        Observation(float(g), np.sqrt(g) * rng.lognormal(0, 0.05, 4))
        for g in (10, 50, 100, 300)
        for _ in range(5)
    ]
    return calibrated(points_of(seen), "power")


def test_it_says_what_is_drawn_in_which_unit() -> None:
    axes = new_figure().subplots()
    draw_calibration(axes, made())
    assert axes.get_xlabel() == "load on an element / g"
    assert axes.get_ylabel() == "reading / V"
    labels = [t.get_text() for t in axes.get_legend().get_texts()]
    assert any("single elements" in t for t in labels)
    assert any("groups of 2x2" in t for t in labels)
    assert any(t.startswith("power law, rms") for t in labels)


def test_the_curve_drawn_is_the_curve_used() -> None:
    axes = new_figure().subplots()
    curve = made()
    draw_calibration(axes, curve)
    line = next(x for x in axes.get_lines() if str(x.get_label()).startswith("power law"))
    load, volts = line.get_data()
    np.testing.assert_allclose(curve.grams_of(np.asarray(volts)).load_g, load)


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["png", "svg", pytest.param("pdf", marks=pytest.mark.slow)])
def test_it_is_written(tmp_path: Path, ending: str) -> None:
    save_calibration_plot(tmp_path / f"c.{ending}", made())
    assert (tmp_path / f"c.{ending}").stat().st_size > 2000


def test_a_name_that_cannot_be_drawn_to_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"--plot c.doc: its name must end in .png, .svg, .pdf"):
        check_picture("c.doc")
    with pytest.raises(UsageError, match=r"its name must end in .png, .svg, .pdf"):
        check_picture(os.devnull)
    with pytest.raises(UsageError, match="there is no folder"):
        check_picture(tmp_path / "none" / "c.png")
