"""Step ``score_objects``: how many of the true objects were found, and how far off."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Gt

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Frame
from tactile_graph_tracking.pairing import paired_places
from tactile_graph_tracking.places import places_cm


class ObjectScore(NamedTuple):
    """What was found, beside what was there."""

    n_true: int
    n_found: int
    count_right: bool
    """Whether as many were found as were there."""
    n_paired: int
    """True objects with a found one within the gate."""
    n_missed: int
    """True objects without one."""
    n_extra: int
    """Found objects without a true one."""
    mean_error_cm: float
    """Distance of the centres, mean over the pairs; 0 without any."""
    worst_error_cm: float
    pairs: tuple[tuple[int, int, float], ...]
    """Number of the true and of the found object, from 0, and the distance of their centres."""


def score_objects(
    frame: Frame, found: Sequence[Any | None] = (), *, gate_cm: Annotated[float, Gt(0)] = 2.0
) -> ObjectScore:
    """Return how the objects found pair with the true ones.

    As many pairs as possible are made within the gate, and of all such pairings the one with the
    least sum of distances is taken.

    Parameters
    ----------
    frame : Frame
        With its truth.
    found : list
        Contacts, shapes, tracks, decisions on a shape: anything with ``x_cm`` and ``y_cm`` or a
        ``shape`` that has them. None at all where their node was skipped; an item that is
        None was not found.
    gate_cm : float
        Centres farther apart are no pair.

    Raises
    ------
    Degenerate
        If nobody knows what truly lay on the pad.
    DataError
        If something found has no finite centre.

    Notes
    -----
    Only centres are compared, not kinds or sizes.
    """
    if frame.truth is None:
        raise Degenerate("the frame has no truth to score against")
    true = places_cm([t.shape for t in frame.truth], "truth")
    got = places_cm([f for f in found if f is not None], "score_objects")
    # A pair more is worth any detour: that is what makes their number the first concern.
    alone = gate_cm * (2.0 + len(true))
    pairs = tuple(paired_places(true, got, gate_cm, alone))
    errors = [error for _, _, error in pairs] or [0.0]
    return ObjectScore(
        len(true),
        len(got),
        len(true) == len(got),
        len(pairs),
        len(true) - len(pairs),
        len(got) - len(pairs),
        float(np.mean(errors)),
        max(errors),
        pairs,
    )
