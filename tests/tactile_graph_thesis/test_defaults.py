"""The defaults of the steps that bring noise."""

from __future__ import annotations

from helpers_settings import defaults
from tactile_graph_thesis import tactile_graph_steps


def test_every_default_is_the_literal_one() -> None:
    assert defaults(tactile_graph_steps()) == {
        "add_noise": {"sd": "0.01"},
        "flip_cells": {"off": "0.0", "on": "0.0"},
        "jitter_points": {"sd_cm": "0.1"},
    }
