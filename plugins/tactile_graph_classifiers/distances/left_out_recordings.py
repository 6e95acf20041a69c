"""How well objects are told apart when whole recordings of them are left out."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tactile_graph.errors import one_of
from tactile_graph_classifiers.database.choice import Manner
from tactile_graph_classifiers.database.known import Known, KnownObject
from tactile_graph_classifiers.database.names import recording_of
from tactile_graph_classifiers.distances.choosing import left_out_names
from tactile_graph_classifiers.distances.discriminant_model import Labels
from tactile_graph_classifiers.distances.examples import Examples

MOST_NAMED = 6


class ByRecording(NamedTuple):
    """What became of readings when none of their recording was learned.

    Parameters
    ----------
    n_left_out, n_right : int
        Readings of objects of several recordings, and how many were named right.
    of_one : tuple of str
        Objects whose readings are of one recording: nothing else is known of them.
    """

    n_left_out: int
    n_right: int
    of_one: tuple[str, ...]

    def lines(self) -> list[str]:
        """Return what is to be said of it, for people."""
        told = []
        if self.n_left_out:
            share = 100.0 * self.n_right / self.n_left_out
            told.append(
                f"{share:.1f} % of {self.n_left_out} readings are named right when all of their "
                "recording are left out"
            )
        if self.of_one:
            told.append(
                f"of one recording: {one_of(self.of_one, MOST_NAMED)}; if its frames are of one "
                "press, what is named right says little of another press: learn several recordings"
            )
        return told


def by_recording(known: Known, manner: Manner) -> ByRecording:
    """Return how well readings are named by what other recordings tell.

    Parameters
    ----------
    known : Known
    manner : Manner
        Chosen for them.
    """
    runs = [_recordings(it) for it in known.objects]
    of_one = tuple(
        it.name for it, run in zip(known.objects, runs, strict=True) if len(run) > 1 > run.max() + 1
    )
    examples = Examples.of(known)._replace(runs=np.concatenate(runs))
    true, named = left_out_names(examples, manner)
    return ByRecording(len(true), int(np.count_nonzero(named == true)), of_one)


def _recordings(it: KnownObject) -> Labels:
    """Return which of its recordings each reading is of; -1 where there is but one."""
    names = [recording_of(source) for source in it.sources]
    numbers = {name: k for k, name in enumerate(dict.fromkeys(names))}
    if len(numbers) < 2:
        return np.full(len(it.readings), -1, np.intp)
    return np.array([numbers[name] for name in names], np.intp)
