"""Whether recordings can be of one and the same pad."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Image


def check_same_pad(
    first: Image,
    other: Image,
    first_name: str,
    name: str,
    *,
    read_as: Callable[[str], str] = str,
    pitch_known: bool = True,
) -> None:
    """Refuse recordings of different pads, or in different units.

    Parameters
    ----------
    first, other : Image
        A frame of each recording.
    first_name, name : str
        The recordings, for errors.
    read_as : callable, optional
        From a recording's quantity to the one that its readings become: recordings of which these
        are alike go together.
    pitch_known : bool
        Whether both recordings say their pitch; an assumed one is not compared.

    Raises
    ------
    DataError
    """
    if first.shape != other.shape:
        raise DataError(
            name,
            f"has {other.rows} x {other.columns} elements, but {first_name} has {first.rows} x "
            f"{first.columns}: recordings of one pad are needed",
        )
    a, b = first.quantity, other.quantity
    if read_as(a) != read_as(b):
        raise DataError(name, f"holds {b}, but {first_name} {a}: convert one of them")
    p, q = first.pitch_cm, other.pitch_cm
    if pitch_known and p != q and not np.allclose(p, q, rtol=1e-3):  # as a rule the very same
        raise DataError(
            name,
            f"has a pitch of {other.pitch_cm[0]:g} x {other.pitch_cm[1]:g} cm, but {first_name} of "
            f"{first.pitch_cm[0]:g} x {first.pitch_cm[1]:g} cm",
        )
