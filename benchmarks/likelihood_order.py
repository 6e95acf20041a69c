"""Localisation on a pad whose law nobody knows: by touch and order, beside those that need it.

Run with ``python benchmarks/likelihood_order.py`` (about a minute); ``--scenes N`` takes other
than 150. Discs of table 4.2 on the thesis' pad and on pads with another law. The likelihood of
the load is told the thesis' law ("law wrong") or the pad's own ("law known"); circle-3 takes the
volts as they are, the order is told the circuit. Then the kinds of ``likelihood_robustness.py``
by order: mean errors, the share flagged (``fits`` False), and how often the 90 % region holds.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from likelihood_robustness import KINDS
from likelihood_robustness import frames as frames_of
from rounds import print_table, time_side_by_side

from tactile_graph import Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph_likelihood.single.noise import level_of
from tactile_graph_pads.pad import load_pad

LEVEL_V = 0.01

LAW = {
    "load_g": 100, "resistance_ohm": 80e3, "load2_g": 2000, "resistance2_ohm": 1e3,
    "turn_on_g": 10, "saturation_g": 10e3, "repeatability": 0.05,
}  # fmt: skip
REST = {
    "circuit": {"kind": "divider", "bias_ohm": 33e3, "supply_v": 5},
    "unevenness": {"sigma": 0.483, "voids": 0.164, "correlation_cm": 0.469, "fixed": 0.103},
}
LAWS = {
    "the thesis' law": LAW,
    "exponent 1, no turn-on": {**LAW, "exponent": 1.0, "turn_on_g": 0},
    "exponent 2.2": {**LAW, "exponent": 2.2},
    "levels off from 50 g": {**LAW, "saturation_g": 50, "saturation_headroom": 0.3},
}


def localisers(pad: dict[str, Any]) -> dict[str, Callable[[Frame], Any]]:
    likelihood = load("circle-likelihood")
    shows = level_of(load_pad(pad), LEVEL_V)  # less is noise, on pads that turn on at once
    told = likelihood.with_settings(
        {"siemens.pad": pad, "grams.pad": pad, "circle.pad": pad, "circle.shows_from": shows}
    )
    return {
        "circle-3": load("circle-3").runner(),
        "likelihood, law wrong": likelihood.runner(),
        "likelihood, law known": told.runner(),
        "by order": load("circle-by-order").runner(),
    }


def measured(name: str, law: dict[str, Any], scenes: int, seed: int) -> None:
    pad = {**REST, "law": law}
    source = load("circle-likelihood").with_source(
        "simulate", scene="discs", frames=scenes, pad=pad
    )
    centre, radius = defaultdict(list), defaultdict(list)
    inside, flagged = defaultdict(list), defaultdict(list)
    runs = localisers(pad)
    lost: dict[str, int] = defaultdict(int)
    for frame in source.frames(seed):
        assert frame.truth is not None
        true = frame.truth[0].shape
        for label, run in runs.items():
            found = run(frame).get("circle")  # type: ignore[attr-defined]
            if found is None:
                lost[label] += 1
                continue
            centre[label].append(np.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm))
            radius[label].append(found.radius_cm - true.radius_cm)
            if hasattr(found, "posterior"):
                inside[label].append(found.posterior.contains(true))
                flagged[label].append(not found.fits)
    print(f"\n{name}: mean errors of {scenes} discs")
    for label in runs:
        held = f"{np.mean(inside[label]):6.1%}" if inside[label] else "     -"
        flags = f"{np.mean(flagged[label]):5.1%}" if flagged[label] else "    -"
        print(
            f"  {label:<24} centre {np.mean(centre[label]):.3f} cm, radius"
            f" {np.mean(np.abs(radius[label])):.3f} cm (bias {np.mean(radius[label]):+.3f}),"
            f" in 90 %: {held}, flagged {flags}, no answer {lost[label]}"
        )


def otherwise(scenes: int, seed: int) -> None:
    run = load("circle-by-order").runner()
    print(f"\nBy order, contacts it was not designed for: {scenes} discs of a kind")
    for name, (kind, pad) in KINDS.items():
        rows = []
        for frame in frames_of(kind, pad, scenes, seed):
            found = run(frame).get("circle")
            if found is None:
                continue
            assert frame.truth is not None
            true: Any = frame.truth[0].shape
            off = np.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm)
            radius = abs(found.radius_cm - true.radius_cm)
            rows.append((off, radius, not found.fits, found.posterior.contains(true)))
        centre, radius, flagged, held = np.mean(rows, axis=0)
        print(
            f"  {name:<24} centre {centre:.3f} cm, radius {radius:.3f} cm, flagged {flagged:6.1%},"
            f" in 90 %: {held:6.1%}, no answer {scenes - len(rows)}"
        )


def times(seed: int) -> None:
    frames = list(load("circle-3").with_source("simulate", scene="discs", frames=12).frames(seed))

    def cycled(name: str) -> Callable[[], object]:
        run, turn = load(name).runner(), itertools.cycle(frames)
        return lambda: run(next(turn))

    print("\nOne frame")
    names = ("circle-3", "circle-likelihood", "circle-by-order")
    print_table(time_side_by_side({n: cycled(n) for n in names}), "circle-3")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=150)
    parser.add_argument("--seed", type=int, default=21)
    chosen = parser.parse_args()
    warm_up()
    for name, law in LAWS.items():
        measured(name, law, chosen.scenes, chosen.seed)
    otherwise(chosen.scenes, chosen.seed)
    times(chosen.seed)


if __name__ == "__main__":
    main()
