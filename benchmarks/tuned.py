"""Guards found by ``tactile-graph tune`` against those set by hand, on frames and pads unseen.

Run with ``python benchmarks/tuned.py`` (half an hour); ``--cases circles`` takes some only,
``--frames N`` scales all, ``--markdown FILE`` writes the tables, ``--into FOLDER`` the tuned
pipelines and the plots.

Each case is a ladder of ``benchmarks/ladders``: every way to one answer, guarded as the pipeline
that people have today. It is tuned on frames of the project's simulator and of half the kinds of
pad of `second_simulator`, which shares no code with it, and told on two sets that chose nothing:
*unseen frames*, of the same pads with another seed, and *unseen pads*, of the other kinds. The case
``stream`` is 80 % empty frames, 15 % clean and 5 % hard ones; ``mixture`` and ``adaptive`` are 40 %
empty, 30 % clean, 5 % hard, and 25 % of ``circles`` and small discs; ``locate`` is a third of
``stream`` and two thirds of discs, small ones too, and rectangles. Of ``adaptive`` and ``locate``
only the numbers in their guards are chosen. Of these kinds of frame as many are drawn, and each
counts for as many as it stands for: what is rare costs most, and a few frames do not tell how much.
Sought is the least time at which each kind of error is no greater than today's: how far off where
something lies, missed there, answered where nothing lies.

Beside it stands what people had before any guard was tuned: guards set by eye, of `adaptive` as it
was then (``ladders/circle-by-eye.yaml``) and of ``rectangle-likelihood``, run by today's steps.

An error counts as equal if its mean is at most a twentieth greater, and half of that is allowed in
choosing: two ways to an answer never err alike to the bit.

What would refute the finding, said before it was measured: tuned takes more than half of today's
time, or saves less than 80 % of what an oracle saves (one that knows every frame's errors), on
either set of frames; or the error where something lies is not equal; or more is missed, or answered
where nothing lies, by more than the interval.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from second_simulator import KINDS, Bench, Kind
from suite_parts.stream import stream

from tactile_graph import Circle, Frame, Pipeline, load
from tactile_graph.compiled import warm_up
from tactile_graph.wires import TrueObject
from tactile_graph_tune import Request, Tuned
from tactile_graph_tune.finish import finished, predicted, ratio_of, weight_of
from tactile_graph_tune.output.figure import write_figure
from tactile_graph_tune.rerun import rerun
from tactile_graph_tune.searching import Tuning, searched
from tactile_graph_tune.shares import EMPTY, Share
from tactile_graph_tune.split import Interval
from tactile_graph_tune.tuned import CHOSEN, Weight

LADDERS = Path(__file__).parent / "ladders"
NAMES = tuple(KINDS)
SEEN, UNSEEN = NAMES[::2], NAMES[1::2]
BENCH_FRAMES = 6
KNOWN = {
    "disc": [("Disc I", 1860.0, 6.9), ("Disc II", 1280.0, 3.8), ("Disc III", 6360.0, 5.1),
             ("Disc IV", 6810.0, 7.7)],
}  # fmt: skip
MARGIN, EQUAL = 0.025, 0.05
"""Shares by which an error may be greater than today's: in choosing, and to be called equal."""
SMALL_CM, SMALL_G = (0.5, 0.7, 0.9, 1.1, 1.4, 1.8, 2.3, 3.0), (100.0, 300.0, 1000.0)
"""Radii and weights of discs smaller than those of the thesis, from less than an element on."""
DRAW = 1000
"""What seeds of two draws are apart."""
EMPTY_G = 1e-6
"""Weight that no element shows, of an object that is not there."""

Frames = list[Frame]


@dataclass(frozen=True)
class Case:
    """A ladder, who is set by hand, and where frames come from.

    Parameters
    ----------
    ladder, by_hand : str
        Without a ladder the pipeline by hand is tuned itself.
    own : callable
        Frames of the project's simulator: how many, and of which seed.
    other : callable
        Frames of a kind of pad of the second simulator: which, how many, and of which seed.
    fields : tuple of str
        What guards may ask: what tells neither a pad's units and noise nor which thing lies there.
    shares : tuple of Share
        How many of the frames to come are of which kind.
    kept : tuple of str
        Guards that stay: against what no frame here shows, and what spares clean frames most.
    quantity : str, optional
        Whose error counts; the first there is if not given.
    levels : bool
        Whether only the numbers of its guards are chosen.
    by_eye : str
        The ladder, or the pipeline, whose guards were set by eye, where these are others.
    """

    ladder: str
    by_hand: str
    own: Callable[[int, int], Frames]
    other: Callable[[str, int, int], Frames]
    fields: tuple[str, ...]
    by_eye: str = ""
    shares: tuple[Share, ...] = ()
    kept: tuple[str, ...] = ()
    quantity: str | None = None
    levels: bool = False

    @property
    def path(self) -> str | Path:
        """What is tuned: a file, or the name of a pipeline."""
        return LADDERS / f"{self.ladder}.yaml" if self.ladder else self.by_hand

    @property
    def eye_path(self) -> str | Path:
        """What had its guards set by eye: a file, or the name of a pipeline."""
        path = LADDERS / f"{self.by_eye}.yaml"
        return path if path.exists() else self.by_eye or self.by_hand


def simulated(scene: str) -> Callable[[int, int], Frames]:
    def frames(n: int, seed: int) -> Frames:
        source = load("contacts").with_source("simulate", scene=scene, frames=n)
        return list(source.frames(seed))

    return frames


def benched(shape: str) -> Callable[[str, int, int], Frames]:
    def frames(kind: str, n: int, seed: int) -> Frames:
        rng = np.random.default_rng([seed, *kind.encode()])
        return [f for _ in range(math.ceil(n / BENCH_FRAMES))
                for f in Bench(KINDS[kind], rng).frames(BENCH_FRAMES, shape)][:n]  # fmt: skip

    return frames


def named(kind: str, n: int, seed: int) -> Frames:
    """Discs that the shipped objects hold, on a bench."""
    rng = np.random.default_rng([seed, *kind.encode()])
    bench = Bench(replace(KINDS[kind], over_edge=False), rng)
    made = []
    for i in range(n):
        name, weight_g, radius_cm = KNOWN["disc"][i % len(KNOWN["disc"])]
        made.append(bench.frame([TrueObject(_put(bench, radius_cm), weight_g, name)], i))
    return made


PARTS = ("empty", "clean", "hard")
THIRDS = {"empty": 1.0 / 3.0, "clean": 1.0 / 3.0}


def stream_shares(of_all: float = 1.0) -> tuple[Share, ...]:
    """How many frames are of the stream's empty and clean ones, where it is a part of them.

    Frames of no label of it, or its hard ones where it is all, have the rest.
    """
    hard = () if of_all == 1.0 else (Share("hard *", 0.05 * of_all),)
    return (Share(EMPTY, 0.8 * of_all), Share("clean *", 0.15 * of_all), *hard)


def stream_parts(kind: str, n: int, seed: int) -> Frames:
    """A third each of empty frames, of clean ones, and of the kind itself, in random order."""
    rng = np.random.default_rng([seed, 3, *kind.encode()])
    hard = KINDS[kind]
    clean = Kind(noise_v=hard.noise_v, sigma=0.0, voids=0.0)
    made: Frames = []
    for i, k in enumerate(rng.permutation(n).tolist()):
        part = PARTS[k % len(PARTS)]
        bench = Bench(hard if part != "clean" else clean, rng)
        weight_g, radius_cm = bench.kind.discs[i % len(bench.kind.discs)]
        thing = TrueObject(_put(bench, radius_cm), EMPTY_G if part == "empty" else weight_g)
        frame = bench.frame([thing], i)
        frame = replace(frame, label=part)
        made.append(replace(frame, truth=()) if part == "empty" else frame)
    return made


def _put(bench: Bench, radius_cm: float) -> Circle:
    kind = bench.kind
    width, height = (n * kind.pitch_cm - kind.gap_cm for n in (kind.columns, kind.rows))
    x = float(bench.rng.uniform(radius_cm, width - radius_cm))
    return Circle(x, float(bench.rng.uniform(radius_cm, height - radius_cm)), radius_cm)


def streamed(n: int, seed: int) -> Frames:
    made = stream(n, seed, THIRDS)
    pairs = zip(made.frames, made.classes, strict=True)
    return [replace(f, label=name.split(":")[0]) for f, name in pairs]


COUNTED = ("footprint.mask.count", "footprint.mask.fraction", "footprint.rise",
           "footprint.together")  # fmt: skip
CIRCLES = ("cells.share", *COUNTED[:2], "even.uneven", "even.n_cells", "even.centre_std_cm",
           "even.radius_std_cm", "likely.centre_std_cm", "likely.surprise", "likely.fits",
           "quick.centre_std_cm", "quick.surprise", "quick.fits", "quick.posterior.alike",
           "quick.posterior.lean", "quick.posterior.fall", "quick.posterior.neighbours",
           "located.centre_std_cm", "located.surprise", "located.fits")  # fmt: skip
ADAPTIVE = tuple(f for f in CIRCLES if not f.startswith("likely."))
NUMBERS = ("footprint.together", "footprint.rise", "even.uneven", "even.n_cells")
RECTANGLES = (*COUNTED[:2], "quick.centre_std_cm", "quick.angle_std_deg", "quick.surprise",
              "quick.fits", "quick.posterior.alike", "quick.posterior.neighbours",
              "likely.centre_std_cm", "likely.angle_std_deg", "likely.surprise", "likely.fits",
              "located.centre_std_cm", "located.angle_std_deg", "located.surprise",
              "located.fits", "loaded.misfit", "loaded.ambiguous", "loaded.n_points")  # fmt: skip
NAMES_OF = ("footprint.count", "footprint.fraction", "near.known", "near.distance",
            "near.margin", "likely.known", "likely.probability")  # fmt: skip


def small_discs(n: int, seed: int) -> Frames:
    """Return frames of small discs, one in each."""
    things = [
        [{"shape": "disc", "weight_g": weight_g, "radius_cm": radius_cm}]
        for radius_cm in SMALL_CM
        for weight_g in SMALL_G
    ]
    source = load("contacts").with_source("simulate", scene={"in_turn": things}, frames=n)
    return list(source.frames(seed))


def small_on(kind: str, n: int, seed: int) -> Frames:
    """Return frames of small discs on a kind of pad, one in each."""
    rng = np.random.default_rng([seed, 17, *kind.encode()])
    bench = Bench(replace(KINDS[kind], over_edge=False), rng)
    sizes = [(r, g) for r in SMALL_CM for g in SMALL_G]
    at = rng.integers(len(sizes), size=n).tolist()
    return [bench.frame([TrueObject(_put(bench, sizes[k][0]), sizes[k][1])], i)
            for i, k in enumerate(at)]  # fmt: skip


def half_stream(n: int, seed: int) -> Frames:
    """Half discs one after the other, an eighth of all small ones, half the stream: what a pipeline
    for all has to bear."""
    discs = simulated("discs")(n // 2 - n // 8, seed) + small_discs(n // 8, seed)
    return mixed(discs + streamed(n - len(discs), seed), seed)


def mixed(frames: Frames, seed: int) -> Frames:
    """Return the frames in random order: stretches of neighbours then hold some of each kind."""
    return [frames[k] for k in np.random.default_rng([seed, 13]).permutation(len(frames))]


BEARABLE = (Share(EMPTY, 0.4), Share("clean *", 0.3), Share("hard *", 0.05))
"""Of the frames where something lies half are clean: no pad is worse served than another."""


def half_empty(kind: str, n: int, seed: int) -> Frames:
    few = n // 6
    return (benched("disc")(kind, n // 2 - few, seed) + small_on(kind, few, seed)
            + stream_parts(kind, n - n // 2, seed))  # fmt: skip


def either_shape(n: int, seed: int) -> Frames:
    """Discs and rectangles, a quarter each, an eighth of small discs, and the stream."""
    quarter, few = n // 4, n // 8
    made = (simulated("discs")(quarter, seed) + simulated("rectangles")(quarter, seed)
            + small_discs(few, seed) + streamed(n - 2 * quarter - few, seed))  # fmt: skip
    return mixed(made, seed)


def either_or_none(kind: str, n: int, seed: int) -> Frames:
    third, few = n // 3, n // 6
    return (benched("disc")(kind, third - few, seed) + benched("rectangle")(kind, third, seed)
            + small_on(kind, few, seed) + stream_parts(kind, n - 2 * third, seed))  # fmt: skip


CASES = {
    "circles": Case("circle-ladder", "adaptive", simulated("discs"), benched("disc"), CIRCLES,
                    "circle-by-eye"),
    "rectangles": Case(
        "rectangle-ladder", "locate-rectangle", simulated("rectangles"), benched("rectangle"),
        RECTANGLES, "rectangle-likelihood",
    ),
    "identification": Case(
        "identify-ladder", "identify-likelihood", simulated("identify"), named, NAMES_OF
    ),
    "mixture": Case("adaptive-ladder", "adaptive", half_stream, half_empty, ADAPTIVE,
                    "circle-by-eye", BEARABLE, ("legible", "certain")),
    "adaptive": Case("", "adaptive", half_stream, half_empty, NUMBERS, "circle-by-eye", BEARABLE,
                     ("legible",), quantity="radius", levels=True),
    "locate": Case("", "locate", either_shape, either_or_none, COUNTED,
                   shares=stream_shares(1.0 / 3.0), levels=True),
    "stream": Case("circle-ladder", "adaptive", streamed, stream_parts, CIRCLES,
                   "circle-by-eye", stream_shares()),
}  # fmt: skip


# -- one case ----------------------------------------------------------------------------------


def frames_of(case: Case, kinds: Sequence[str], n: int, seed: int, own: bool) -> Frames:
    """Return frames of the project's simulator, if asked for, and of the kinds of pad."""
    made = [(f, "own") for f in case.own(n, seed)] if own else []
    each = max(2, n // len(kinds))
    made += [(f, kind) for kind in kinds for f in case.other(kind, each, seed)]
    labels = [f"{f.label} {label}".strip() for f, label in made]
    return [replace(f, index=i, label=labels[i]) for i, (f, _) in enumerate(made)]


class Told(NamedTuple):
    """What came of a case on one set of frames."""

    case: str
    frames: str
    n: int
    hand: Weight
    tuned: Weight
    ratio: Interval
    difference: Weight
    everything_us: float
    oracle_us: float
    share: float
    """Of what the oracle saves against running everything."""
    share_today: float
    """Of what it saves against the ladder guarded by hand."""
    eye: Weight
    eye_ratio: Interval
    eye_difference: Weight


def tuning_of(
    name: str, n: int, seed: int, margin: float = MARGIN, n_draws: int = 1
) -> tuple[Tuning, dict[str, Frames]]:
    """Return what the search found for a case, and the frames to report on, in so many draws."""
    case = CASES[name]
    choosing = frames_of(case, SEEN, n, seed, own=True)
    told = {}
    for k in range(n_draws):
        draw, its = f", draw {k + 1}" * (n_draws > 1), seed + DRAW * k
        told[f"unseen frames{draw}"] = frames_of(case, SEEN, n, its + 1, own=True)
        told[f"unseen pads{draw}"] = frames_of(case, UNSEEN, n, its + 2, own=False)
    apart = [f for frames in told.values() for f in frames]
    ladder = load(case.path)
    request = Request(
        ladder, quantity=case.quantity, margin=margin, fields=case.fields, kept=case.kept,
        seed=seed, shares=case.shares, levels=case.levels,
    )  # fmt: skip
    return searched(request, choosing, apart, lambda what, n, of: None), told


def run(
    name: str, n: int, seed: int, margin: float = MARGIN, n_draws: int = 1
) -> tuple[dict[str, Told], Tuned]:
    """Tune a case and return what it came to on frames and on pads it has not seen."""
    tuning, told = tuning_of(name, n, seed, margin, n_draws)
    ends = np.cumsum([len(frames) for frames in told.values()])
    rows = np.split(tuning.split.reporting, ends[:-1])
    tuned = finished(tuning, lambda what, n, of: None)
    found = {}
    for (label, frames), part in zip(told.items(), rows, strict=True):
        its = replace(tuning, split=tuning.split._replace(reporting=part))
        found[label] = _told(name, label, frames, its, tuned.pipeline)
    return found, tuned


def _told(name: str, label: str, frames: Frames, tuning: Tuning, chosen: Pipeline) -> Told:
    case = CASES[name]
    every = {"hand": load(case.by_hand), "eye": load(case.eye_path), CHOSEN: chosen}
    ran = rerun(every, frames, tuning.judged, rounds=3, seed=0)
    own, today = (predicted(tuning, c) for c in (tuning.chosen, tuning.variants[0].given))
    own_us, today_us = own.time_us.mean, today.time_us.mean
    oracle_us = tuning.bound().time_at(own.error.mean, own.missed.mean)
    everything_us = tuning.everything_us()

    def share(over_us: float) -> float:
        return (over_us - own_us) / (over_us - oracle_us) if over_us > oracle_us else math.nan

    return Told(
        name, label, len(frames), weight_of(tuning, ran["hand"]), weight_of(tuning, ran[CHOSEN]),
        ratio_of(tuning, ran[CHOSEN][0], ran["hand"][0]),
        weight_of(tuning, ran[CHOSEN], ran["hand"]), everything_us, oracle_us,
        share(everything_us), share(today_us),
        weight_of(tuning, ran["eye"]), ratio_of(tuning, ran[CHOSEN][0], ran["eye"][0]),
        weight_of(tuning, ran[CHOSEN], ran["eye"]),
    )  # fmt: skip


# -- the page ----------------------------------------------------------------------------------

COLUMNS = ("case", "frames", "by hand, µs", "tuned, µs", "ratio", "error where something lies",
           "more", "missed", "false on empty", "everything, µs", "oracle, µs", "of its saving",
           "over today's")  # fmt: skip


EYE_COLUMNS = ("case", "frames", "by eye, µs", "tuned, µs", "ratio", "error where something lies",
               "more", "missed", "false on empty")  # fmt: skip


def eye_row(told: Told) -> list[str]:
    ratio, eye, tuned = told.eye_ratio, told.eye, told.tuned
    return [
        told.case, f"{told.n} {told.frames}",
        f"{eye.time_us.mean:.0f}", f"{tuned.time_us.mean:.0f}",
        f"{ratio.mean:.2f} ({ratio.low:.2f} to {ratio.high:.2f})",
        f"{eye.error.mean:.3f} → {tuned.error.mean:.3f}", _more(told.eye_difference.error),
        *(_shares(*kinds, more) for *kinds, more in zip(eye[2:], tuned[2:],
                                                        told.eye_difference[2:], strict=True)),
    ]  # fmt: skip


def row(told: Told) -> list[str]:
    ratio, hand, tuned = told.ratio, told.hand, told.tuned
    shares = (told.share, told.share_today)
    return [
        told.case, f"{told.n} {told.frames}",
        f"{hand.time_us.mean:.0f}", f"{tuned.time_us.mean:.0f}",
        f"{ratio.mean:.2f} ({ratio.low:.2f} to {ratio.high:.2f})",
        f"{hand.error.mean:.3f} → {tuned.error.mean:.3f}", _more(told.difference.error),
        *(_shares(*kinds, more) for *kinds, more in zip(hand[2:], tuned[2:], told.difference[2:],
                                                        strict=True)),
        f"{told.everything_us:.0f}", f"{told.oracle_us:.0f}",
        *(f"{100 * x:.0f} %" if x == x else "none to reach" for x in shares),
    ]  # fmt: skip


def _more(off: Interval) -> str:
    return f"{off.mean:+.3f} ({off.low:+.3f} to {off.high:+.3f})"


def _shares(hand: Interval, tuned: Interval, more: Interval) -> str:
    """Return two shares, and how much more the second may be; nothing where no frame tells."""
    if math.isnan(hand.mean):
        return ""
    low, high = 100 * more.low, 100 * more.high
    return f"{100 * hand.mean:.1f} → {100 * tuned.mean:.1f} % ({low:+.1f} to {high:+.1f})"


def verdicts(told: Told) -> str:
    """Return what of the goals holds."""
    more = told.difference.error.mean / told.hand.error.mean
    kinds = zip(("misses", "false answers"), told.difference[2:], strict=True)
    held = [f"equal error ({100 * more:+.1f} %) {_held(not more > EQUAL)}"]
    held += [f"no more {name} {_held(not off.low > 0.0)}" for name, off in kinds]
    return (
        f"- {told.case}, {told.frames}: at most half the time {_held(told.ratio.mean <= 0.5)}; at "
        f"least 80 % of the oracle's saving {_held(told.share >= 0.8)}, over today's "
        f"{_held(not told.share_today < 0.8)}; {'; '.join(held)}"
    )


def _held(holds: bool) -> str:
    return "holds" if holds else "fails"


def markdown(found: Sequence[Told]) -> Iterator[str]:
    yield "| " + " | ".join(COLUMNS) + " |"
    yield "|" + "---|" * len(COLUMNS)
    for told in found:
        yield "| " + " | ".join(row(told)) + " |"
    yield ""
    yield from map(verdicts, found)
    yield ""
    yield "| " + " | ".join(EYE_COLUMNS) + " |"
    yield "|" + "---|" * len(EYE_COLUMNS)
    for told in found:
        yield "| " + " | ".join(eye_row(told)) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--frames", type=int, default=320)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--into", type=Path)
    asked = parser.parse_args()
    warm_up()
    found: list[Told] = []
    for name in asked.cases:
        told, tuned = run(name, asked.frames, asked.seed)
        found += told.values()
        print("\n".join(markdown(list(told.values()))), flush=True)
        if asked.into is not None:
            asked.into.mkdir(parents=True, exist_ok=True)
            (asked.into / f"{name}.yaml").write_text(tuned.text, encoding="utf-8")
            write_figure(tuned, str(asked.into / f"{name}.png"))
    if asked.markdown is not None:
        asked.markdown.write_text("\n".join(markdown(found)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
