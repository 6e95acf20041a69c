"""Which reading a figure of single images shows, and every node of a pipeline for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load
from tactile_graph_thesis.measure.circles import circle_errors
from tactile_graph_thesis.measure.rectangles import signed_errors
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
TRIED = 41
"""Readings of an object among which one is chosen."""
DISCS = ("DISC I", "DISC II", "DISC III")
RECTANGLES = ("RECTANGLE I", "RECTANGLE II")
_LOST = "The thesis shows one reading of its own pad, which nobody has any more. "
ONE_DISC = (
    _LOST + "Ours is the simulated reading of the same disc on which circle-3's error is the "
    "middling one of those tried."
)
ONE_RECTANGLE = (
    _LOST + "Ours is the simulated reading of the same rectangle on which rectangle-1's length "
    "error is the middling one of those tried."
)


def true_shape(frame: Frame) -> Any:
    """Return what truly lay there.

    Parameters
    ----------
    frame : Frame
    """
    assert frame.truth is not None
    return frame.truth[0].shape


# -- which reading ---------------------------------------------------------------------------


def typical_disc(work: Work, name: str = DISCS[0]) -> Frame:
    """Return the reading of a disc of table 4.2 with circle-3's middling radius error.

    Parameters
    ----------
    work : Work
    name : str
    """

    def middling(frames: list[Frame]) -> int:
        errors = radius_errors(work, frames, name, "circle-3")
        return int(np.argsort(errors)[len(frames) // 2])

    return _chosen(work, "typical", "discs", name, middling)


def failing_disc(work: Work, name: str = DISCS[0]) -> Frame:
    """Return the reading of a disc where the hull betters the radius of circle-2 most.

    Parameters
    ----------
    work : Work
    name : str
    """

    def worst(frames: list[Frame]) -> int:
        before, after = (
            radius_errors(work, frames, name, pipeline) for pipeline in ("circle-2", "circle-3")
        )
        return int((before - after).argmax())

    return _chosen(work, "failing", "discs", name, worst)


def typical_rectangle(work: Work, name: str = RECTANGLES[1]) -> Frame:
    """Return the reading of a rectangle of table 4.6 with rectangle-1's middling length error.

    Parameters
    ----------
    work : Work
    name : str
    """

    def middling(frames: list[Frame]) -> int:
        runner = load("rectangle-1").runner(seed=work.seed)
        errors = np.abs(signed_errors(runner, frames)[name][:, 1])
        return int(np.argsort(errors)[len(frames) // 2])

    return _chosen(work, "typical", "rectangles", name, middling)


def readings_of(work: Work, scene: str, name: str) -> list[Frame]:
    """Return the first readings of one object of a scene.

    Parameters
    ----------
    work : Work
    scene : "discs" or "rectangles"
    name : str
    """
    n_objects = len(DISCS if scene == "discs" else RECTANGLES)
    tried = min(TRIED, work.readings)
    frames = work.frames(scene, n_objects * work.readings)[: n_objects * tried]
    return [f for f in frames if f.truth and f.truth[0].name == name]


def _chosen(
    work: Work, kind: str, scene: str, name: str, choose: Callable[[list[Frame]], int]
) -> Frame:
    """Return the reading that ``choose`` gives the place of; of each kind it is chosen once."""

    def made() -> Frame:
        frames = readings_of(work, scene, name)
        return frames[choose(frames)]

    return work.once((kind, name), made)


def radius_errors(work: Work, frames: list[Frame], name: str, pipeline: str) -> Array:
    """Return the sizes of a pipeline's radius errors on readings of one disc, in cm.

    Parameters
    ----------
    work : Work
    frames : list of Frame
    name, pipeline : str
    """
    runner = load(pipeline).runner(seed=work.seed)
    return np.asarray(circle_errors(frames, [runner], [name])[0, 0, :, 2])


# -- every node of it ------------------------------------------------------------------------


def stages(pipeline: str, frame: Frame, seed: int = 0) -> Any:
    """Return the result of a frame with every node of the pipeline asked for.

    Parameters
    ----------
    pipeline : str
    frame : Frame
    seed : int
    """
    loaded = load(pipeline)
    return loaded.run(frame, only=list(loaded.nodes), seed=seed)


def setting(pipeline: str, node: str, name: str) -> Any:
    """Return a setting of a node as the pipeline file, or the step's default, has it.

    Parameters
    ----------
    pipeline, node, name : str
    """
    return load(pipeline).nodes[node].settings[name]
