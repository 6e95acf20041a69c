"""What notebooks show of frames, images and masks: the picture, its axes, range and unit."""

from __future__ import annotations

import base64
import io
import re
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from matplotlib.image import imread

from tactile_graph import Circle, Frame, Image, Mask
from tactile_graph.wires import TrueObject


def parsed(html: str) -> ET.Element:
    return ET.fromstring(html)


def png_of(html: str) -> np.ndarray:
    (data,) = re.findall(r"data:image/png;base64,([^\"]+)", html)
    return np.rint(255 * imread(io.BytesIO(base64.b64decode(data)), format="png"))


def words(html: str) -> str:
    return " ".join(" ".join(parsed(html).itertext()).split())


def test_an_image_says_its_grid_its_range_and_its_unit() -> None:
    values = np.zeros((3, 4))
    values[1, 2] = 2.5
    html = Image(values, (0.5, 1.0), (1.0, 2.0), "volt")._repr_html_()
    assert "3 × 4 cells of 0.5 × 1 cm, volt" in words(html)
    assert re.search(r"\b0 2.5 V", words(html))
    for edge in ("1", "3", "2", "5", "x in cm"):
        assert f">{edge}</text>" in html
    shown = png_of(html)
    assert shown.shape[:2] == (3, 4)
    assert len(np.unique(shown.reshape(-1, shown.shape[2]), axis=0)) == 2


def test_broken_cells_are_grey_and_counted() -> None:
    values = np.ones((2, 2))
    values[0, 1] = np.nan
    html = Frame.of(values).image._repr_html_()
    assert "1 broken (grey)" in words(html)
    assert png_of(html)[0, 1, :3].tolist() == [120, 120, 120]


def test_a_mask_says_how_many_cells_are_on() -> None:
    html = Mask(np.eye(3, dtype=bool), (2.0, 2.0))._repr_html_()
    assert "3 × 3 cells of 2 cm: 3 of 9 cells on, 12 cm²" in words(html)
    dark = png_of(html)[..., 0] < 100
    np.testing.assert_array_equal(dark, np.eye(3, dtype=bool))


def test_a_frame_says_when_it_was_and_what_truly_lay_there() -> None:
    truth = (TrueObject(Circle(2.0, 1.0, 0.5), name="<b>"),)
    frame = Frame.of(np.ones((4, 4)), index=7, time_s=0.35, truth=truth, label="<left>", gap=True)
    html = frame._repr_html_()
    assert "frame 7, 0.35 s, <left>, after a gap" in words(html)
    assert "truly there: 1 object (dashed)" in words(html)
    (line,) = [p.get("d") for p in parsed(html).iter() if p.get("stroke-dasharray")]
    first = line.removeprefix("M").split("L")[0]
    assert [float(v) for v in first.split()] == pytest.approx([2.5 * 75, 1.0 * 75], abs=0.1)
    empty = Frame.of(np.ones((4, 4)), truth=())._repr_html_()
    assert "truly there: nothing" in words(empty)
    assert "truly" not in words(Frame.of(np.ones((4, 4)))._repr_html_())


@pytest.mark.parametrize("values", [np.zeros((2, 3)), np.full((2, 3), np.nan), -np.ones((1, 80))])
def test_pads_of_any_values_and_shapes_are_shown(values: np.ndarray) -> None:
    parsed(Frame.of(values)._repr_html_())


def test_text_alone_says_it_in_a_line() -> None:
    frame = Frame.of(np.zeros((2, 3)), 0.5, quantity="volt", index=4)
    assert repr(frame).startswith("Frame(image=<Image 2x3 volt, pitch (0.5, 0.5) cm, origin")
    assert "\n" not in repr(frame)
