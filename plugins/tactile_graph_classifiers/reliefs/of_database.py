"""Reliefs learned of the presses that a database keeps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, one_of
from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.database.relief_rows import Press
from tactile_graph_classifiers.reliefs.choosing_law import chosen_law
from tactile_graph_classifiers.reliefs.known_reliefs import KnownReliefs
from tactile_graph_classifiers.reliefs.learning import Say, learn_reliefs
from tactile_graph_classifiers.reliefs.leaving_out import left_out_misfits
from tactile_graph_classifiers.reliefs.presses import Presses

Array = NDArray[np.float64]
FEWEST = 8
"""Presses an object needs."""


def learned_of(known: Known, images: Sequence[Sequence[Press | None]], say: Say) -> KnownReliefs:
    """Return the reliefs of all objects of a database.

    Parameters
    ----------
    known : Known
    images : sequence of sequence of Press or None
        Of each object's readings.
    say : callable
        Takes lines about how far it is.

    Raises
    ------
    DataError
        If an object has too few images, they are of several pads, or nothing touches in one.
    """
    there = [[one for one in some if one is not None] for some in images]
    lacking = [name for name, some in zip(known.names, there, strict=True) if len(some) < FEWEST]
    if not there or lacking:
        raise DataError(
            known.where,
            f"{one_of(lacking, 30) if lacking else 'no object'}: fewer than {FEWEST} presses are"
            " kept, of which reliefs are learned; learn with --keep-presses",
        )
    pitch_cm = _one_pad(known, there)
    highest = [np.nanmax(press.values, initial=0.0) for some in there for press in some]
    full_scale = float(max(highest)) or 1.0
    all_presses = [_presses(known, k, some, full_scale) for k, some in enumerate(there)]
    law = chosen_law(all_presses, say)
    reliefs, pad = learn_reliefs(all_presses, law, say)
    left = left_out_misfits(reliefs, all_presses, pad, say)
    of_readings = [_of_readings(some, found) for some, found in zip(images, left, strict=True)]
    return KnownReliefs.of(pad, (full_scale, pitch_cm), known.names, reliefs, of_readings)


def _one_pad(known: Known, there: Sequence[Sequence[Press]]) -> float:
    """Return the pitch of the pad that all presses are on.

    Raises
    ------
    DataError
        If they are on several.
    """
    kinds = {(press.values.shape, round(press.pitch_cm, 6)) for some in there for press in some}
    if len(kinds) > 1:
        (shape, pitch), (other, other_pitch), *_ = sorted(kinds)
        raise DataError(
            known.where,
            f"presses are on several pads: {shape[0]} x {shape[1]} cells of {pitch:g} cm and"
            f" {other[0]} x {other[1]} of {other_pitch:g} cm",
        )
    return there[0][0].pitch_cm


def _presses(known: Known, k: int, some: Sequence[Press], full_scale: float) -> Presses:
    try:
        return Presses.of((press.values for press in some), full_scale)
    except ValueError as error:
        raise DataError(known.where, f"{known.names[k]!r}: in a press {error}") from None


def _of_readings(images: Sequence[Press | None], found: Array) -> Array:
    """Return what was found of presses in the places of their readings, NaN elsewhere."""
    out = np.full(len(images), np.nan)
    out[[k for k, press in enumerate(images) if press is not None]] = found
    return out
