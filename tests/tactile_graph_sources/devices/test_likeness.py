"""What a framer remembers of the pad."""

from __future__ import annotations

import numpy as np

from tactile_graph_sources.devices.likeness import Likeness


def test_no_unit_is_nothing_to_remember() -> None:
    likeness = Likeness(8)
    units = np.random.default_rng(0).integers(0, 256, (20, 8)).astype(np.uint8)
    likeness.remember(units, 20)
    likely = likeness.log_likelihood(units[:3])
    likeness.remember(units[:0], 0)
    assert np.array_equal(likeness.log_likelihood(units[:3]), likely)
