"""A bowl pressed on an even pad, for the tests of reliefs, and simulated objects on a strip."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from unittest.mock import patch

import numpy as np

from tactile_graph import Frame, load
from tactile_graph_classifiers.commands.learn import image_of
from tactile_graph_classifiers.database.rows import Lesson, Setting
from tactile_graph_classifiers.database.store import ObjectDatabase
from tactile_graph_classifiers.measuring.reader import Given, Reader
from tactile_graph_classifiers.reliefs import of_database
from tactile_graph_classifiers.reliefs.kernels import NODES
from tactile_graph_classifiers.reliefs.pad_reading import Law, PadReading
from tactile_graph_classifiers.reliefs.presses import Presses
from tactile_graph_classifiers.reliefs.relief import Relief

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from pressed_objects import STRIP, Pad, Thing, box, disc

SHAPE = (12, 20)
BOX = np.array([0, 2, 12, 16])
STRIP_LAW = Law(STRIP.blur_cells, STRIP.law, STRIP.threshold)
THINGS = [Thing("disc", disc(1.1), 0.4), Thing("box", box(3.0, 1.5), 0.4)]


def bowl(n: int = 61) -> np.ndarray:
    """Return an elliptic bowl, 0.1 of full scale deep a cell from its middle."""
    at = (np.arange(n) - n // 2) / NODES
    v, u = np.meshgrid(at, at, indexing="ij")
    return 0.1 * u**2 + 0.2 * v**2


def even_pad() -> PadReading:
    """Return an even pad, whose readings vary by little."""
    return PadReading(
        STRIP_LAW, np.ones(SHAPE), np.zeros(SHAPE), 0.99, np.array([1e-6, 1e-4, 1e-4])
    )


def as_presses(values, boxes, centres) -> Presses:
    """Return readings of full scale as presses."""
    values = np.asarray(values, dtype=np.float64)
    return Presses(values, np.ones(values.shape, dtype=bool), np.asarray(boxes),
                   np.asarray(centres, dtype=np.float64))  # fmt: skip


def relief(depth, presses, misfits, usual: float = 0.4) -> Relief:
    """Return a relief."""
    return Relief(depth, np.asarray(presses), usual, 0.01, np.asarray(misfits, dtype=np.float64),
                  depth, np.zeros(2))  # fmt: skip


def pressed_on_a_strip(things: list[Thing], n: int, seed: int) -> list[np.ndarray]:
    """Return n presses of each thing."""
    pad = Pad(STRIP, np.random.default_rng(seed))
    return [np.array([pad.press(t).image.values for _ in range(n)], float) for t in things]


def learned_with_reliefs(
    path: Path, pressed: Mapping[str, Sequence[Frame]], law: Law = STRIP_LAW
) -> Path:
    """Learn objects of their frames, with their reliefs, and return the database's path.

    The pad's law is told, as to choose one takes longer than all else.
    """
    pipeline = load("describe")
    reader = Reader(Given(pipeline, "features", 0, image_of(pipeline, "features", ())))
    store = ObjectDatabase(path)
    for name, frames in pressed.items():
        found = reader.readings(frames)
        rows = np.array([one.values for one in found.rows])
        unit = str(frames[0].image.quantity)
        setting = Setting(found.rows[0].names, unit)
        lesson = Lesson(name, "", rows, found.sources)
        store.learn(setting, [lesson], presses={name: found.presses})
    known, images = store.presses()
    with patch.object(of_database, "chosen_law", lambda presses, say: law):
        found = of_database.learned_of(known, images, lambda _: None)
    store.keep_reliefs(found.kept(), known)
    return store.path
