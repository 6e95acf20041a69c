"""What is to be said of contacts whose readings hold what the empty pad reads."""

from __future__ import annotations

from tactile_graph.wires import Image, Mask
from tactile_graph_filters.thresholds.noise_level import level_above, lower_readings

SHARE = 0.25
"""Of what the contacts' cells read above it, from which on what cells read at rest is told."""


def counts_the_offset(image: Image, mask: Mask) -> str:
    """Return what to say where loads and centres are about what cells read at rest; else empty.

    Of a frame without contacts it is told where cells at rest read more than the level above them
    from which on `noise_level` finds some.
    """
    found = lower_readings(image)
    if found is None:
        return ""
    low, rest, peak = found
    on = mask.values if image.valid is None else mask.values & image.valid
    above = float(image.values[on].mean()) - rest if on.any() else 0.0
    enough = SHARE * above if on.any() else level_above(rest - low, rest, peak) - rest
    if abs(rest) <= enough:
        return ""
    return (
        f"cells at rest read about {rest:.4g} {image.unit}, and loads and centres are of the whole "
        "readings; the step 'tare' takes that off, by frames of the empty pad at the start"
    )
