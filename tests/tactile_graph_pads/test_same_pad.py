"""Whether frames are of one pad."""

import numpy as np
import pytest

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_pads.same_pad import check_same_pad


def test_the_very_same_pitch_is_not_compared_as_numbers_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    first, other = (Frame.of(np.zeros((2, 3)), 0.5).image for _ in range(2))
    near, far = (Frame.of(np.zeros((2, 3)), pitch).image for pitch in (0.5001, 0.51))
    check_same_pad(first, near, "a", "b")
    with pytest.raises(DataError, match=r"b: has a pitch of 0\.51 x 0\.51 cm, but a of 0\.5"):
        check_same_pad(first, far, "a", "b")
    monkeypatch.setattr(np, "allclose", lambda *args, **more: pytest.fail("compared"))
    check_same_pad(first, other, "a", "b")
