"""Which structuring element may the thesis' #2 have been? Its figure is lost.

Run with ``python benchmarks/structuring_element.py`` (under a minute). Each candidate takes the
place of circle-2's and circle-3's element on random discs of table 4.2, on a pad without
unevenness and on one with lognormal 0.5 and 10 % voids. Printed are mean errors of centre and
radius in cm, and how many readings came out without a circle.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

import numpy as np

from tactile_graph import Frame, load
from tactile_graph.compiled import warm_up

DISC21 = [[0, 1, 1, 1, 0], [1] * 5, [1] * 5, [1] * 5, [0, 1, 1, 1, 0]]
DISC37 = [
    [0, 0, 1, 1, 1, 0, 0],
    [0, 1, 1, 1, 1, 1, 0],
    *[[1] * 7] * 3,
    [0, 1, 1, 1, 1, 1, 0],
    [0, 0, 1, 1, 1, 0, 0],
]
CANDIDATES: dict[str, Any] = {
    "cross3 (the thesis' #1)": "cross3",
    "square3": "square3",
    "disc5: 1 3 5 3 1": "disc5",
    "5x5 less corners: 3 5 5 5 3": DISC21,
    "square5": "square5",
    "disc7: 1 5 5 7 5 5 1": "disc7",
    "7x7 round: 3 5 7 7 7 5 3": DISC37,
}
PADS = {"even": {"sigma": 0.0, "voids": 0.0}, "uneven": {"sigma": 0.5, "voids": 0.1}}


def measure(pipeline: str, element: Any, frames: list[Frame]) -> tuple[float, float, int]:
    """Mean error of centre and radius, and the number of readings without an answer."""
    changed = load(pipeline).with_settings({"eroded.element": element, "dilated.element": element})
    runner, rows, lost = changed.runner(), [], 0
    for frame in frames:
        circle = runner(frame).get("circle")
        if circle is None:
            lost += 1
            continue
        assert frame.truth is not None
        true: Any = frame.truth[0].shape
        off = math.hypot(circle.x_cm - true.x_cm, circle.y_cm - true.y_cm)
        rows.append((off, abs(circle.radius_cm - true.radius_cm)))
    centre, radius = np.mean(rows, axis=0)
    return float(centre), float(radius), lost


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--frames", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    warm_up()
    print(f"{arguments.frames} readings a cell: mean centre / mean radius error, cm (lost)\n")
    print(
        f"{'':30}"
        + "".join(f"{f'{p}, {u} pad':>26}" for u in PADS for p in ("circle-2", "circle-3"))
    )
    frames = {
        name: list(
            load("circle-3")
            .with_source("simulate", scene="discs", frames=arguments.frames, **settings)
            .frames(arguments.seed)
        )
        for name, settings in PADS.items()
    }
    for label, element in CANDIDATES.items():
        cells = []
        for name in PADS:
            for pipeline in ("circle-2", "circle-3"):
                centre, radius, lost = measure(pipeline, element, frames[name])
                cells.append(f"{centre:.3f} / {radius:.3f} ({lost})")
        print(f"{label:30}" + "".join(f"{c:>26}" for c in cells))


if __name__ == "__main__":
    main()
