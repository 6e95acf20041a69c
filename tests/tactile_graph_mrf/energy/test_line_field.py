"""Lines as places on the pad."""

from __future__ import annotations

import numpy as np
import pytest

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


def test_no_lines():
    lines = LineField.none(Image(np.zeros((1, 1))))
    assert lines.count == 0
    assert lines.length_cm == 0
    assert lines.segments_cm.shape == (0, 2, 2)
    with pytest.raises(ValueError, match="read-only"):
        LineField.none(Image(np.zeros((2, 2)))).vertical[0, 0] = True
