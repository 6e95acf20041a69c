"""Family ``stream``: what skipping is worth where most frames need little.

Frames of one pad in random order: 80 % empty, 15 % clean (even load), 5 % hard, a fifth of these
each of an uneven pad, of one with broken elements too, with a dead row, far beyond saturation, and
under foam. Whoever localises knows the thesis' pad, and not what comes. Times are processor time,
as in the other families.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from suite_parts.contestants import error_of
from suite_parts.records import Measured
from suite_parts.scenes import pad_of
from tactile_graph import Frame, Pipeline, load
from tactile_graph.api.result import Result
from tactile_graph.engine.outcomes.outcome import NO_VALUE
from tactile_graph.pipeline.graph import NodeKind
from tactile_graph_compare.run.audit import Audit, audit

SHARES = {"empty": 0.80, "clean": 0.15}
HARD = tuple(f"hard: {kind}" for kind in ("noisy", "broken", "dead row", "saturated", "foam"))
DISCS = ((1860.0, 6.8), (6360.0, 5.1), (6810.0, 7.7))
"""Grams and radius of the discs of thesis table 4.2."""
SATURATED_G_CM2 = 10e3
"""Of an element's cell, where its law ends at 10 kg."""
FOAM_CM = 1.0
WHOLE = "whole stream"
PARTS = (WHOLE, "empty", "clean", "hard", *HARD)
UNGATED = ", no gates"


@dataclass(frozen=True)
class Stream:
    """Frames, and of which class each is."""

    frames: tuple[Frame, ...]
    classes: tuple[str, ...]

    def at(self, case: str) -> tuple[int, ...]:
        """Return the places of a part's frames: of a class, of all hard ones, or of all."""
        return tuple(i for i, c in enumerate(self.classes) if case in (c, c.split(":")[0], WHOLE))


def stream(n_frames: int, seed: int, shares: Mapping[str, float] = SHARES) -> Stream:
    """Return the stream in its random order; every class has at least one frame.

    ``shares`` are those of empty and of clean frames.
    """
    counts = {name: round(share * n_frames) for name, share in shares.items()}
    left = n_frames - sum(counts.values())
    counts |= {name: max(1, (left + i) // len(HARD)) for i, name in enumerate(HARD)}
    made = [(f, name) for name, n in counts.items() for f in _frames(name, n, seed)]
    order = np.random.default_rng([seed, 7]).permutation(len(made)).tolist()
    frames = tuple(made[k][0].with_index(i) for i, k in enumerate(order))
    return Stream(frames, tuple(made[k][1] for k in order))


def _frames(name: str, n: int, seed: int) -> Iterator[Frame]:
    kind = ("empty", "clean", *HARD).index(name)
    rng = np.random.default_rng([seed, 11, kind])
    name = name.removeprefix("hard: ")
    pad = pad_of(name, 16, rng)
    if name == "foam":
        pad["contact"] = {**pad["contact"], "foam_cm": FOAM_CM}
    groups = [] if name == "empty" else [[_disc(*disc, name)] for disc in DISCS]
    scene: dict[str, Any] = {"in_turn": groups} if groups else {"objects": []}
    simulated = load("contacts").with_source("simulate", scene=scene, pad=pad, frames=n)
    return simulated.frames(int(rng.integers(2**31)))


def _disc(weight_g: float, radius_cm: float, name: str) -> dict[str, Any]:
    if name == "saturated":
        weight_g = SATURATED_G_CM2 * math.pi * radius_cm**2
    return {"shape": "disc", "name": "disc", "weight_g": weight_g, "radius_cm": radius_cm}


def ungated(pipeline: Pipeline) -> Pipeline:
    """Return the pipeline with every step run in every frame; which answer is taken stays."""
    nodes = {
        name: node if node.kind is NodeKind.FIRST_OF else replace(node, guard=None)
        for name, node in pipeline.nodes.items()
    }
    return replace(pipeline, nodes=nodes)


def pipelines() -> dict[str, Pipeline]:
    """Return who runs, the one that always runs everything first: times are divided by its."""
    full = load("circle-full")
    found = {full.name + UNGATED: ungated(full), full.name: full}
    for name in ("adaptive", "circle-likelihood", "bayes-circle", "circle-3"):
        found[name] = load(name)
    for name in ("circle-likelihood", "circle-3"):
        found[name + UNGATED] = ungated(load(name))
    return found


def measured(
    n_frames: int, rounds: int, seed: int, told: Callable[[str], None]
) -> Iterator[Measured]:
    """Yield what each pipeline makes of the stream, and of each class of frames in it."""
    told("stream")
    made = stream(n_frames, seed)
    entered = pipelines()
    runners = {name: p.runner() for name, p in entered.items()}
    results = {name: [run(f) for f in made.frames] for name, run in runners.items()}
    taken = _times_us(runners, made, rounds)
    for case in PARTS:
        at, one = made.at(case), case in made.classes
        for name, pipeline in entered.items():
            times, own = taken[name][:, at], [results[name][i] for i in at]
            yield Measured(
                "stream",
                case,
                name,
                tuple(times.mean(axis=1).tolist()),
                _errors(own, next(iter(pipeline.outputs))),
                statistics.fmean(sum(t > 0.0 for t in r.times_us.values()) for r in own),
                len(pipeline.nodes),
                at=at if one else (),
                frames_us=tuple(np.median(times, axis=0).round(2).tolist()) if one else (),
            )


def _times_us(
    runners: dict[str, Callable[[Frame], Result]], made: Stream, rounds: int
) -> dict[str, np.ndarray[Any, np.dtype[np.float64]]]:
    """Return microseconds by round and frame; in each round every pipeline has its turn."""
    taken = {name: np.empty((rounds, len(made.frames))) for name in runners}
    for k in range(rounds):
        for name, run in runners.items():
            row = taken[name][k]
            for i, frame in enumerate(made.frames):
                start = time.process_time()
                run(frame)
                row[i] = time.process_time() - start
    return {name: 1e6 * rows for name, rows in taken.items()}


def _errors(results: list[Result], output: str) -> dict[str, tuple[float | None, ...]]:
    """Return the errors of one output, and how often it answers on an empty pad."""
    found: dict[str, list[float | None]] = {}
    for result in results:
        answer = result.outcome(output)
        shapes = [] if type(answer) in NO_VALUE else [answer]
        truth = result.frame.truth or ()
        if not truth:
            found.setdefault("false alarms", []).append(float(len(shapes)))
            continue
        errors = error_of(shapes, truth)
        for quantity in ("centre_cm", "radius_cm"):
            found.setdefault(quantity, []).append(errors.get(quantity))
    return {quantity: tuple(errors) for quantity, errors in found.items()}


def audited(n_frames: int, seed: int) -> Audit:
    """Return what each guard of the adaptive pipeline saves and costs on the stream."""
    return audit(load("adaptive"), stream(n_frames, seed).frames, seed=seed)
