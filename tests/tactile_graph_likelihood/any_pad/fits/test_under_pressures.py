"""Which pressures are worth a fit: not those that something else explains."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from tactile_graph_likelihood.any_pad.fits import under_pressures
from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.any_pad.locate import LocateDisc
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.single.any_pressure import RISE

sys.path.insert(0, str(Path(__file__).parents[4] / "benchmarks"))
from second_simulator import KINDS, Bench

STEP = LocateDisc()


def asked(kind: str, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return which pressures were fitted on some frames of a kind of pad."""
    found: list[str] = []
    fitted = AnyPad.pressed

    def pressed(self, part, readings, even):  # type: ignore[no-untyped-def]
        found.append(part)
        return fitted(self, part, readings, even)

    with monkeypatch.context() as patched:
        patched.setattr(AnyPad, "pressed", pressed)
        for frame in Bench(KINDS[kind], np.random.default_rng(2)).frames(24, "disc"):
            its, readings, even = STEP._any_pad.first(observed(frame.image, STEP._pad, None))
            its.completed(readings, even)
    return found


@pytest.mark.slow
def test_a_pad_that_saturates_is_not_asked_for_a_stiff_face(monkeypatch) -> None:
    assert asked("saturation 60 g", monkeypatch).count(RISE) <= 1
    monkeypatch.setattr(under_pressures, "SATURATED", 9.0)
    assert asked("saturation 60 g", monkeypatch).count(RISE) > 5


@pytest.mark.slow
def test_foam_is_not_asked_for_where_strays_are_what_is_unlikely(monkeypatch) -> None:
    few = asked("3 stuck elements", monkeypatch).count("foam")
    monkeypatch.setattr(under_pressures, "FEW_STRAYS", 1.0)
    assert asked("3 stuck elements", monkeypatch).count("foam") > few
