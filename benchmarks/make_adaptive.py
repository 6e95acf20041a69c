"""Make ``adaptive`` and ``locate`` by ``tune``, and ship what comes out only if it is no worse.

Run with ``python benchmarks/make_adaptive.py`` (half an hour); ``--write`` puts what holds in the
place of the shipped file, ``--frames N`` and ``--seed N`` make the run another one.

Steps, rungs and what guards ask are by hand; the numbers in the guards are chosen, as
``tactile-graph tune --levels`` does, on the cases ``adaptive`` and ``locate`` of `tuned`. Of
``adaptive`` ``legible`` stays: it guards against pads of which most readings are missing, and no
frame here is of one. (Where rungs and fields were free as well, what came out was not surely
better: ``docs/evidence/tuned-guards.md``.) Frames are of the project's simulator and of half the
kinds of pad of the second one; told is on `N_FRESH` draws of other seeds, each of unseen frames of
these pads and of frames of the other kinds.

What would refute that it may be shipped, said before it was measured, on any of these: the upper
end of the 95 % interval (bootstrap over stretches of frames) of the error where something lies is
more than a twentieth above today's; that of missed objects, or of answers where nothing lies, more
than a hundredth of the frames; that of the time more than a twentieth above today's. Or: of small
discs that neither tuning nor telling saw (of 0.5 to 3 cm, on the thesis pad, and as many on the
kinds of pad that chose nothing), today's finds more than a hundredth within 2 cm that the tuned one
does not. Or: on clean frames (an even load on the pad that is told) the mean time is more than a
tenth above today's. Or: of centre or radius, over discs of either simulator that both answer, the
upper end of the interval is more than a twentieth above today's (what counts in choosing is the
radius of ``adaptive``, on which its fits differ most, and the centre of ``locate``). Or: of a
number nearly all others that there are to choose from are as good in 95 of 100 resamples, so that
frames do not tell it.
"""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from tuned import UNSEEN, Told, benched, markdown, run, simulated, small_discs, small_on, streamed

from tactile_graph import Frame, Pipeline, load
from tactile_graph.compiled import warm_up
from tactile_graph_tune import Tuned
from tactile_graph_tune.rerun import rerun
from tactile_graph_tune.split import interval_of
from tactile_graph_tune.table.kinds import Reals
from tactile_graph_tune.table.record import Judged
from tactile_graph_tune.tuned import CHOSEN, GIVEN

PRODUCTS = ("adaptive", "locate")
ERROR_MARGIN, CHOSEN_MARGIN = 0.05, 0.0
"""Of today's error: what may be shipped, and what is allowed in choosing: none, since all that is
allowed there is used up, and a few percent more on other frames come on top."""
SHARE_MARGIN, TIME_MARGIN, CLEAN_MARGIN = 0.01, 0.05, 0.1
NEARLY_ALL = 0.95
N_FRESH = 3
N_SMALL = 240
ROUNDS = 3
BY_HAND = {"legible": "by hand: no frame that the others were chosen by is missing so much"}
"""What is said above the guards that stay."""
FOUND_CM = 2.0
PIPELINES = Path(__file__).parents[1] / "pipelines" / "tactile_graph_pipelines"


def refuted_by(told: Told) -> Iterator[str]:
    """Yield what speaks against shipping, of one set of frames."""
    more, today = told.difference, told.hand.error.mean
    if more.error.high > ERROR_MARGIN * today:
        yield f"the error may be {more.error.high:+.3f} more than {today:.3f}"
    for name, its in (("missed", more.missed), ("false", more.false)):
        if its.high > SHARE_MARGIN:
            yield f"{name}: maybe {100 * its.high:+.1f} % of the frames"
    if told.ratio.high > 1.0 + TIME_MARGIN:
        yield f"it may take {told.ratio.high:.2f} of the time"


def off_by(pipeline: Pipeline, frames: list[Frame]) -> Reals:
    """Return how far off centre and radius are in cm, NaN where none is told, shape (n, 2)."""
    run = pipeline.runner()
    off_cm = []
    for frame in frames:
        (true,) = frame.truth or ()
        place, answer = true.shape, run(frame).get(next(iter(pipeline.outputs)))
        shape = getattr(answer, "shape", answer)
        its = [getattr(shape, k, math.nan) - getattr(place, k, math.nan)
               for k in ("x_cm", "y_cm", "radius_cm")]  # fmt: skip
        off_cm.append([math.hypot(*its[:2]), abs(its[2])])
    return np.array(off_cm)


def vaguer(today: Pipeline, tuned: Pipeline, frames: list[Frame], seed: int) -> Iterator[str]:
    """Yield what speaks against shipping, of centres and radii."""
    pairs = zip(off_by(today, frames).T, off_by(tuned, frames).T, strict=True)
    for name, (mine, its) in zip(("centre", "radius"), pairs, strict=True):
        both = ~np.isnan(mine + its)
        mine, its = mine[both], its[both]
        more = interval_of(its - mine, np.arange(len(its)), seed)
        if more.high > ERROR_MARGIN * mine.mean():
            yield f"the {name} may be off by {more.high:+.3f} cm more than {mine.mean():.3f}"


def found_in(pipeline: Pipeline, frames: list[Frame]) -> list[bool]:
    """Return for each frame of one object whether the answer lies within 2 cm of it."""
    return [bool(centre_cm < FOUND_CM) for centre_cm, _ in off_by(pipeline, frames)]


def unknown(tuned: Tuned) -> Iterator[str]:
    """Yield what speaks against shipping, of how surely the numbers are known."""
    for its in (its for worth in tuned.worths for its in worth.known):
        if its.share >= NEARLY_ALL:
            yield f"{its.text}: {100 * its.share:.0f} % of all levels"


def lost(today: Pipeline, tuned: Pipeline, frames: list[Frame]) -> Iterator[str]:
    """Yield what speaks against shipping, of small discs."""
    pairs = zip(found_in(today, frames), found_in(tuned, frames), strict=True)
    n = sum(mine and not its for mine, its in pairs)
    if n > SHARE_MARGIN * len(frames):
        yield f"of {len(frames)} small discs {n} that today's finds are missed"


def slower(today: Pipeline, tuned: Pipeline, frames: list[Frame], judged: Judged) -> Iterator[str]:
    """Yield what speaks against shipping, of the time that clean frames take."""
    ran = rerun({"today": today, "tuned": tuned}, frames, judged, ROUNDS, seed=0)
    ratio = float(ran["tuned"][0].mean() / ran["today"][0].mean())
    if ratio > 1.0 + CLEAN_MARGIN:
        yield f"clean frames take {ratio:.2f} of the time"


def discs(n: int, seed: int) -> list[Frame]:
    """Return frames of discs, half of the project's simulator, half on pads that are not told."""
    own = simulated("discs")(n // 2, seed)
    each = n // 2 // len(UNSEEN)
    return own + [f for kind in UNSEEN for f in benched("disc")(kind, each, seed) if f.truth]


def clean_frames(n: int, seed: int) -> list[Frame]:
    """Return an even load's frames on the pad that is told."""
    return [f for f in streamed(3 * n, seed) if f.label == "clean"]


def shipped(name: str, text: str) -> str:
    """Return a tuned file under the name, the words and the parent of the shipped one."""
    today = load(name)
    head = f"pipeline: {name}\nabout: {today.about}\nevolves: {today.evolves}\n"
    text = re.sub(r"^pipeline: .*\n(?:about: .*\n)?(?:evolves: .*\n)?", head, text, flags=re.M)
    for guard, why in BY_HAND.items():
        text = re.sub(rf"^  {guard}: ", f"  # {why}\n\\g<0>", text, flags=re.M)
    return text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=PRODUCTS, nargs="+", default=list(PRODUCTS))
    parser.add_argument("--frames", type=int, default=800)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    warm_up()
    for name in asked.only:
        told, tuned = run(name, asked.frames, asked.seed, CHOSEN_MARGIN, N_FRESH)
        print("\n".join(markdown(list(told.values()))))
        against = [f"{on}: {why}" for on, its in told.items() for why in refuted_by(its)]
        against += unknown(tuned)
        small = small_discs(N_SMALL, asked.seed + 3)
        each = math.ceil(N_SMALL / len(UNSEEN))
        small += [f for kind in UNSEEN for f in small_on(kind, each, asked.seed + 3)]
        against += lost(load(name), tuned.pipeline, small)
        against += slower(
            load(name), tuned.pipeline, clean_frames(N_SMALL, asked.seed + 4), tuned.judged
        )
        others = discs(asked.frames, asked.seed + 5)
        against += vaguer(load(name), tuned.pipeline, others, asked.seed)
        given, chosen = (tuned.points[k].choice.chosen for k in (GIVEN, CHOSEN))
        if given == chosen:
            print(f"{name} comes out with the numbers it has: any difference above is noise")
            against = [*unknown(tuned)]
        text = shipped(name, tuned.text)
        print(f"\n{text}")
        for why in against:
            print(f"{name} stays as it is: {why}")
        if asked.write and not against:
            (PIPELINES / f"{name}.yaml").write_text(text, encoding="utf-8")
            print(f"wrote {name}.yaml")


if __name__ == "__main__":
    main()
