"""Which reading a figure of single images shows: the middling one, or the worst."""

from __future__ import annotations

from typing import Any

import numpy as np

from tactile_graph import Frame
from tactile_graph_thesis.measure.circles import circle_errors
from tactile_graph_thesis.work import Work

TRIED = 41
"""Readings of an object among which one is chosen."""


def of_object(work: Work, scene: str, name: str, n_objects: int) -> list[Frame]:
    """Return the first readings of one object of a scene.

    Parameters
    ----------
    work : Work
    scene : str
    name : str
    n_objects : int
        How many objects the scene lays down in turn.
    """
    tried = min(TRIED, work.readings)
    frames = work.frames(scene, n_objects * work.readings)[: n_objects * tried]
    return [f for f in frames if f.truth and f.truth[0].name == name]


def typical_disc(work: Work, name: str) -> Frame:
    """Return the reading of a disc of table 4.2 with circle-3's middling radius error.

    Parameters
    ----------
    work : Work
    name : str
    """
    frames = of_object(work, "discs", name, 3)
    return frames[int(np.argsort(_radius_errors(work, frames, name, "circle-3"))[len(frames) // 2])]


def failing_disc(work: Work, name: str) -> Frame:
    """Return the reading of a disc where the hull betters the radius of circle-2 most.

    Parameters
    ----------
    work : Work
    name : str
    """
    frames = of_object(work, "discs", name, 3)
    before, after = (_radius_errors(work, frames, name, p) for p in ("circle-2", "circle-3"))
    return frames[int((before - after).argmax())]


def _radius_errors(work: Work, frames: list[Frame], name: str, pipeline: str) -> Any:
    from tactile_graph import load

    return circle_errors(frames, [load(pipeline).runner(seed=work.seed)], [name])[0, 0, :, 2]


def typical_rectangle(work: Work, name: str) -> Frame:
    """Return the reading of a rectangle of table 4.6 with rectangle-1's middling length error.

    Parameters
    ----------
    work : Work
    name : str
    """
    from tactile_graph import load
    from tactile_graph_thesis.measure.rectangles import signed_errors

    frames = of_object(work, "rectangles", name, 2)
    runner = load("rectangle-1").runner(seed=work.seed)
    errors = np.abs(signed_errors(runner, frames)[name][:, 1])
    return frames[int(np.argsort(errors)[len(frames) // 2])]
