"""The pitch of what was read: as told, as the image says, or the thesis' pad's."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_fitters.orientation.element_pitch import element_pitch_cm


def test_what_is_told_goes_before_the_image_and_both_before_the_thesis() -> None:
    image = Image(np.zeros((2, 2)), (0.4, 0.9))
    assert element_pitch_cm(image, 0.5) == 0.5
    assert element_pitch_cm(image, None) == pytest.approx(0.6)
    assert element_pitch_cm(Image(np.zeros((2, 2)), (1.3, 1.3)), None) == 1.3
    assert element_pitch_cm(None, None) == 1.3
