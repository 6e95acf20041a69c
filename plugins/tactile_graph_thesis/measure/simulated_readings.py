"""Readings of objects on the simulated pad, and what they make known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tactile_graph_classifiers.database.known import Known, KnownObject
from tactile_graph_classifiers.database.statistics import Statistics
from tactile_graph_classifiers.measuring.measurements import Measurements
from tactile_graph_classifiers.measuring.shapes import true_name, true_shape

SCENES_OF_THE_THESIS = ("identify", "rectangles")
N_READINGS = 25
"""Of each object in the thesis, to learn it and to test it."""


@dataclass
class Readings:
    """Readings of one object in the order they were made."""

    shape: str = ""
    rows: list[Measurements] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)

    def learned(self, name: str, n: int | None = None) -> KnownObject:
        """Return the object as its first ``n`` readings make it.

        Parameters
        ----------
        name : str
        n : int, optional
        """
        rows = np.array([m.values for m in self.rows[:n]])
        sources = tuple(self.sources[:n])
        return KnownObject(name, self.shape, rows, Statistics.of(rows), sources)


def simulated(
    pipeline: Any, scene: str | Mapping[str, Any], n_each: int, n_objects: int, seed: int,
    pad: str = "thesis",
) -> dict[str, Readings]:  # fmt: skip
    """Return readings of each object of a scene that lays them down in turn, on one pad.

    Parameters
    ----------
    pipeline : Pipeline
        Its node ``features`` measures.
    scene : str or mapping
    n_each, n_objects : int
        Placements of each object, and how many objects there are.
    seed : int
    pad : str
    """
    runs = pipeline.with_source("simulate", scene=scene, frames=n_each * n_objects, pad=pad)
    found: dict[str, Readings] = {}
    for result in runs.stream(only=["features"], seed=seed):
        value = result.outcome("features")
        measured = getattr(value, "measurements", value)
        if not isinstance(measured, Measurements):
            continue  # skipped or failed: nothing was measured, as on a real pad
        readings = found.setdefault(true_name(result.frame), Readings())
        readings.shape = true_shape(result.frame)
        readings.rows.append(measured)
        readings.sources.append(f"simulated, seed {seed}, frame {result.frame.index}")
    return found


def known_from(readings: Mapping[str, Readings], n: int | None = None, pipeline: str = "") -> Known:
    """Return what the first ``n`` readings of each object make known.

    Parameters
    ----------
    readings : mapping
        By the objects' names.
    n : int, optional
        All if not given.
    pipeline : str
        Name of the pipeline that measured.
    """
    first = next(iter(readings.values())).rows[0]
    objects = tuple(r.learned(name, n) for name, r in readings.items())
    return Known("simulated", first.names, first.quantity, objects, pipeline)


def learned_from(scenes: Sequence[str], n: int, seed: int) -> Known:
    """Return the objects of scenes as ``n`` simulated readings each make them known.

    Parameters
    ----------
    scenes : sequence of str
        Each lays its objects down in turn.
    n : int
    seed : int
    """
    from tactile_graph import load
    from tactile_graph_sources.scene import load_scene

    pipeline = load("features")
    readings: dict[str, Readings] = {}
    for scene in scenes:
        readings.update(simulated(pipeline, scene, n, len(load_scene(scene).in_turn), seed))
    return known_from(readings, pipeline=pipeline.name)


def as_database(known: Known) -> dict[str, Any]:
    """Return known objects as the classifiers' setting ``database`` takes them.

    Parameters
    ----------
    known : Known
    """
    from tactile_graph_classifiers.database.text import FORMAT, VERSION

    objects = [
        {"name": o.name, "shape": o.shape, "readings": o.readings.tolist()} for o in known.objects
    ]
    return {
        "format": FORMAT,
        "version": VERSION,
        "quantity": known.quantity,
        "features": list(known.features),
        "objects": objects,
    }
