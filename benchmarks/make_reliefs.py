"""Write the sample of known reliefs: simulated presses of the objects of thesis table 4.9.

python benchmarks/make_reliefs.py
"""

from __future__ import annotations

import sqlite3
from itertools import islice

import numpy as np

from tactile_graph import load
from tactile_graph.compiled import warm_up
from tactile_graph.wires import Frame
from tactile_graph_classifiers.commands.learn import image_of
from tactile_graph_classifiers.database.opening import RELIEFS
from tactile_graph_classifiers.database.rows import Lesson, Setting
from tactile_graph_classifiers.database.store import ObjectDatabase
from tactile_graph_classifiers.distances.choosing import choose
from tactile_graph_classifiers.distances.examples import Examples
from tactile_graph_classifiers.measuring.reader import Given, Reader
from tactile_graph_classifiers.measuring.shapes import true_name
from tactile_graph_classifiers.reliefs.of_database import learned_of

SEED = 44
N_OBJECTS, N_PRESSES = 5, 25


def main() -> None:
    warm_up()
    pipeline = load("features").with_source(
        "simulate", scene="identify", frames=N_OBJECTS * N_PRESSES
    )
    read = Reader(Given(pipeline, "features", SEED, image_of(pipeline, "features", ())))
    by_name: dict[str, list[Frame]] = {}
    for frame in islice(pipeline.frames(SEED), N_OBJECTS * N_PRESSES):
        by_name.setdefault(true_name(frame), []).append(frame)
    RELIEFS.unlink(missing_ok=True)
    store = ObjectDatabase(RELIEFS)
    for name, frames in by_name.items():
        found = read.readings(frames)
        first = found.rows[0]
        rows = np.array([one.values for one in found.rows])
        setting = Setting(first.names, first.quantity, "features")
        lesson = Lesson(name, found.shape, rows, found.sources)
        store.learn(setting, [lesson], presses={name: found.presses})
    known, presses = store.presses()
    store.keep(choose(Examples.of(known)), known)
    store.keep_reliefs(learned_of(known, presses, print).kept(), known)
    with sqlite3.connect(RELIEFS) as connection:  # a sample need not hold the presses
        connection.execute("DELETE FROM presses")
    connection.execute("VACUUM")
    connection.close()
    print(f"{RELIEFS}: {len(known.objects)} objects, {RELIEFS.stat().st_size} bytes")


if __name__ == "__main__":
    main()
