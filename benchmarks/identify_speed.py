"""Time of measuring and of identifying among 100 objects, for each classifier."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from tactile_graph import load
from tactile_graph.compiled import warm_up
from tactile_graph_classifiers.database.text import FORMAT, VERSION
from tactile_graph_classifiers.distances.mahalanobis import Mahalanobis
from tactile_graph_classifiers.distances.minimum_distance import MinimumDistance
from tactile_graph_classifiers.distances.minimum_distance_normalised import (
    MinimumDistanceNormalised,
)
from tactile_graph_classifiers.measuring.features import FeaturesOf

N_OBJECTS = 100
N_READINGS = 25
ROUNDS = 2000
ALLOWED_US = 50.0


def many_objects(n: int, seed: int = 0) -> dict[str, Any]:
    """Return an export of objects drawn at random, in four features."""
    rng = np.random.default_rng(seed)
    middle = rng.uniform([200, 20, 0.3, 20], [8000, 220, 1.0, 300], (n, 4))
    readings = middle[:, None] * (1.0 + 0.02 * rng.standard_normal((n, N_READINGS, 4)))
    objects = [{"name": f"object {k}", "readings": r.tolist()} for k, r in enumerate(readings)]
    features = ["weight", "area_cm2", "axis_ratio", "peak"]
    return {"format": FORMAT, "version": VERSION, "quantity": "gram", "features": features,
            "objects": objects}  # fmt: skip


def microseconds(run: Callable[[], object]) -> tuple[float, float]:
    """Return median and 95th percentile of a call's time."""
    for _ in range(300):
        run()
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter_ns()
        run()
        times.append(time.perf_counter_ns() - start)
    return tuple(np.percentile(times, [50, 95]) / 1e3)


def main() -> None:
    warm_up()
    result = load("features").run(next(load("features").frames()), only=["grams", "footprint"])
    image, mask = result["grams"], result["footprint"]
    step = FeaturesOf()
    print(f"features, 16 x 16: {microseconds(lambda: step(image, mask))[0]:.1f} us")
    features = step(image, mask)
    print(f"as measurements: {microseconds(lambda: features.measurements)[0]:.1f} us")
    measured = features.measurements
    data = many_objects(N_OBJECTS)
    for kind in (MinimumDistance, MinimumDistanceNormalised, Mahalanobis):
        for names in (["weight", "area_cm2"], data["features"]):
            start = time.perf_counter()
            one = kind(database=data, features=names)
            loaded = time.perf_counter() - start
            median, late = microseconds(lambda one=one: one(measured))
            verdict = "ok" if median <= ALLOWED_US else "TOO SLOW"
            print(
                f"{kind.__name__} among {N_OBJECTS}, {len(names)} features: {median:.1f} us,"
                f" 95 % within {late:.1f} us (allowed {ALLOWED_US:g}: {verdict});"
                f" loaded in {1e3 * loaded:.0f} ms"
            )


if __name__ == "__main__":
    main()
