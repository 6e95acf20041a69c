"""Lines as places on the pad."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import loads
from tactile_graph.draw.display import display_list
from tactile_graph.wires import Image
from tactile_graph_mrf.energy.line_field import LineField


def test_segments_lie_between_the_cells_they_part():
    image = Image(np.zeros((2, 3)), (1.5, 2.0), (10.0, 20.0))
    across, down = np.zeros((1, 3), np.bool_), np.zeros((2, 2), np.bool_)
    across[0, 2] = down[1, 0] = True
    lines = LineField.of(image, across, down)
    assert lines.count == 2
    assert lines.length_cm == 3.5
    wanted = [[[13.0, 22.0], [14.5, 22.0]], [[11.5, 22.0], [11.5, 24.0]]]
    np.testing.assert_allclose(lines.segments_cm, wanted)
    np.testing.assert_allclose(lines.middles.xy_cm, [[13.75, 22.0], [11.5, 23.0]])


def test_ports_that_take_points_take_the_middles_of_the_lines():
    text = "pipeline: p\nnodes:\n  restored: {step: restore, in: frame}\n"
    pipeline = loads(text + "  hull: {step: hull, in: restored.lines}\noutputs: [hull]\n")
    assert str(pipeline.nodes["hull"].inputs[0].refs[0]) == "restored.lines.middles"


def test_no_lines():
    lines = LineField.none(Image(np.zeros((1, 1))))
    assert lines.count == 0
    assert lines.length_cm == 0
    assert lines.segments_cm.shape == (0, 2, 2)
    with pytest.raises(ValueError, match="read-only"):
        LineField.none(Image(np.zeros((2, 2)))).vertical[0, 0] = True


def test_its_lines_are_what_pictures_show():
    field = LineField(np.array([[True, False]]), np.zeros((2, 1), bool), (2.0, 1.0), (5.0, 3.0))
    (rim,) = display_list(field)
    assert rim.edges_cm.tolist() == [[[5.0, 4.0], [7.0, 4.0]]]
