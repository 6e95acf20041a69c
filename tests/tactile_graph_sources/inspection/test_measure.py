"""What a recording's frames tell: how they follow each other."""

from dataclasses import replace

import numpy as np
import pytest

from tactile_graph.wires import Frame
from tactile_graph_sources.inspection.measure import measure

BURST, STEP_S = 10, 0.01


def bursts(by_device: bool) -> list[Frame]:
    """Return frames that came ten at a time, of a hundred a second."""
    values = np.random.default_rng(0).integers(0, 9, (100, 4, 4)).astype(float)
    frames = [
        Frame.of(v, index=k, time_s=BURST * STEP_S * (k // BURST)) for k, v in enumerate(values)
    ]
    if by_device:
        return [replace(f, device_time_s=3.0 + STEP_S * f.index) for f in frames]
    return frames


def test_the_rate_is_that_of_the_devices_clock() -> None:
    found = measure(bursts(by_device=True))
    assert found.rate_hz == pytest.approx(100.0)
    assert found.jitter == pytest.approx(0.0, abs=1e-6)
    assert found.duration_s == pytest.approx(0.99)


def test_frames_that_come_in_bursts_have_no_even_step() -> None:
    found = measure(bursts(by_device=False))
    assert found.rate_hz == pytest.approx(99.0 / 0.9)
    assert found.jitter is None
