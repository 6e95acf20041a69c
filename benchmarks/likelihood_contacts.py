"""Real contacts with known outlines: the likelihood beside the plain centroid and the fits.

    python benchmarks/likelihood_contacts.py [--capcontact FOLDER]

The recordings and the alignments are those of `panel.py`: CapContact, a panel of 41 by 72 cells of
4.8 mm and a camera that sees what truly touches; whatever is fitted is fitted on every second
recording and measured on the others, both ways round. Each contact is cut out with a margin of
three cells; a cell nearer to another contact is left out. The panel blurs, and its unevenness is
not known, so the likelihood estimates foam and sigma with the outline. What hovers reads too, but
little: readings below a share of a contact's largest count as nothing, in three variants.

``leaning`` adds the skewness of the readings (see ``lean_contacts``) to what is fitted, for every
localiser alike: what hovers beside a contact draws all of them along. The last tables say how much
of the error all localisers share, and what a stated deviation that does not know of it must add.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from learned_noise import learned_noise
from numpy.typing import NDArray
from panel import CELLS, PITCH_CM, Seen, interval, off_cells, place
from shared_errors import added, told_alike

from tactile_graph import Frame, load, loads
from tactile_graph.compiled import warm_up
from tactile_graph.errors import Degenerate
from tactile_graph.steps import Report
from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import Contact
from tactile_graph_likelihood.by_order.footprint_by_order import FootprintByOrder
from tactile_graph_likelihood.geometry.outlines import unknowns
from tactile_graph_likelihood.settings import FootprintSettings
from tactile_graph_likelihood.single.fit_footprint import FitFootprint
from tactile_graph_likelihood.single.likely import Likely, likely
from tactile_graph_sources.recording import recording
from tactile_graph_tracking.score_objects import score_objects

Reals = NDArray[np.float64]
MARGIN = 3
PLAIN, SHARPENED = "plain intensity centroid", "sharpened"
DISC = "disc, from 35% of peak"
SHOWS_FROM = 15.0
"""Counts; three times the panel's noise of an untouched cell."""

OUTLINES = """
pipeline: outlines
source: {step: sample, with: {name: discs}}
nodes:
  footprint: {step: threshold, in: frame, with: {level: 40}}
  points: {step: boundary_scan, in: footprint}
  hull: {step: hull, in: points}
  circle: {step: fit_circle, in: hull}
  ellipse: {step: fit_ellipse, in: hull}
outputs: [circle, ellipse]
"""


def cut_out(image: Image, found: tuple[Contact, ...], k: int) -> Image:
    """Return a contact's surroundings on square cells; nearer to another one, a cell is invalid."""
    rows, columns = image.shape
    top, bottom, left, right = found[k].box
    top, left = max(top - MARGIN, 0), max(left - MARGIN, 0)
    bottom, right = min(bottom + MARGIN, rows), min(right + MARGIN, columns)
    y, x = np.mgrid[top:bottom, left:right] + 0.5
    middles = [(c.centroid_x_cm / PITCH_CM[0], c.centroid_y_cm / PITCH_CM[1]) for c in found]
    far = np.stack([np.hypot(x - u, y - v) for u, v in middles])
    valid = far.argmin(axis=0) == k
    side = float(PITCH_CM[0])
    values = np.where(valid, image.values[top:bottom, left:right], 0.0)
    return Image(values, (side, side), (left * side, top * side), "raw", valid)


def to_panel(shape: object) -> tuple[float, float]:
    """Return a centre on square cells as it lies on the panel's own."""
    x, y = shape.x_cm, shape.y_cm  # type: ignore[attr-defined]
    return x, y * float(PITCH_CM[1] / PITCH_CM[0])


def fit_from(share: float, shape: str, estimate: list[str]) -> Callable[[Image], Likely]:
    """Return a fit to which readings below a share of the contact's largest are none at all."""
    settings = FootprintSettings(
        estimate=estimate, gap_cm=0.0, sigma=0.2, voids=1e-3, strays=1e-2, smallest_cm=0.15,
        largest_cm=2.0,
    )  # type: ignore[arg-type]  # fmt: skip
    base = FitFootprint(shape=shape, settings=settings).model  # type: ignore[arg-type]

    def fit(image: Image) -> Likely:
        least = max(share * float(image.values.max()), SHOWS_FROM)
        return likely(replace(base, noise=replace(base.noise, least=least)).posterior(image))

    return fit


def by_order(image: Image) -> Likely:
    least = max(0.35 * float(image.values.max()), SHOWS_FROM)
    settings = FootprintSettings(
        gap_cm=0.0, sigma=0.2, voids=1e-3, foam_cm=0.3, smallest_cm=0.15, largest_cm=2.0
    )
    step = FootprintByOrder(shape="ellipse", settings=settings, touched_from=least, sliver=0.35)
    return step(image)


def likelihoods() -> dict[str, Callable[[Image], Likely]]:
    foam = ["sigma", "foam"]
    return {
        "disc, from 15 counts": fit_from(0.0, "disc", foam),
        **{f"disc, from {s:.0%} of peak": fit_from(s, "disc", foam) for s in (0.2, 0.35, 0.5)},
        "ellipse, from 35% of peak": fit_from(0.35, "ellipse", foam),
        "disc, falling, from 35%": fit_from(0.35, "disc", [*foam, "fall"]),
        "disc, leaning, from 35%": fit_from(0.35, "disc", [*foam, "lean"]),
        "ellipse by order, from 35%": by_order,
    }


class Row(NamedTuple):
    """One contact: recording, truth, what the others need, and each localiser's centre."""

    recording: int
    true: tuple[float, float, float]
    skewness: tuple[float, float]
    centres: dict[str, tuple[float, float]]
    image: Image
    said: dict[str, tuple[float, bool, float]]
    """Stated deviation of the centre in cells, whether it fits, and the foam's width in cells."""


def look(paths: list[Path]) -> tuple[list[Row], dict[str, list[float]]]:
    run = (
        load("capacitive")
        .with_settings({"upright.lean": 1.0})
        .runner(only=("upright", "sharp", "contacts"))
    )
    outlines = loads(OUTLINES).runner()
    fits = likelihoods()
    rows: list[Row] = []
    times: dict[str, list[float]] = {name: [] for name in fits}
    for number, path in enumerate(paths):
        for frame in recording(path=path, report=Report()):
            result = run(frame)
            plain, sharp, upright = (result[n].contacts for n in ("contacts", "sharp", "upright"))
            assert frame.truth is not None
            for i, j, _ in score_objects(frame, sharp, gate_cm=1.0).pairs:
                true = frame.truth[i].shape
                centres = {PLAIN: place(plain[j]), SHARPENED: place(sharp[j])}
                image = cut_out(frame.image, plain, j)
                seen = outlines(Frame(image, 0, 0.0))
                for name in ("circle", "ellipse"):
                    shape = seen.get(name)
                    if shape is not None:
                        centres[f"fit_{name} to the hull"] = to_panel(shape)
                posteriors = {}
                for name, fit in fits.items():
                    began = time.perf_counter()
                    try:
                        found = fit(image)
                    except Degenerate:
                        continue
                    times[name].append(1e3 * (time.perf_counter() - began))
                    centres[name] = to_panel(found)
                    posteriors[name] = said(found)
                (x, y), (u, v) = place(sharp[j]), place(upright[j])
                truth = (*place(true), true.area_cm2)  # type: ignore[arg-type]
                rows.append(Row(number, truth, (x - u, y - v), centres, image, posteriors))
    return rows, times


def said(found: Likely) -> tuple[float, bool, float]:
    """Return the centre's stated deviation, whether it fits, and the foam's width."""
    posterior, side = found.posterior, float(PITCH_CM[0])
    first = unknowns.call(posterior.kind, posterior.corners)  # then ln s, ln sigma, ln foam
    foam = float(np.exp(posterior.mean[first + 2])) if len(posterior.mean) > first + 2 else 0.0
    return posterior.centre_std_cm / side, posterior.fits, foam


def seen_by(rows: list[Row], name: str) -> Seen:
    """Return the contacts that a localiser answered, as `panel` takes them."""
    kept = [r for r in rows if name in r.centres]
    names = (PLAIN, name)
    return Seen(
        np.unique([r.recording for r in kept], return_inverse=True)[1],
        np.array([r.true[:2] for r in kept]),
        np.array([r.true[2] for r in kept]),
        {n: np.array([r.centres[n] for r in kept]) for n in names},
        np.array([r.skewness for r in kept]),
        {},
    )


def table(rows: list[Row]) -> None:
    print("\ncentres, error in cells: median, mean, and its median less the plain one's (95 %)")
    names = list(dict.fromkeys(n for r in rows for n in r.centres))
    for alignment in ("as given", "stretch", "affine"):
        for leaning in (False, True):
            print(f"{alignment}{', leaning' if leaning else ''}")
            for name in names:
                seen = seen_by(rows, name)
                plain, _ = off_cells(seen, seen.centres[PLAIN], alignment, leaning)
                off, leans = off_cells(seen, seen.centres[name], alignment, leaning)

                def less(k: NDArray[np.int64], off: Reals = off, plain: Reals = plain) -> float:
                    return float(np.median(off[k]) - np.median(plain[k]))

                text = f"  {name:28s} {np.median(off):6.3f} {off.mean():6.3f}"
                if name != PLAIN:
                    low, high = interval(seen, less)
                    text += f"  {less(np.arange(len(off))):+.3f} ({low:+.3f} to {high:+.3f})"
                if leaning:
                    text += "  lean " + " and ".join(f"{v:.2f}" for v in leans)
                if len(off) < len(rows):
                    text += f"  no answer in {len(rows) - len(off)}"
                print(text)


def learned(rows: list[Row]) -> None:
    """Print what `learned_noise` makes of either half of the recordings."""
    foam = float(np.median([r.said[DISC][2] for r in rows if DISC in r.said]))
    print(f"\nfoam, median of the contacts: {foam:.2f} cells; learned from one half's contacts:")
    settings = FootprintSettings(
        gap_cm=0.0, sigma=0.2, voids=0.01, strays=1e-2, smallest_cm=0.15, largest_cm=2.0,
        foam_cm=foam * float(PITCH_CM[0]), shows_from=0.35,
    )  # fmt: skip
    step = FitFootprint(settings=settings)
    for half in (0, 1):
        images = [
            r.image.with_values(r.image.values / r.image.values.max())
            for r in rows
            if r.recording % 2 == half
        ]
        noise = learned_noise(step.model, images)
        print(f"  sigma {noise.sigma:.3f}, voids {noise.voids:.4f} ({len(images)} contacts)")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    beside = Path(__file__).parents[2] / "shared/data/capcontact"
    parser.add_argument("--capcontact", type=Path, default=beside)
    chosen = parser.parse_args()
    paths = sorted(chosen.capcontact.glob("*.npz"))
    if not paths:
        raise SystemExit(f"no CapContact recordings in {chosen.capcontact}")
    warm_up()
    rows, times = look(paths)
    print(f"{len(paths)} recordings of {CELLS[0]} by {CELLS[1]} cells, {len(rows)} contacts")
    table(rows)
    print("\nstated deviation of the centre, cells; error over it (affine, leaning), root mean")
    print("square; what it lacks, and error over it and share within 90 % once that is added;")
    print("share that fits; ms")
    for name, taken in times.items():
        stds, fits, _ = zip(*(r.said[name] for r in rows if name in r.said), strict=True)
        seen = seen_by(rows, name)
        off, _ = off_cells(seen, seen.centres[name], "affine", True)
        over = np.sqrt(np.mean(np.square(off / np.array(stds))))
        lacks, then, within = added(seen, off, np.array(stds))
        print(
            f"  {name:28s} {np.median(stds):6.3f} {over:6.2f} {lacks:6.3f} {then:5.2f}"
            f" {within:6.1%} {np.mean(fits):7.1%} {statistics.median(taken):6.2f}"
        )
    names = dict.fromkeys(n for r in rows for n in r.centres)
    told_alike({n: seen_by(rows, n) for n in names if all(n in r.centres for r in rows)}, SHARPENED)
    learned(rows)


if __name__ == "__main__":
    main()
