"""Kernels answered by plain code or by machine code, as a test asks for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal
from unittest.mock import patch

from tactile_graph.compiled import kernel


@contextmanager
def answered_by(mode: Literal["auto", "plain", "compiled"]) -> Iterator[None]:
    """Let every kernel start anew in a mode, and once more as before afterwards."""
    with patch.dict("os.environ", {kernel.ENVIRONMENT: mode}):
        _restart()
        yield
    _restart()


def _restart() -> None:
    for each in kernel._kernels:
        each.reset()
