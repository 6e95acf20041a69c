"""The stream: discs put down one after the other, read over and over at 1 kHz, and empty pads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tactile_graph import Frame, load

EMPTY_SHARE = 0.2
RADII_CM = (2.2, 7.0)
LIES = (20, 150)
"""Least and most frames that a disc lies."""


def stream(n_frames: int, seed: int) -> list[Frame]:
    """Return frames of the thesis' pad: a small disc is quick to locate, a large one slow."""
    rng = np.random.default_rng(seed)
    frames: list[Frame] = []
    while len(frames) < n_frames:
        lies = int(rng.integers(*LIES))
        scene = {"in_turn": [_things(rng)], "hold": lies}
        pad = load("locate").with_source("simulate", scene=scene, pad="thesis", frames=lies)
        frames += pad.frames(int(rng.integers(2**31)))
    return [replace(f, index=i, time_s=i * 1e-3) for i, f in enumerate(frames[:n_frames])]


def _things(rng: np.random.Generator) -> list[dict[str, object]]:
    if rng.random() < EMPTY_SHARE:
        return []
    radius_cm = float(rng.uniform(*RADII_CM))
    weight_g = 60.0 * radius_cm**2 * float(rng.uniform(0.5, 1.5))
    return [{"shape": "disc", "weight_g": weight_g, "radius_cm": radius_cm}]
