"""A step's linked form, held against the step itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from tactile_graph.errors import text_of
from tactile_graph.steps.linked import Linked
from tactile_graph.testing.same import same
from tactile_graph.wires.image import Mask
from tactile_graph.wires.parts import MaskParts, PointsParts
from tactile_graph.wires.points import Points


def link_trouble(form: Linked, inputs: Mapping[str, Any], step: Callable[..., Any]) -> str:
    """Return what a linked form gives that the step does not, in words; "" where nothing is."""
    (given,) = inputs.values()
    parts = _parts(given)
    if parts is None:
        return ""
    try:
        done, found = form.loops(parts, *form.settings)
        got = form.made(*found) if done else None
    except Exception as error:
        what = f"{type(error).__name__}: {text_of(error)}"
        return f"its linked form raises {what}; leave such inputs undone"
    if found.__class__ is not form.parts:
        return f"its linked form gives {type(found).__name__}, not {form.parts.__name__}"
    if not done:
        return ""
    try:
        expected = step(**inputs)
    except Exception as error:
        return f"its linked form gives {got!r:.80} where the step raises {text_of(error)}"
    return "" if same(got, expected) else f"its linked form gives {got!r:.80}, not {expected!r:.80}"


def _parts(value: Any) -> MaskParts | PointsParts | None:
    """Return what a wire is made of; None where machine code has no parts for it."""
    if isinstance(value, Points) and value.xy_cm.dtype == np.float64 and value.xy_cm.ndim == 2:
        return PointsParts(np.ascontiguousarray(value.xy_cm))
    if not isinstance(value, Mask) or not 0 < value.shape[1] <= Mask.WIDEST:
        return None
    rows, columns = value.shape
    raw = np.zeros((rows, 8), np.uint8)
    raw[:, : -(-columns // 8)] = np.packbits(value.values, axis=-1, bitorder="little")
    words = raw.view("<u8").reshape(rows).astype(np.uint64)
    (x, y), (left, top) = value.pitch_cm, value.origin_cm
    return MaskParts(words, columns, float(x), float(y), float(left), float(top), value.count)
