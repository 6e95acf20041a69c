"""Several objects: how often the count is right, how far off the centres are, how long it takes.

    python benchmarks/objects.py [--scenes 500] [--seed 2026] [--capcontact FOLDER]

Six objects of four kinds, sizes and weights drawn anew for each scene, are put down at random on
the thesis' simulated pad, at least so far apart as a line says; 0 cm is as it falls. The settings
of ``split_contacts`` were chosen on other scenes (other seeds). With the recordings of the
CapContact set, contacts of a capacitive panel are compared with what a camera saw; what is fitted
is fitted on one half of the recordings and measured on the other, both ways round.
"""

from __future__ import annotations

import argparse
import math
import statistics
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, Pipeline, load, loads
from tactile_graph.compiled import warm_up
from tactile_graph.errors import UsageError
from tactile_graph.steps import Report
from tactile_graph_sources.recording import recording
from tactile_graph_sources.simulate import simulate
from tactile_graph_tracking.score_objects import score_objects

Reals = NDArray[np.float64]
PITCH_CM = np.array([0.479, 0.476])  # of the capacitive panel, for errors in its cells
KINDS = ("disc", "rectangle", "ellipse", "polygon", "disc", "rectangle")
COUNTERS = {
    "contacts, 8-connected": "{step: contacts, in: [frame, footprint], with: {min_cells: 4}}",
    "split_watershed": (
        "{step: split_watershed, in: [frame, footprint], with: {neck: 0.8, min_cells: 4}}"
    ),
    "split_contacts": "{step: split_contacts, in: [frame, footprint]}",
}
COUNTING = """
pipeline: counting
source: {step: sample, with: {name: discs}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  objects: %s
outputs: [objects]
"""


def thing(kind: str, rng: np.random.Generator) -> dict[str, Any]:
    """Return an object of 10 to 21 cm2 and 40 to 80 g/cm2."""

    def between(low: float, high: float) -> float:
        return round(float(rng.uniform(low, high)), 2)

    made: dict[str, Any] = {"shape": kind}
    if kind == "disc":
        made["radius_cm"] = between(1.9, 2.7)
        area = math.pi * made["radius_cm"] ** 2
    elif kind == "rectangle":
        made |= {"length_cm": between(4.2, 6.0), "breadth_cm": between(2.8, 3.6)}
        area = made["length_cm"] * made["breadth_cm"]
    elif kind == "ellipse":
        made |= {"semi_major_cm": between(2.5, 3.3), "semi_minor_cm": between(1.7, 2.1)}
        area = math.pi * made["semi_major_cm"] * made["semi_minor_cm"]
    else:
        sides = int(rng.integers(3, 7))
        made |= {"sides": sides, "radius_cm": between(2.4, 2.9) + (0.4 if sides == 3 else 0.0)}
        area = sides / 2 * made["radius_cm"] ** 2 * math.sin(2 * math.pi / sides)
    made["weight_g"] = round(area * between(40, 80))
    return made


def scenes(n: int, apart_cm: float, seed: int) -> list[Frame]:
    """Return one frame each of ``n`` scenes of six objects; those that do not fit are redrawn."""
    rng = np.random.default_rng(seed)
    found: list[Frame] = []
    while len(found) < n:
        scene = {"objects": [thing(k, rng) for k in KINDS], "apart_cm": apart_cm}
        try:
            found += simulate(scene=scene, frames=1, rng=rng, report=Report())
        except UsageError as error:
            if "found no place" not in str(error):
                raise
    return [f.with_index(i) for i, f in enumerate(found)]


def spread(errors: list[float], unit: str) -> str:
    e = np.array(errors)
    return (
        f"mean {e.mean():.3f} {unit}, median {np.median(e):.3f}, "
        f"95th percentile {np.percentile(e, 95):.3f} ({e.size} objects)"
    )


def count_scenes(frames: list[Frame], apart_cm: float) -> None:
    for name, step in COUNTERS.items():
        pipeline = loads(COUNTING % step)
        run = pipeline.runner()
        off, times = [], []
        for frame in frames:
            result = run(frame)
            found = result["objects"]
            off.append(int(np.sign(found.count - 6)))
            times.append(result.times_us["objects"])
        print(
            f"apart {apart_cm:4.2f} cm  {name:22s} right {off.count(0) / len(off):6.1%}"
            f"  too many {off.count(1) / len(off):5.1%}  too few {off.count(-1) / len(off):5.1%}"
            f"  {statistics.median(times):6.0f} us"
        )


def locate(frames: list[Frame]) -> None:
    pipeline: Pipeline = load("objects")
    run = pipeline.runner()
    errors: dict[str, list[float]] = {"contacts (load)": [], "shapes": []}
    times = []
    for frame in frames:
        result = run(frame)
        times.append(sum(result.times_us.values()))
        errors["contacts (load)"] += [
            e for _, _, e in score_objects(frame, result["objects"].contacts).pairs
        ]
        errors["shapes"] += [e for _, _, e in score_objects(frame, result["shapes"]).pairs]
    for name, found in errors.items():
        print(f"centres of {name:16s} {spread(found, 'cm')}")
    print(f"objects.yaml: {statistics.median(times) / 1e3:.2f} ms a frame (sum of its nodes)")


def panel(folder: Path) -> None:
    """Compare contacts of the capacitive panel with the camera's."""
    paths = sorted(folder.glob("*.npz"))
    pipeline = load("capacitive")
    run = pipeline.runner(only=("sharp", "contacts"))
    rows: list[tuple[float, ...]] = []
    right, times = 0, []
    for number, path in enumerate(paths):
        for frame in recording(path=path, report=Report()):
            result = run(frame)
            times.append(sum(result.times_us.values()))
            plain, sharp = result["contacts"].contacts, result["sharp"].contacts
            score = score_objects(frame, sharp, gate_cm=1.0)
            right += score.count_right and score.n_missed == 0
            assert frame.truth is not None
            for i, j, _ in score.pairs:
                true = frame.truth[i].shape
                rows.append(
                    (number, true.x_cm, true.y_cm, true.area_cm2, plain[j].x_cm, plain[j].y_cm,
                     plain[j].area_cm2, sharp[j].x_cm, sharp[j].y_cm, sharp[j].area_cm2)
                )  # fmt: skip
    table = np.array(rows)
    half, true = table[:, 0] % 2 == 0, table[:, 1:3]
    print(f"\n{len(paths)} recordings of the panel: contacts right in {right}, each within 1 cm")
    for name, got in (("plain intensity centroid", table[:, 4:6]), ("sharpened", table[:, 7:9])):
        print(f"{name:26s} as it is         {spread(cells(got - true), 'px')}")
        for unknowns, fit in (("one shift (2 numbers)", shift), ("aligned (6 numbers)", affine)):
            off = np.where(half[:, None], fit(got, true, ~half), fit(got, true, half)) - true
            print(f"{name:26s} {unknowns:22s}{spread(cells(off), 'px')}")
    for name, column in (("plain", 6), ("sharpened", 9)):
        ratio = table[:, column] / table[:, 3]
        print(
            f"area, {name:10s} found/true: median {np.median(ratio):.2f}, "
            f"median error {np.median(abs(ratio - 1)):.1%}"
        )
    print(f"{statistics.median(times) / 1e3:.2f} ms a frame")
    for name, chosen in (("first", half), ("second", ~half)):
        map_ = solved(table[chosen, 7:9], true[chosen]).round(4).tolist()
        print(f"alignment fitted on the {name} half (x, y, 1 -> x, y): {map_}")


def cells(off: Reals) -> list[float]:
    found: list[float] = np.hypot(*(off / PITCH_CM).T).tolist()
    return found


def solved(got: Reals, true: Reals) -> Reals:
    design = np.column_stack([got, np.ones(len(got))])
    return np.linalg.lstsq(design, true, rcond=None)[0]


def affine(got: Reals, true: Reals, on: NDArray[np.bool_]) -> Reals:
    found: Reals = np.column_stack([got, np.ones(len(got))]) @ solved(got[on], true[on])
    return found


def shift(got: Reals, true: Reals, on: NDArray[np.bool_]) -> Reals:
    return got + np.median((true - got)[on], axis=0)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", type=int, default=500)
    parser.add_argument("--seed", type=int, default=2026)
    beside = Path(__file__).parents[2] / "shared/data/capcontact"
    parser.add_argument("--capcontact", type=Path, default=beside)
    chosen = parser.parse_args()
    warm_up()
    for apart_cm in (1.3, 1.0, 0.65, 0.0):
        frames = scenes(chosen.scenes, apart_cm, chosen.seed)
        count_scenes(frames, apart_cm)
        if apart_cm == 1.3:
            locate(frames)
    if chosen.capcontact.is_dir():
        panel(chosen.capcontact)
    else:
        print(f"no CapContact recordings in {chosen.capcontact}")


if __name__ == "__main__":
    main()
