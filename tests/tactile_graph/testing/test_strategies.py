"""The strategies draw what travels on wires, and nothing else."""

from __future__ import annotations

import builtins
import importlib
import sys
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from tactile_graph import Frame, Image, Mask, Points
from tactile_graph.errors import UsageError
from tactile_graph.testing import strategies
from tactile_graph.vocabulary import QUANTITIES


@settings(max_examples=4)
@given(strategies.frames("volt"), strategies.images(invalid=False), strategies.masks())
def test_grids_are_as_frames_hold_them(frame: Frame, image: Image, mask: Mask) -> None:
    assert frame.image.quantity == "volt"
    assert np.isfinite(frame.image.values).all()
    assert image.valid is None
    assert min(*image.shape, *mask.shape) >= 1
    assert mask.values.dtype == np.bool_


@settings(max_examples=4)
@given(strategies.points(far_cm=50.0))
def test_points_lie_within_reach(points: Points) -> None:
    assert points.xy_cm.shape == (points.count, 2)
    assert np.abs(points.xy_cm).max(initial=0.0) <= 50.0


@settings(max_examples=4)
@given(strategies.contacts())
def test_contacts_are_those_of_an_image(found: Any) -> None:
    assert found.count == len(found.contacts)


def test_without_hypothesis_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def missing(name: str, *rest: Any) -> Any:
        if name.startswith("hypothesis"):
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.delitem(sys.modules, "tactile_graph.testing.strategies")
    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(UsageError, match=r'pip install "tactile-graph\[test\]"'):
        importlib.import_module("tactile_graph.testing.strategies")


def test_a_quantity_that_a_plugin_offers_is_drawn_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(QUANTITIES._words, "newton", "N")

    @settings(max_examples=4, suppress_health_check=[HealthCheck.function_scoped_fixture])
    @given(strategies.images("newton"))
    def check(image: Image) -> None:
        assert image.quantity == "newton"

    check()
