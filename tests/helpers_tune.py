"""A ladder of hand-made steps, and frames whose truth they find or miss."""

from __future__ import annotations

import numpy as np

from tactile_graph import Circle, Frame
from tactile_graph.wires import TrueObject

LADDER = """\
pipeline: ladder
about: A disc by its area, or one that always lies at 1, 1
source: {step: made, with: {frames: 12, empty: [3, 7]}}
conditions:
  touched: footprint.count > 0
  volt: frame.image.quantity == "volt"
nodes:
  footprint: {step: pressed, in: frame, with: {level_v: 0.5}}
  load: {step: load, in: frame}
  merged: {step: merge, in: [footprint], when: touched and volt}
  first: {step: disc, in: merged, with: {fail_at_x: 1}}
  fixed: {step: either, in: footprint, when: load.total < 9 and touched}
  good: {first_of: [first], when: first.radius_cm > 0.9}
  circle: {first_of: [good, fixed]}
outputs: [circle]
"""


def frames(n: int = 12, labels: tuple[str, ...] = ("",)) -> list[Frame]:
    """Return discs of 4 or 6 cells, every third frame without any."""
    found = []
    for i in range(n):
        values, wide = np.zeros((6, 8)), 2 + i % 2
        if i % 3:
            values[1:3, i % 5 : i % 5 + wide] = 1.0 + 0.1 * (i % 4)
        truth = (TrueObject(Circle(i % 5 + 0.5 * wide, 2.0, 1.0)),) if i % 3 else ()
        label = labels[i * len(labels) // n]
        found.append(Frame.of(values, quantity="volt", index=i, truth=truth, label=label))
    return found
