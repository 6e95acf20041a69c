"""The settings of the source ``recording`` as command lines give them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tactile_graph.errors import UsageError
from tactile_graph.pipeline.document import assignment
from tactile_graph.plugins.registry import installed
from tactile_graph.steps.settings import validate_settings


def reader_settings(given: Sequence[str], step: str = "recording") -> dict[str, Any]:
    """Return validated settings of a source from texts such as ``rows=12``.

    Raises
    ------
    UsageError
        With everything that is wrong with them.
    """
    signature = installed().step(step)
    wanted = dict(assignment("--with", text) for text in given)
    known = {"path": "recording", **wanted} if step == "recording" else wanted
    values, troubles = validate_settings(signature, known)
    lines = [f"source {step}, {'.'.join(map(str, p)) + ': ' if p else ''}{m}" for p, m in troubles]
    if lines:
        raise UsageError("\n".join(lines))
    return {k: v for k, v in values.items() if k in wanted}
