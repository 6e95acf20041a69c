"""Write the sample of known objects: 25 simulated readings of each object of tables 4.6 and 4.9."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tactile_graph_classifiers.database.known import Known, KnownObject
from tactile_graph_classifiers.database.opening import SAMPLE
from tactile_graph_classifiers.database.statistics import Statistics
from tactile_graph_classifiers.database.text import to_text
from tactile_graph_thesis.measure.simulated_readings import (
    N_READINGS,
    SCENES_OF_THE_THESIS,
    learned_from,
)

SEED = 44
DIGITS = 6


def rounded(known: Known) -> Known:
    """Return the objects with readings of so many digits: a sample need not be longer."""
    objects = []
    for it in known.objects:
        text = [[f"{v:.{DIGITS}g}" for v in row] for row in it.readings.tolist()]
        readings = np.array(text, dtype=np.float64)
        objects.append(
            KnownObject(it.name, it.shape, readings, Statistics.of(readings), it.sources)
        )
    return Known(known.where, known.features, known.quantity, tuple(objects), known.pipeline)


def main() -> None:
    known = rounded(learned_from(SCENES_OF_THE_THESIS, N_READINGS, seed=SEED))
    about = f"objects of thesis tables 4.6 and 4.9, {N_READINGS} simulated readings, seed {SEED}"
    path = Path(SAMPLE)
    path.parent.mkdir(exist_ok=True)
    path.write_text(to_text(known, about), encoding="utf-8")
    print(f"{path}: {len(known.objects)} objects, {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
