"""Known noise brought in before blocks of a pipeline, and what it does to the answer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load, loads
from tactile_graph_thesis.measure.rectangles import angle_error_degree
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]


class Noise(NamedTuple):
    """One kind of noise and the steps and settings that bring it in.

    Parameters
    ----------
    name : str
    step : str
    setting : str
        The step's setting that takes the level.
    unit : str
    levels : tuple of float
    """

    name: str
    step: str
    setting: str
    unit: str
    levels: tuple[float, ...]


VOLTS = Noise("noise on the image", "add_noise", "sd", "V", (0.001, 0.002, 0.005, 0.01, 0.02, 0.05))
CONTACTS = Noise("cells switched on", "flip_cells", "on", "share", (0.005, 0.01, 0.02, 0.05, 0.1))
VOIDS = Noise("cells switched off", "flip_cells", "off", "share", (0.005, 0.01, 0.02, 0.05, 0.1))
MOVED = Noise("points moved", "jitter_points", "sd_cm", "cm", (0.05, 0.1, 0.2, 0.5, 1.0))

WIRED = ("in", "first_of")
"""Where a node of a file names what it reads."""


def noisy(pipeline: str, after: str, noise: Noise, level: float) -> Any:
    """Return a pipeline with noise brought in between a node and all that reads it.

    Parameters
    ----------
    pipeline : str
    after : str
        The node, or ``frame``. Conditions still see it without the noise.
    noise : Noise
    level : float
    """
    import yaml

    data = yaml.safe_load(load(pipeline).text)
    added = f"{after}_noisy"
    nodes = {
        name: {**node, **{k: _rewired(node[k], after, added) for k in WIRED if k in node}}
        for name, node in data["nodes"].items()
    }
    nodes[added] = {"step": noise.step, "in": after, "with": {noise.setting: level}}
    return loads(yaml.safe_dump({**data, "nodes": nodes}, sort_keys=False), f"{pipeline}, noisy")


def _rewired(wires: Any, old: str, new: str) -> Any:
    """Return a node's ``in`` with one reference replaced, fields included."""
    if isinstance(wires, str):
        if old == "frame":  # its noisy image stands for it; time and number have no noise
            return new if wires in ("frame", "frame.image") else wires
        head, dot, rest = wires.partition(".")
        return new + dot + rest if head == old else wires
    if isinstance(wires, list):
        return [_rewired(w, old, new) for w in wires]
    return {port: _rewired(w, old, new) for port, w in wires.items()}


class Response(NamedTuple):
    """What noise does to a pipeline's answer.

    Parameters
    ----------
    error : ndarray, shape (2,)
        Mean size of the answer's two errors against the truth.
    moved : ndarray, shape (2,)
        Root mean square of how far the noise moves the two, against the answer without it.
    missing : float
        Share of the readings with an answer only without the noise.
    """

    error: Array
    moved: Array
    missing: float


def circle_values(result: Any, true: Any) -> Array | None:
    """Return errors of centre (x, y) and radius in cm, shape (3,).

    Parameters
    ----------
    result : Result
    true : Circle
    """
    found = result.get("circle")
    if found is None:
        return None
    return np.array(
        [found.x_cm - true.x_cm, found.y_cm - true.y_cm, found.radius_cm - true.radius_cm]
    )


def rectangle_values(result: Any, true: Any) -> Array | None:
    """Return errors of angle in degrees, modulo 180, and of length in cm, shape (2,).

    Parameters
    ----------
    result : Result
    true : Rectangle
    """
    found = result.get("rectangle")
    if found is None:
        return None
    return np.array([angle_error_degree(result, true), found.length_cm - true.length_cm])


def answers(pipeline: Any, frames: list[Frame], values: Any, seed: int) -> list[Array | None]:
    """Return each frame's errors, None without an answer.

    Parameters
    ----------
    pipeline : Pipeline
    frames : list of Frame
    values : callable
        `circle_values` or `rectangle_values`.
    seed : int
    """
    runner = pipeline.runner(seed=seed)
    return [values(runner(f), f.truth[0].shape) for f in frames if f.truth]


def response(noised: list[Array | None], clean: list[Array | None]) -> Response:
    """Return what noise did.

    Parameters
    ----------
    noised, clean : list of ndarray or None
        From `answers`, of the same frames.
    """
    had = [(a, b) for a, b in zip(noised, clean, strict=True) if b is not None]
    both = [(a, b) for a, b in had if a is not None]
    if not both:
        return Response(np.full(2, np.nan), np.full(2, np.nan), 1.0)
    ours, before = (np.array([pair[k] for pair in both]) for k in (0, 1))
    moved = ours - before
    if moved.shape[1] == 2:  # angles are modulo half turns
        moved[:, 0] = (moved[:, 0] + 90.0) % 180.0 - 90.0
    return Response(
        _pair(ours, lambda v: float(np.abs(v).mean())),
        _pair(moved, lambda v: float(np.sqrt(np.mean(v**2)))),
        1.0 - len(both) / len(had),
    )


def _pair(values: Array, mean: Any) -> Array:
    """Return one number for centre and radius, or for angle and length."""
    if values.shape[1] == 3:
        distance = np.hypot(values[:, 0], values[:, 1])
        return np.array([mean(distance), mean(values[:, 2])])
    return np.array([mean(values[:, 0]), mean(values[:, 1])])


# -- chains of blocks -------------------------------------------------------------------------


READINGS, QUICK_READINGS = 100, 15
"""Of each object."""
CELLS = (CONTACTS, VOIDS)
NOISES = (VOLTS, CONTACTS, VOIDS, MOVED)
NOT_IN_THE_THESIS = "The thesis has no such numbers: section 6.1.3 wishes for them."


class Chain(NamedTuple):
    """A pipeline, where noise is brought in, and what is read off at its end.

    Parameters
    ----------
    pipeline, scene : str
    n_objects : int
    places : mapping
        Node -> the noises brought in after it.
    blocks : mapping
        Node -> the block that reads it first.
    values : callable
    quantities : (str, str), (str, str)
        Names and units of what is read off.
    """

    pipeline: str
    scene: str
    n_objects: int
    places: Mapping[str, tuple[Noise, ...]]
    blocks: Mapping[str, str]
    values: Any
    quantities: tuple[tuple[str, str], tuple[str, str]]


CIRCLE = Chain(
    "circle-3",
    "discs",
    3,
    {
        "frame": (VOLTS,),
        "footprint": CELLS,
        "fine": CELLS,
        "eroded": CELLS,
        "dilated": CELLS,
        "boundary": (MOVED,),
        "hull": (MOVED,),
    },
    {
        "frame": "threshold",
        "footprint": "subdivision",
        "fine": "erosion",
        "eroded": "dilation",
        "dilated": "boundary",
        "boundary": "convex hull",
        "hull": "circle fit",
    },
    circle_values,
    (("centre", "cm"), ("radius", "cm")),
)
RECTANGLE = Chain(
    "rectangle-1",
    "rectangles",
    2,
    {
        "frame": (VOLTS,),
        "footprint": CELLS,
        "clean": CELLS,
        "boundary": (MOVED,),
        "turned": (MOVED,),
    },
    {
        "frame": "threshold",
        "footprint": "low pass and comparison",
        "clean": "orientation and boundary",
        "boundary": "rotation",
        "turned": "ellipse fit",
    },
    rectangle_values,
    (("angle", "degree"), ("length", "cm")),
)
Responses = dict[tuple[str, str], list[Response]]
"""(node, noise's name) -> a `Response` without noise and one for each level."""


def chain_responses(work: Work, chain: Chain) -> Responses:
    """Return what noise before each block of a chain does to its answer.

    Parameters
    ----------
    work : Work
    chain : Chain
    """

    def made() -> Responses:
        n = min(QUICK_READINGS if work.quick else READINGS, work.readings)
        frames = work.frames(chain.scene, chain.n_objects * work.readings)[: chain.n_objects * n]
        return responses(chain, frames, work.seed)

    return work.once(("noise", chain.pipeline, *chain.places), made)


def responses(chain: Chain, frames: list[Frame], seed: int) -> Responses:
    """Return a response for every place, noise and level of a chain, that without noise first.

    Parameters
    ----------
    chain : Chain
    frames : list of Frame
        Of its scene.
    seed : int
    """
    clean = answers(load(chain.pipeline), frames, chain.values, seed)

    def noised(node: str, noise: Noise, level: float) -> Response:
        pipeline = noisy(chain.pipeline, node, noise, level)
        return response(answers(pipeline, frames, chain.values, seed), clean)

    return {
        (node, noise.name): [
            response(clean, clean),
            *(noised(node, noise, level) for level in noise.levels),
        ]
        for node, noises in chain.places.items()
        for noise in noises
    }
