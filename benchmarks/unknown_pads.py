"""Every localiser of discs on pads that nobody described to it, by a simulator of its own.

Run with ``python benchmarks/unknown_pads.py``; ``--scenes N`` takes N discs of a kind, ``--kinds``
some of the kinds only, ``--markdown FILE`` writes the table. All pipelines are told the thesis'
pad; what lies on the bench is one of the kinds of `second_simulator`, which shares no code with
the project's own pads. For each: mean error of the centre and of the radius in cm, the share of
frames that are flagged (``fits`` False) or unanswered, and the share of 90 % regions that hold
the truth where a pipeline states one. Beside them the plain centroid of the volts.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from second_simulator import KINDS, Bench

from tactile_graph import Circle, Frame, Pipeline, load

PIPELINES = ("circle-3", "circle-by-order", "circle-likelihood")
CENTROID = "centroid"


@dataclass
class Score:
    """What one localiser came to on one kind of pad."""

    centre_cm: list[float] = field(default_factory=list)
    radius_cm: list[float] = field(default_factory=list)
    flagged: list[bool] = field(default_factory=list)
    held: list[bool] = field(default_factory=list)
    n_unanswered: int = 0

    def add(self, found: Any, true: Circle) -> None:
        """Enter one frame's answer."""
        if not isinstance(found, Circle):
            self.n_unanswered += 1
            return
        self.centre_cm.append(math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm))
        self.radius_cm.append(abs(found.radius_cm - true.radius_cm))
        self.flagged.append(not getattr(found, "fits", True))
        posterior = getattr(found, "posterior", None)
        if posterior is not None:
            self.held.append(posterior.contains(true))

    def cells(self) -> list[str]:
        """Return the score as texts: errors, flags, regions."""
        n = len(self.centre_cm) + self.n_unanswered
        if not self.centre_cm:
            return ["no answer", f"{self.n_unanswered}/{n}", ""]
        radius = np.mean(self.radius_cm)
        error = f"{np.mean(self.centre_cm):.3f}" + ("" if np.isnan(radius) else f" / {radius:.3f}")
        flagged = f"{sum(self.flagged) + self.n_unanswered}/{n}"
        return [error, flagged, f"{100 * np.mean(self.held):.0f} %" if self.held else ""]


def centroid(frame: Frame) -> Circle:
    """Return the centroid of the volts above a hundredth, with no radius of its own."""
    image = frame.image
    volts = np.where(image.values >= 0.01, image.values, 0.0)
    total = volts.sum()
    if total == 0.0:
        return Circle(math.nan, math.nan, math.nan)
    x = float((volts.sum(axis=0) * image.x_cm).sum() / total)
    y = float((volts.sum(axis=1) * image.y_cm).sum() / total)
    return Circle(x, y, math.nan)


def scores(kind: str, pipelines: Sequence[Pipeline], n_scenes: int, seed: int) -> dict[str, Score]:
    """Return each localiser's score on a kind of pad; a bench stands for a dozen frames."""
    rng = np.random.default_rng([seed, *kind.encode()])
    frames = [f for _ in range(0, n_scenes, 12) for f in Bench(KINDS[kind], rng).frames(12)]
    frames = [f.with_index(i) for i, f in enumerate(frames[:n_scenes])]
    true = [t.shape for f in frames for t in f.truth or ()]
    found = {CENTROID: Score(), **{p.name: Score() for p in pipelines}}
    for frame, disc in zip(frames, true, strict=True):
        assert isinstance(disc, Circle)
        found[CENTROID].add(centroid(frame), disc)
    for pipeline in pipelines:
        for result, disc in zip(pipeline.stream(frames), true, strict=True):
            assert isinstance(disc, Circle)
            found[pipeline.name].add(result.outcome("circle"), disc)
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=36)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", nargs="*", choices=KINDS, default=[*KINDS], metavar="KIND")
    parser.add_argument("--pipelines", nargs="*", default=PIPELINES, metavar="NAME")
    parser.add_argument("--markdown", type=Path)
    asked = parser.parse_args()
    pipelines = [load(name) for name in asked.pipelines]
    names = [CENTROID, *asked.pipelines]
    head = ["pad", *(f"{n}{what}" for n in names for what in (", cm", ", flagged", ", held"))]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    print("\n".join(lines))
    for kind in asked.kinds:
        found = scores(kind, pipelines, asked.scenes, asked.seed)
        row = [kind, *(cell for n in names for cell in found[n].cells())]
        lines.append("| " + " | ".join(row) + " |")
        print(lines[-1], flush=True)
    if asked.markdown:
        asked.markdown.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
