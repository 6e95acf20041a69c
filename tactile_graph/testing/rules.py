"""The rules a step declares of its output, held against an answer and the inputs it was made of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tactile_graph.steps.rules import Grid
from tactile_graph.steps.signature import Signature
from tactile_graph.wires import Image, Mask


def broken_rule(
    signature: Signature, settings: Mapping[str, Any], inputs: Mapping[str, Any], value: Any
) -> str:
    """Return which rule of quantity or grid an image or mask breaks; "" where it breaks none."""
    if not isinstance(value, Image | Mask):
        return ""
    if value.values.ndim != 2:
        return f"gives values of shape {value.values.shape}, not (rows, columns)"
    if value.values.dtype.kind not in "biuf":
        return f"gives values of type {value.values.dtype}, not numbers"
    wrong = _grid(signature.output_grid, settings, inputs, value)
    rule = signature.output_quantity
    if wrong or rule is None or not isinstance(value, Image):
        return wrong
    given = inputs.get(rule.port)
    allowed = (given.quantity,) if isinstance(given, Image) else rule.names
    if not allowed or value.quantity in allowed:
        return ""
    return f"promises {' or '.join(allowed)}, but gives {value.quantity}"


def _grid(
    rule: Grid | None, settings: Mapping[str, Any], inputs: Mapping[str, Any], value: Image | Mask
) -> str:
    given = inputs.get(rule.port) if rule is not None else None
    if rule is None or not isinstance(given, Image | Mask):
        return ""
    finer = rule.finer_by if isinstance(rule.finer_by, int) else settings[rule.finer_by]
    wanted = (given.shape[0] * finer, given.shape[1] * finer)
    if value.shape != wanted:
        return f"promises {' x '.join(map(str, wanted))} cells, but gives " + " x ".join(
            map(str, value.shape)
        )
    pitch_cm = tuple(p / finer for p in given.pitch_cm)
    near = all(abs(a - b) <= 1e-9 * b for a, b in zip(value.pitch_cm, pitch_cm, strict=True))
    return "" if near else f"promises a pitch of {pitch_cm} cm, but gives {value.pitch_cm}"
