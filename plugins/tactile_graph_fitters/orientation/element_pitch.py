"""How far apart the elements lie that an outline was read from."""

from __future__ import annotations

import math

from tactile_graph.wires import Image

THESIS_PITCH_CM = 1.3
"""What is taken where nobody says: the thesis' pad (section 2.1)."""


def element_pitch_cm(elements: Image | None, told_cm: float | None) -> float:
    """Return the pitch of the elements that were read.

    Parameters
    ----------
    elements : Image, optional
        What they were read as.
    told_cm : float, optional
        Goes before what the image says.

    Returns
    -------
    float
        Of cells that are not square, the side of a square as large.
    """
    if told_cm is not None:
        return told_cm
    if elements is None:
        return THESIS_PITCH_CM
    x_cm, y_cm = elements.pitch_cm
    return x_cm if x_cm == y_cm else math.sqrt(x_cm * y_cm)
