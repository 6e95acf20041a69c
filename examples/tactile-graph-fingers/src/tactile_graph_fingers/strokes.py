"""Source ``strokes``: strokes of known length, to try fits on."""

from collections.abc import Iterator

import numpy as np
from tactile_graph import Frame
from tactile_graph.wires import TrueObject

from tactile_graph_fingers.stroke import Stroke


def strokes(*, frames: int = 5) -> Iterator[Frame]:
    """Yield frames with a stroke pressed into them, in grams, which is their truth."""
    for k in range(frames):
        values = np.zeros((12, 12))
        values[5, 2 : 6 + k] = 40.0
        true = Stroke(2.5, 5.5, 5.5 + k, 5.5)
        yield Frame.of(values, quantity="gram", index=k, truth=(TrueObject(true),))
