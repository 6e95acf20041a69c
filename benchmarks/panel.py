"""A capacitive panel against a camera: contacts counted, their centres and areas.

    python benchmarks/panel.py [--capcontact FOLDER]

The recordings are those of the CapContact set: a panel of 41 by 72 cells, and a camera that sees
what truly touches the glass. Whatever is fitted (the alignment of panel and camera, ``lean``, the
areas) is fitted on every second recording and measured on the others, both ways round. A centre
is compared with a plain intensity centroid under the same alignment; the intervals of 95 % are
of the difference of the medians, from recordings drawn anew with both methods kept together.

The alignments, by what they are allowed to know:

as given    the camera's grid begins at the panel's corner; nothing is fitted
corners     the middles of the two grids' corner cells lie on each other; nothing is fitted
shift       one shift, 2 numbers from the other recordings
stretch     a shift and a stretch along each axis, 4 numbers
affine      6 numbers
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import load
from tactile_graph.compiled import warm_up
from tactile_graph.steps import Report
from tactile_graph_filters.contacts.contacts import Contact
from tactile_graph_sources.recording import recording
from tactile_graph_tracking.score_objects import score_objects

Reals = NDArray[np.float64]
PITCH_CM = np.array([0.479, 0.476])
CELLS = np.array([72, 41])
FINER = 8
DRAWS = 2000


class Seen(NamedTuple):
    """All contacts of all recordings, one a row."""

    recording: NDArray[np.int64]
    true: Reals
    """Centre in cm, (n, 2), as the camera's grid is given."""
    true_area: Reals
    centres: dict[str, Reals]
    skewness: Reals
    """What ``lean_contacts`` subtracts at ``lean`` 1, in cm, (n, 2)."""
    areas: dict[str, Reals]


def place(c: Contact) -> tuple[float, float]:
    return c.x_cm, c.y_cm


def look(paths: list[Path]) -> Seen:
    """Run the pipeline over the recordings; say how many are counted right."""
    pipeline = load("capacitive").with_settings({"upright.lean": 1.0})
    run = pipeline.runner(only=("upright", "sharp", "contacts"))
    rows: list[tuple[float, ...]] = []
    right, times = 0, []
    for number, path in enumerate(paths):
        for frame in recording(path=path, report=Report()):
            result = run(frame)
            times.append(sum(result.times_us.values()))
            found = [result[n].contacts for n in ("contacts", "sharp", "upright")]
            score = score_objects(frame, found[1], gate_cm=1.0)
            right += score.count_right and score.n_missed == 0
            assert frame.truth is not None
            for i, j, _ in score.pairs:
                true = frame.truth[i].shape
                plain, sharp, upright = (f[j] for f in found)
                rows.append(
                    (number, *place(true), true.area_cm2, *place(plain), plain.area_cm2,
                     *place(sharp), sharp.area_cm2, *place(upright))
                )  # fmt: skip
    t = np.array(rows)
    print(f"{len(paths)} recordings, {len(t)} contacts: count right, each within 1 cm, in {right}")
    print(f"{statistics.median(times) / 1e3:.2f} ms a frame")
    centres = {"plain intensity centroid": t[:, 4:6], "sharpened": t[:, 7:9]}
    areas = {"footprint": t[:, 6], "sharpened": t[:, 9]}
    number = t[:, 0].astype(np.int64)
    return Seen(number, t[:, 1:3], t[:, 3], centres, t[:, 7:9] - t[:, 10:12], areas)


def corners(true: Reals) -> Reals:
    """Return the camera's places where its corner cells' middles lie on the panel's."""
    index = true / PITCH_CM * FINER - 0.5
    found: Reals = (index * (CELLS - 1) / (CELLS * FINER - 1) + 0.5) * PITCH_CM
    return found


def unknowns(at: Reals, alignment: str) -> list[Reals]:
    """Return what each unknown of an alignment does to each place, n of shape (2,)."""
    one, none = np.ones(len(at)), np.zeros(len(at))
    x, y = at.T
    of_x = {"shift": [one], "stretch": [one, x], "affine": [one, x, y]}.get(alignment, [])
    of_y = {"shift": [one], "stretch": [one, y], "affine": [one, x, y]}.get(alignment, [])
    return [np.column_stack([v, none]) for v in of_x] + [np.column_stack([none, v]) for v in of_y]


def off_cells(seen: Seen, at: Reals, alignment: str, leaning: bool) -> tuple[Reals, list[float]]:
    """Return each contact's error in cells, and what was fitted for ``lean`` on either half."""
    true = corners(seen.true) if alignment == "corners" else seen.true
    columns = unknowns(at, alignment) + ([-seen.skewness] if leaning else [])
    left, leans = true - at, []
    if columns:
        moves = np.stack(columns, axis=2)
        for half in (0, 1):
            tested = seen.recording % 2 == half
            a, b = moves[~tested], (true - at)[~tested]
            fitted = np.linalg.lstsq(a.reshape(-1, a.shape[2]), b.ravel(), rcond=None)[0]
            left[tested] -= moves[tested] @ fitted
            leans.append(float(fitted[-1]))
    return np.hypot(*(left / PITCH_CM).T), leans if leaning else []


def interval(seen: Seen, measure: Callable[[NDArray[np.int64]], float]) -> tuple[float, float]:
    """Return the interval of 95 % of a measure of rows, by drawing recordings anew."""
    rng = np.random.default_rng(2026)
    of = [np.flatnonzero(seen.recording == k) for k in range(int(seen.recording.max()) + 1)]
    drawn = [
        measure(np.concatenate([of[k] for k in rng.integers(0, len(of), len(of))]))
        for _ in range(DRAWS)
    ]
    low, high = np.percentile(drawn, [2.5, 97.5])
    return float(low), float(high)


def centres(seen: Seen) -> None:
    print("\ncentres, error in cells: median, mean, and the median less the plain one's")
    for alignment in ("as given", "corners", "shift", "stretch", "affine"):
        plain, _ = off_cells(seen, seen.centres["plain intensity centroid"], alignment, False)
        for name, leaning in (
            ("plain intensity centroid", False), ("sharpened", False), ("sharpened", True),
        ):  # fmt: skip
            off, leans = off_cells(seen, seen.centres[name], alignment, leaning)
            text = f"median {np.median(off):.3f}  mean {off.mean():.3f}"
            if name != "plain intensity centroid":

                def less(rows: NDArray[np.int64], off: Reals = off, plain: Reals = plain) -> float:
                    return float(np.median(off[rows]) - np.median(plain[rows]))

                low, high = interval(seen, less)
                everything = np.arange(len(off))
                text += f"  {less(everything):+.3f} ({low:+.3f} to {high:+.3f})"
            if leaning:
                text += "  lean " + " and ".join(f"{v:.2f}" for v in leans)
            print(f"{alignment:9s} {name + (', leaning' if leaning else ''):25s} {text}")


def areas(seen: Seen) -> None:
    print("\nareas, error as a share of the true one, and its median's interval")
    x, y = seen.centres["sharpened"].T
    one = np.ones(len(x))
    ways = {
        "as they are": [],
        "one factor": [one],
        "a factor by place": [one, x, y, x * x, x * y, y * y],
    }
    for name, area in (("no area, all alike", one), *seen.areas.items()):
        for way, columns in ways.items():
            grown = np.zeros(len(x))
            for half in (0, 1) if columns else ():
                tested = seen.recording % 2 == half
                design, wanted = np.column_stack(columns), np.log(seen.true_area / area)
                fitted = np.linalg.lstsq(design[~tested], wanted[~tested], rcond=None)[0]
                grown[tested] = design[tested] @ fitted
            off = np.abs(area * np.exp(grown) / seen.true_area - 1.0)
            low, high = interval(seen, lambda rows, off=off: float(np.median(off[rows])))
            print(
                f"{name:19s} {way:18s} median {np.median(off):6.1%} ({low:.1%} to {high:.1%})"
                f"  mean {off.mean():6.1%}"
            )


def settings(seen: Seen) -> None:
    """Print what ``align_contacts`` of either half takes, after the pipeline's ``lean``."""
    at = seen.centres["sharpened"] - 0.35 * seen.skewness
    x, y = at.T
    one = np.ones(len(at))
    for half, name in ((0, "first, third, ..."), (1, "second, fourth, ...")):
        k = seen.recording % 2 == half
        map_ = np.linalg.lstsq(np.column_stack([at, one])[k], seen.true[k], rcond=None)[0].T
        squares = np.column_stack([one, x, y, x * x, x * y, y * y])
        growth = np.log(seen.true_area / seen.areas["sharpened"])
        log_area = np.linalg.lstsq(squares[k], growth[k], rcond=None)[0]
        print(
            f"\nalign_contacts fitted on the {name} recording: "
            f"matrix {map_[:, :2].round(4).tolist()}, shift_cm {map_[:, 2].round(4).tolist()}, "
            f"log_area {log_area.round(5).tolist()}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    beside = Path(__file__).parents[2] / "shared/data/capcontact"
    parser.add_argument("--capcontact", type=Path, default=beside)
    chosen = parser.parse_args()
    paths = sorted(chosen.capcontact.glob("*.npz"))
    if not paths:
        raise SystemExit(f"no CapContact recordings in {chosen.capcontact}")
    warm_up()
    seen = look(paths)
    centres(seen)
    areas(seen)
    settings(seen)


if __name__ == "__main__":
    main()
