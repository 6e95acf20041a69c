"""Several objects by the likelihood of their common load, beside the other ways to tell them apart.

    python benchmarks/objects_likelihood.py [--scenes 100] [--seed 3026] [--only six]

Scenes and scoring are those of ``objects.py``: six objects at four distances, pairs that just
touch, single objects that ought to stay whole, and the scene ``mixed``. All contestants see the
same frames. "right" is how often the number is right; centres are of the true objects that have a
found one within 2 cm, whatever the number. "in 90 %" is how often a true centre lies within the
90 % region of the found one's. Times are of all nodes of a frame, medians. Settings of
``fit_footprints`` were chosen on other seeds (1, 3, 5, 7, 31).

``--why`` looks at the wrong counts of ``objects-likelihood`` alone: its search is run again and may
begin with the true outlines, too. "missed" is how often these have more evidence then, so that the
search should have come upon them; "unlikely" how often they have less.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from objects import COUNTERS, COUNTING, PAIRS, SINGLES, pairs, scenes, singles

from tactile_graph import Frame, Pipeline, load, loads
from tactile_graph.compiled import warm_up
from tactile_graph.steps import Report
from tactile_graph_likelihood.several.fit_footprints import FitFootprints, SeveralSettings
from tactile_graph_sources.simulate import simulate
from tactile_graph_tracking.score_objects import score_objects

GRAMS = """
pipeline: grams
source: {step: simulate, with: {scene: mixed}}
nodes:
  siemens: {step: decouple, in: frame, with: {pad: thesis}}
  grams: {step: force, in: siemens, with: {pad: thesis}}
outputs: [grams]
"""

NORMAL_90 = 4.605  # squared distance within which 90 % of a normal distribution in a plane lies


def contestants() -> dict[str, tuple[Pipeline, str]]:
    """Return each pipeline, and the output that holds what it found."""
    counters = {
        name: (loads(COUNTING % COUNTERS[name]), "objects")
        for name in ("contacts, 8-connected", "split_contacts")
    }
    return {
        **counters,
        "objects": (load("objects"), "shapes"),
        "bayes-objects": (load("bayes-objects"), "shapes"),
        "objects-likelihood": (load("objects-likelihood"), "objects"),
    }


def parts(found: Any) -> list[Any]:
    """Return the objects in an output: none, a list of shapes, contacts or outlines."""
    if found is None:
        return []
    return list(getattr(found, "contacts", getattr(found, "shapes", found)))


def within(frame: Frame, found: list[Any], pairing: Any) -> list[bool]:
    """Return whether true centres lie in the 90 % regions of the found ones that have one."""
    out = []
    for i, j, _ in pairing:
        posterior = getattr(found[j], "posterior", None)
        if posterior is not None:
            true = frame.truth[i].shape  # type: ignore[index]
            off = np.array([true.x_cm, true.y_cm]) - posterior.mean[:2]
            out.append(float(off @ np.linalg.solve(posterior.covariance[:2, :2], off)) < NORMAL_90)
    return out


def compare(frames: list[Frame], what: str) -> None:
    """Print a line for each contestant."""
    for name, (pipeline, output) in contestants().items():
        run = pipeline.runner()
        off, errors, times, inside = [], [], [], []
        for frame in frames:
            result = run(frame)
            found = parts(result.get(output))
            score = score_objects(frame, found)
            off.append(int(np.sign(score.n_found - score.n_true)))
            errors += [e for *_, e in score.pairs]
            inside += within(frame, found, score.pairs)
            times.append(sum(result.times_us.values()))
        e = np.array(errors or [np.nan])
        line = (
            f"{what:20s} {name:22s} {off.count(0) / len(off):7.1%}{off.count(1) / len(off):7.1%}"
            f"{off.count(-1) / len(off):7.1%}{e.mean():8.3f}{np.median(e):8.3f}"
            f"{np.percentile(e, 95):8.3f}{statistics.median(times) / 1e3:9.2f}"
        )
        print(line + (f"{np.mean(inside):9.1%}" if inside else ""), flush=True)


def why(frames: list[Frame], what: str) -> None:
    """Print why counts are wrong: the true outlines were not come upon, or are less likely."""
    grams, fit = loads(GRAMS).runner(), FitFootprints(settings=SeveralSettings(pad="thesis"))
    right = missed = unlikely = 0
    for frame in frames:
        image, true = grams(frame).get("grams"), [its.shape for its in frame.truth or ()]
        found = fit(image)
        if found.count == len(true):
            right += 1
        elif fit(image, true).log_evidence > found.log_evidence + 0.1:
            missed += 1
        else:
            unlikely += 1
    print(f"{what:20s} right {right}, missed {missed}, unlikely {unlikely}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=3026)
    parser.add_argument("--only", choices=("six", "mixed", "pairs", "singles"))
    parser.add_argument("--why", action="store_true", help="look at the wrong counts alone")
    chosen = parser.parse_args()
    warm_up()
    n, seed, look = chosen.scenes, chosen.seed, why if chosen.why else compare
    if not chosen.why:
        print(
            f"{'':43}{'right':>7}{'more':>7}{'fewer':>7}{'mean cm':>8}{'median':>8}{'95 %':>8}",
            end="",
        )
        print(f"{'ms':>9}{'in 90 %':>9}")
    if chosen.only in (None, "six"):
        for apart_cm in (1.3, 1.0, 0.65, 0.0):
            look(scenes(n, apart_cm, seed), f"six, {apart_cm:.2f} cm apart")
    if chosen.only in (None, "mixed"):
        rng = np.random.default_rng(seed)
        look(list(simulate(scene="mixed", frames=2 * n, rng=rng, report=Report())), "mixed")
    if chosen.only in (None, "pairs"):
        for name in PAIRS:
            look(pairs(name, n, seed), name)
    if chosen.only in (None, "singles"):
        for name in SINGLES:
            look(singles(name, n, seed), name)


if __name__ == "__main__":
    main()
