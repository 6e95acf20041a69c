"""Several objects on pads that nobody described: counts, places, sizes, regions and times.

Run with ``python benchmarks/unknown_objects.py``; ``--scenes N`` takes so many of each sort,
``--kinds`` other kinds of pads, ``--only`` some of the pipelines, ``--markdown FILE`` writes the
tables. Pads are those of `second_simulator`, which shares no code with the project's own; all
pipelines are told the thesis' pad.

One, two, three or six discs and rectangles of 10 to 21 cm2 (one to three of them up to 1.5 times
as wide) lie a pitch or more apart, or each touches one that already lies there. "Counts" is how
often the number is right, more and fewer how often it is not; the centre's error is the mean over
the true objects that have a found one within 2 cm, the size's that of the radius of a disc of the
same area. "Held" is how often the centre lies in the 90 % region of the centre, "off" its error
over the stated deviation, root mean square, both where there is one; "flagged" how often ``fits``
is False; errors are small below 0.25 cm. Times are of the processor, a whole frame.

``--why`` looks at the wrong numbers of ``locate-objects`` instead: the true outlines are brought to
their mode beside each other, under the noise that the answer left. "Missed" is how often they have
more evidence than the answer, so that the search should have come upon them; "unlikely" how often
they have less, so that no search would help.

Settings were tuned with seeds 1 and 3; what is reported is of another.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from objects_likelihood import NORMAL_90, parts
from second_simulator import KINDS, Bench, Outline

from tactile_graph import Circle, Frame, Pipeline, Rectangle, load
from tactile_graph.compiled import warm_up
from tactile_graph.wires import TrueObject
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.several.locate_objects import LocateObjects
from tactile_graph_likelihood.several.pad import split
from tactile_graph_pads.pad import load_pad
from tactile_graph_tracking.score_objects import score_objects

OUTPUTS = {"objects": "shapes", "objects-likelihood": "objects", "locate-objects": "objects"}
"""Pipelines and the output that holds what they found."""
COUNTS = (1, 2, 3, 6)
APART_CM, TOUCHING_CM = 1.3, 0.05
ROOM_CM = 20.5
SMALL_CM = 0.25
MANY_ROUNDS = 25
DIRECTIONS = np.linspace(0.0, 2.0 * math.pi, 180, endpoint=False)
WAYS = np.stack([np.cos(DIRECTIONS), np.sin(DIRECTIONS)])
PADS = (
    "noise 0.2 mV", "noise 1.6 mV", "noise 3 mV", "law 1/F", "turn-on 2 g", "gains 0.2",
    "gains 0.9", "gains correlated", "voids 0.4", "dead row", "leaning face", "round face",
    "foam 0.6 cells", "drift 5 mV", "8 bits",
)  # fmt: skip


def thing(rng: np.random.Generator, wider: float) -> Outline:
    """Return a disc or rectangle somewhere on the pad, up to so many times as wide."""
    x, y = rng.uniform(0.0, ROOM_CM, 2)
    scale = rng.uniform(1.0, wider) if wider > 1.0 else 1.0
    if rng.random() < 0.5:
        return Circle(x, y, scale * rng.uniform(1.9, 2.7))
    length, breadth = scale * rng.uniform(4.2, 6.0), scale * rng.uniform(2.8, 3.6)
    return Rectangle(x, y, length, breadth, rng.uniform(-0.5, 0.5) * math.pi)


def apart_cm(one: Outline, other: Outline) -> float:
    """Return the distance of two convex outlines, below 0 where they overlap."""
    a, b = one.outline_cm() @ WAYS, other.outline_cm() @ WAYS
    return float((b.min(axis=0) - a.max(axis=0)).max())


def moved(one: Outline, x_cm: float, y_cm: float) -> Outline:
    """Return an outline at another place."""
    if isinstance(one, Circle):
        return Circle(x_cm, y_cm, one.radius_cm)
    return Rectangle(x_cm, y_cm, one.length_cm, one.breadth_cm, one.angle_rad)


def beside(lying: Outline, one: Outline, rng: np.random.Generator) -> Outline:
    """Return an outline pushed against one that lies there, from anywhere."""
    way = rng.uniform(0.0, 2.0 * math.pi)
    near, far = 0.0, 2.0 * ROOM_CM
    for _ in range(30):
        middle = 0.5 * (near + far)
        one = moved(one, lying.x_cm + middle * math.cos(way), lying.y_cm + middle * math.sin(way))
        near, far = (near, middle) if apart_cm(lying, one) > TOUCHING_CM else (middle, far)
    return one


def scene(n: int, touching: bool, rng: np.random.Generator) -> list[TrueObject]:
    """Return so many objects, on the pad whole, apart or touching."""
    lying: list[Outline] = []
    tries = 0
    while len(lying) < n:
        tries += 1
        if tries > 60 * n:
            lying, tries = [], 0
        one = thing(rng, 1.5 if n <= 3 else 1.0)
        if touching and lying:
            one = beside(lying[rng.integers(len(lying))], one, rng)
        rim = one.outline_cm()
        least = 0.0 if touching else APART_CM
        if (rim < 0.0).any() or (rim > ROOM_CM).any():
            continue
        if all(apart_cm(other, one) >= least for other in lying):
            lying.append(one)
    return [TrueObject(one, one.area_cm2 * rng.uniform(40.0, 80.0)) for one in lying]


def frames_of(pad: str, n: int, touching: bool, asked: Asked) -> list[Frame]:
    """Return frames of so many objects, each on a pad of its own."""
    rng = np.random.default_rng([asked.seed, n, touching, *pad.encode()])
    return [
        Bench(KINDS[pad], rng).frame(scene(n, touching, rng), index)
        for index in range(asked.n_scenes)
    ]


@dataclass(frozen=True)
class Asked:
    """How many scenes of each sort, and the seed."""

    n_scenes: int
    seed: int


def same_area_cm(shape: Any) -> float:
    """Return the radius of the disc of a shape's area."""
    return math.sqrt(shape.area_cm2 / math.pi)


@dataclass
class Score:
    """What one pipeline came to."""

    count_off: list[int] = field(default_factory=list)
    centre_cm: list[float] = field(default_factory=list)
    size_cm: list[float] = field(default_factory=list)
    held: list[bool] = field(default_factory=list)
    over_std: list[float] = field(default_factory=list)
    flagged: list[bool] = field(default_factory=list)
    frame_cm: list[float] = field(default_factory=list)
    times_ms: list[float] = field(default_factory=list)

    def add(self, frame: Frame, answer: Any) -> None:
        """Enter one frame's answer."""
        found = parts(answer)
        score = score_objects(frame, found)
        self.count_off.append(score.n_found - score.n_true)
        self.flagged.append(not getattr(answer, "fits", True))
        self.frame_cm.append(float(np.mean([far for *_, far in score.pairs] or [math.nan])))
        for i, j, far in score.pairs:
            true, its = (frame.truth or ())[i].shape, found[j]
            its = getattr(its, "shape", its)
            self.centre_cm.append(far)
            self.size_cm.append(abs(same_area_cm(its) - same_area_cm(true)))
            if (posterior := getattr(its, "posterior", None)) is None:
                continue
            off = np.array([true.x_cm, true.y_cm]) - posterior.mean[:2]
            squared = float(off @ np.linalg.solve(posterior.covariance[:2, :2], off))
            self.held.append(squared < NORMAL_90)
            self.over_std.append(far / posterior.centre_std_cm)

    def cells(self) -> list[str]:
        """Return the numbers as texts."""
        off = np.sign(self.count_off)
        share: Callable[[Any], str] = lambda some: f"{100 * np.mean(some):.0f} %"  # noqa: E731
        doubt = ["", ""]
        if self.held:
            doubt = [share(self.held), f"{math.sqrt(np.mean(np.square(self.over_std))):.2f}"]
        centre, size = (np.mean(some or [math.nan]) for some in (self.centre_cm, self.size_cm))
        return [
            share(off == 0), share(off > 0), share(off < 0), f"{centre:.3f}", f"{size:.3f}",
            *doubt, share(self.flagged), f"{np.median(self.times_ms):.1f}",
            f"{np.quantile(self.times_ms, 0.99):.1f}",
        ]  # fmt: skip

    def of_flags(self) -> str:
        """Return how far off flagged frames are, and how many are flagged without need."""
        flagged, far = np.array(self.flagged), np.array(self.frame_cm)
        small = (far < SMALL_CM) & (np.array(self.count_off) == 0)
        ratio = np.nanmean(far[flagged]) / np.nanmean(far[~flagged])
        return (
            f"{100 * flagged.mean():.0f} % flagged, {ratio:.1f} times as far off as others; "
            f"{100 * flagged[small].mean():.0f} % of those with the right number and small errors"
        )

    def take(self, other: Score) -> None:
        """Enter all of another score."""
        for name, some in vars(other).items():
            getattr(self, name).extend(some)


def score_of(pipeline: Pipeline, frames: Sequence[Frame]) -> Score:
    """Return one pipeline's score on some frames."""
    its, results = Score(), pipeline.stream(frames)
    for frame in frames:
        began = time.process_time()
        result = next(results)
        its.times_ms.append(1e3 * (time.process_time() - began))
        its.add(frame, result.get(OUTPUTS[pipeline.name]))
    return its


def evidence_of_truth(frame: Frame, step: LocateObjects) -> tuple[int, float]:
    """Return how many objects a step finds, and the true ones' evidence over its answer's."""
    pad = load_pad("thesis")
    readings = observed(frame.image, pad, pad.geometry.gap_cm)
    problem, found = step.searched(readings)
    scenes = [part.scene for part in found.parts]
    true = step.expected.outlines([it.shape for it in frame.truth or ()], problem)
    more = math.lgamma(true.count + 1.0) - math.lgamma(found.outlines.count + 1.0)
    for scene, its, part in zip(scenes, split(true, scenes), found.parts, strict=True):
        answer = scene.settled(part.outlines)[0]
        more -= scene.of_number(answer)
        if its is not None:
            more += scene.of_number(scene.settled(its, most=MANY_ROUNDS)[0])
    return found.outlines.count, more


def why(asked: Asked, kinds: Sequence[str], sorts: Sequence[tuple[int, bool]]) -> str:
    """Return a table of what wrong numbers are due to."""
    step, rows = LocateObjects(), []
    for n, touching in sorts:
        every = [
            evidence_of_truth(frame, step)
            for kind in kinds
            for frame in frames_of(kind, n, touching, asked)
        ]
        wrong = [more for count, more in every if count != n]
        missed = sum(more > 0.0 for more in wrong)
        some = len(every) - len(wrong), missed, len(wrong) - missed
        shares = [f"{100 * number / len(every):.0f} %" for number in some]
        rows.append([f"{n}, {'touching' if touching else 'apart'}", *shares])
    return table(("objects", "right", "missed", "unlikely"), rows)


HEAD = (
    "objects", "pipeline", "counts", "more", "fewer", "centre, cm", "size, cm", "held", "off",
    "flagged", "median, ms", "99 %, ms",
)  # fmt: skip


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    return "\n".join("| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows))


def main() -> None:
    """Print the tables: by the number of objects, then by the pad."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=4, help="of each pad and sort")
    parser.add_argument("--seed", type=int, default=2)
    parser.add_argument("--kinds", nargs="*", choices=KINDS, default=[*PADS], metavar="KIND")
    parser.add_argument("--counts", nargs="*", type=int, default=[*COUNTS])
    parser.add_argument("--only", nargs="*", choices=OUTPUTS, default=[*OUTPUTS])
    parser.add_argument("--why", action="store_true", help="look at wrong numbers alone")
    parser.add_argument("--markdown", type=Path)
    args = parser.parse_args()
    asked = Asked(args.scenes, args.seed)
    pipelines = [load(name) for name in args.only]
    warm_up()
    if args.why:
        print(why(asked, args.kinds, [(n, True) for n in args.counts if n > 1]))
        return
    for pipeline in pipelines:
        score_of(pipeline, frames_of(args.kinds[0], 2, True, asked))
    sorts = [(n, touching) for touching in (False, True) for n in args.counts]
    sorts = [(n, touching) for n, touching in sorts if n > 1 or not touching]
    by_sort = {(s, p.name): Score() for s in sorts for p in pipelines}
    by_pad = {(kind, p.name): Score() for kind in args.kinds for p in pipelines}
    for kind in args.kinds:
        for n, touching in sorts:
            frames = frames_of(kind, n, touching, asked)
            for pipeline in pipelines:
                its = score_of(pipeline, frames)
                by_sort[(n, touching), pipeline.name].take(its)
                by_pad[kind, pipeline.name].take(its)
    first = [
        [f"{n}, {'touching' if touching else 'apart'}", name, *its.cells()]
        for ((n, touching), name), its in by_sort.items()
    ]
    second = [[kind, name, *its.cells()] for (kind, name), its in by_pad.items()]
    text = table(HEAD, first) + "\n\n" + table(("pad", *HEAD[1:]), second) + "\n"
    for name in args.only:
        every = Score()
        for (_, its_name), its in by_sort.items():
            if its_name == name:
                every.take(its)
        if any(every.flagged):
            text += f"\n{name}: {every.of_flags()}\n"
    print(text)
    if args.markdown:
        args.markdown.write_text(text)


if __name__ == "__main__":
    main()
