"""`locate_disc` where the pad's turn-on is told four times too high or too low.

Run with ``python benchmarks/told_turn_on.py``; ``--scenes N`` discs of table 4.2 on each pad of
`second_simulator`. The same frames are located twice, told the thesis' turn-on and the true one.
What would refute the claim that a wrong turn-on at most doubles the error: a ratio above 2 in
centre or radius. Nothing was tuned on the seed.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace

import numpy as np
import yaml
from second_simulator import BASE, Bench
from unknown_pads import BENCH_FRAMES

from tactile_graph import Circle, Frame
from tactile_graph.compiled import warm_up
from tactile_graph.plugins.registry import installed
from tactile_graph_likelihood.any_pad.locate import ANY_PAD, LocateDisc

TOLD_G = 10.0
TRUE_G = (2.5, 10.0, 40.0)


def frames_of(turn_on_g: float, n: int, seed: int) -> list[Frame]:
    """Return frames of pads whose elements turn on at this load."""
    rng = np.random.default_rng([seed, round(1000 * turn_on_g)])
    kind, frames = replace(BASE, turn_on_g=turn_on_g), list[Frame]()
    while len(frames) < n:
        frames += Bench(kind, rng).frames(BENCH_FRAMES, "disc")
    return frames[:n]


def errors(frames: list[Frame], told_g: float) -> tuple[float, float]:
    """Return the mean errors of centre and radius in cm, the pad being told with this turn-on."""
    pad = yaml.safe_load(installed().path("pads", "thesis").read_text("utf-8"))
    pad["law"]["turn_on_g"] = told_g
    step = LocateDisc(replace(ANY_PAD, pad=pad))
    off = []
    for frame in frames:
        found, (true, *_) = step(frame.image), frame.truth or ()
        assert isinstance(true.shape, Circle)
        centre = math.hypot(found.x_cm - true.shape.x_cm, found.y_cm - true.shape.y_cm)
        off.append((centre, abs(found.radius_cm - true.shape.radius_cm)))
    centre_cm, radius_cm = np.mean(off, axis=0)
    return float(centre_cm), float(radius_cm)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=240)
    parser.add_argument("--seed", type=int, default=41)
    args = parser.parse_args()
    warm_up()
    print("| turn-on, g | told 10 g, cm | told rightly | ratio |")
    print("| --- | --- | --- | --- |")
    for true_g in TRUE_G:
        frames = frames_of(true_g, args.scenes, args.seed)
        wrong, right = errors(frames, TOLD_G), errors(frames, true_g)
        ratio = ", ".join(f"{a / b:.2f}" for a, b in zip(wrong, right, strict=True))
        both = ["{:.3f} / {:.3f}".format(*its) for its in (wrong, right)]
        print(f"| {true_g:g} | {both[0]} | {both[1]} | {ratio} |", flush=True)


if __name__ == "__main__":
    main()
