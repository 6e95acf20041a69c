"""Fingers: what is pressed, recorded and stroked comes out as it went in."""

from pathlib import Path

import pytest
from tactile_graph import Frame, load
from tactile_graph.steps import Report
from tactile_graph.testing import check_step
from tactile_graph_sources.recording import recording

from tactile_graph_fingers.fit_stroke import fit_stroke
from tactile_graph_fingers.newtons import newtons


def test_a_hundred_grams_weigh_a_newton() -> None:
    image = newtons(Frame.of([[100.0, 0.0]], quantity="gram").image)
    assert image.total == pytest.approx(0.980665)
    assert image.unit == "N"


def test_what_was_recorded_is_read(tmp_path: Path) -> None:
    path = tmp_path / "any.txt"
    path.write_text("FINGERS 1 3 0.5\n1 2 3\n4 5\n")
    (frame,) = recording(path=path, report=Report())
    assert frame.image.values.tolist() == [[1.0, 2.0, 3.0]]
    assert (frame.image.quantity, frame.image.pitch_cm) == ("gram", (0.5, 0.5))


def test_every_stroke_is_found_as_long_as_it_is() -> None:
    lengths = [result["stroke"].length_cm for result in load("fingers").stream()]
    assert lengths == pytest.approx([3.0, 4.0, 5.0, 6.0, 7.0])


@pytest.mark.parametrize("step", [newtons, fit_stroke])
def test_they_keep_what_every_step_promises(step: object) -> None:
    check_step(step)
