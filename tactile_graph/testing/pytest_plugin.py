"""Fixtures for the tests of plugins, where a conftest names this module among ``pytest_plugins``.

Each is a function of `tactile_graph.testing`, imported when a test asks for it. This is no entry
point of pytest's: all modules of the project would then be rewritten for assertions, in every test
run of whoever has it installed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest


@pytest.fixture(scope="session")
def run_step() -> Callable[..., Any]:
    """``run_step(step, *inputs, settings={…})``: what a step gives, watched and checked."""
    from tactile_graph.testing.running import run_step

    return run_step


@pytest.fixture(scope="session")
def run_pipeline() -> Callable[..., Any]:
    """``run_pipeline(text_or_name, *frames)``: the results; a failed node fails the test."""
    from tactile_graph.testing.running import run_pipeline

    return run_pipeline


@pytest.fixture(scope="session")
def isolated_registry() -> Callable[..., Any]:
    """``isolated_registry(steps={…}, plugin=module)``: the project's plugins and these alone."""
    from tactile_graph.testing.registries import isolated

    return isolated
