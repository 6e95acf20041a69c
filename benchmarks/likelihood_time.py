"""An object over time: error against frames at rest and placements, moves noticed, false alarms.

Run with ``python benchmarks/likelihood_time.py`` (about two minutes); ``--series N`` takes other
than 40 of each kind. DISC I of the thesis, and smaller ones in noise. At rest the unevenness
stays, so only the scatter of readings averages out: shown on the thesis' pad, on one whose
readings scatter by 50 %, and on an even one. Put down again, the sizes' posterior is the next
prior; also of a ball, of weight off centre and on foam, as in ``likelihood_robustness.py``, with
pressure ``any`` and ``even``.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import likelihood_robustness

from tactile_graph import Image, Pipeline, load
from tactile_graph.compiled import warm_up
from tactile_graph_likelihood.over_time.follow_footprint import Followed, FollowFootprint
from tactile_graph_likelihood.settings import FootprintSettings
from tactile_graph_likelihood.single.footprint_of import FootprintDisc
from tactile_graph_pads.pad import load_pad

DISC = {"shape": "disc", "name": "DISC I", "weight_g": 1860, "radius_cm": 6.8}
SHOWN = (1, 2, 4, 8, 16)
PITCH_CM = 1.3

BASE = {
    "law": {
        "load_g": 100, "resistance_ohm": 80e3, "load2_g": 2000, "resistance2_ohm": 1e3,
        "turn_on_g": 10, "saturation_g": 10e3,
    },
    "circuit": {"kind": "divider", "bias_ohm": 33e3, "supply_v": 5},
    "scan": {"samples": 100, "noise_v": 0.002, "sample_s": 0.002},
}  # fmt: skip


def pad(repeatability: float, sigma: float, voids: float, fixed: float) -> dict[str, Any]:
    """Return the thesis' pad with another scatter of readings and other unevenness."""
    uneven = {"sigma": sigma, "voids": voids, "correlation_cm": 0.469, "fixed": fixed}
    law = {**BASE["law"], "repeatability": repeatability}
    return {**BASE, "law": law, "unevenness": uneven}


PADS = {
    "thesis' pad": pad(0.05, 0.483, 0.164, 0.103),
    "scatter 50 %": pad(0.5, 0.483, 0.164, 0.103),
    "even, scatter 50 %": pad(0.5, 0.1, 0.02, 0.103),
}


def grams_of(scene: dict[str, Any], on: dict[str, Any], frames: int, seed: int) -> list[Any]:
    """Return (frame, image in grams) of a scene on a pad."""
    pipeline: Pipeline = load("circle-likelihood").with_source(
        "simulate", scene=scene, frames=frames, pad=on
    )
    run = pipeline.runner(only=["grams"])
    return [(frame, run(frame)["grams"]) for frame in pipeline.frames(seed)]


def pressed_of(kind: str, frames: int, seed: int) -> list[Any]:
    """Return (frame, image in grams) of the disc put down anew and pressing otherwise."""
    run = load("circle-likelihood").runner(only=["grams"])
    discs = likelihood_robustness.DISCS  # in turn; the first is DISC I
    every = likelihood_robustness.frames(
        *likelihood_robustness.KINDS[kind], len(discs) * frames, seed
    )
    return [(frame, run(frame)["grams"]) for frame in list(every)[:: len(discs)]]


def rows_of(
    name: str, scene: dict[str, Any] | str, on: dict[str, Any], series: int,
    step: Callable[[], Any],
) -> None:  # fmt: skip
    """Print centre and radius error, and how often the 90 % region holds, by frame."""
    centre, radius, inside = defaultdict(list), defaultdict(list), defaultdict(list)
    for seed in range(series):
        follow = step()
        if isinstance(scene, str):
            seen = pressed_of(scene, max(SHOWN), 1000 + seed)
        else:
            seen = grams_of(scene, on, max(SHOWN), seed)
        for k, (frame, image) in enumerate(seen, 1):
            found = follow(image)
            if k not in SHOWN:
                continue
            true = frame.truth[0].shape
            shape = found.shape if isinstance(found, Followed) else found
            centre[k].append(np.hypot(shape.x_cm - true.x_cm, shape.y_cm - true.y_cm))
            radius[k].append(abs(shape.radius_cm - true.radius_cm))
            inside[k].append(shape.posterior.contains(true))
    for label, of in (("centre/cm", centre), ("radius/cm", radius)):
        print(f"  {name:<34} {label:<10}", *(f"{np.mean(of[k]):7.4f}" for k in SHOWN))
    print(f"  {'':<34} {'in 90 %':<10}", *(f"{np.mean(inside[k]):7.1%}" for k in SHOWN))


def shifted(image: Image, truth: Any, by: tuple[float, float], on: Any, load_g: float) -> Image:
    """Return an image whose gains stay while the disc moves: the hardest move to notice."""
    contact, geometry = on.contact, on.geometry
    here = contact.load_g(truth, load_g, geometry)
    moved = type(truth)(truth.x_cm + by[0], truth.y_cm + by[1], truth.radius_cm)
    there = contact.load_g(moved, load_g, geometry)
    known = here > 0.05
    gain = np.where(known & (image.values > 0), image.values / np.where(known, here, 1.0), 0.0)
    fresh = np.where(known, gain, 1.0)
    return image.with_values(there * fresh)


def moves(series: int) -> None:
    """Print how many moves are noticed with the first frame after them."""
    on = load_pad(PADS["thesis' pad"])
    print("\nMoves noticed with the first frame (thesis' pad, 3 frames at rest before)")
    for label, cells in (("half a cell", 0.5), ("a fifth of a cell", 0.2), ("5 % of a cell", 0.05)):
        noticed = stuck = 0
        for seed in range(series):
            rng = np.random.default_rng([seed, 1])
            x, y = rng.uniform(7.5, 13.0, 2)
            way = rng.uniform(0.0, 2.0 * np.pi)
            by = (cells * PITCH_CM * np.cos(way), cells * PITCH_CM * np.sin(way))
            places = [{**DISC, "place": [x, y]}, {**DISC, "place": [x + by[0], y + by[1]]}]
            scene = {"in_turn": [[p] for p in places], "hold": 3}
            follow = FollowFootprint(settings=FootprintSettings(on_pad="whole"))
            images = grams_of(scene, PADS["thesis' pad"], 4, seed)
            for _, image in images[:3]:
                follow(image, gap_s=0.1)
            noticed += follow(images[3][1], gap_s=0.1).moved
            slid = FollowFootprint(settings=FootprintSettings(on_pad="whole"))
            for _, image in images[:3]:
                slid(image, gap_s=0.1)
            frame, image = images[2]
            stuck += slid(shifted(image, frame.truth[0].shape, by, on, 1860.0), gap_s=0.1).moved
        print(
            f"  {label:<18} gains drawn anew {noticed / series:6.1%}"
            f"   same gains {stuck / series:6.1%}"
        )


def false_alarms(frames: int) -> None:
    print("\nResets of an object that lies still, per 1000 frames 0.1 s apart, and the step's time")
    for name, on in PADS.items():
        follow = step_of(on)
        scene = {"objects": [DISC], "hold": 10**6}
        false, times = 0, []
        for k, (_, image) in enumerate(grams_of(scene, on, frames, 7)):
            start = time.perf_counter()
            false += follow(image, gap_s=0.1).moved and k > 0
            times.append(time.perf_counter() - start)
        rate, median = 1000 * false / (frames - 1), 1e6 * np.median(times)
        print(f"  {name:<20} {rate:6.2f}   median {median:.0f} us")


def rests_in_noise(series: int) -> None:
    """Print how often a disc moves at rest where readings are not averaged, and how it is found."""
    print(
        "\nPipeline circle-followed, 24 frames of a disc at rest, pads read once and told as ever"
    )
    for load_g in (120, 400):
        for noise_v, bits in ((2e-4, 12), (2e-3, 12), (2e-3, 10), (5e-3, 12), (5e-3, 8)):
            on = {**PADS["thesis' pad"], "scan": {"samples": 1, "noise_v": noise_v}}
            on["converter"] = {"bits": bits, "low_v": -5, "high_v": 5}
            moved, inside, off = [], [], []
            for seed in range(series):
                radius_cm = 2.5 + 1.5 * seed / series
                weight_g = load_g * np.pi * (radius_cm / PITCH_CM) ** 2
                disc = {"shape": "disc", "name": "D", "weight_g": weight_g, "radius_cm": radius_cm}
                pipeline = load("circle-followed").with_source(
                    "simulate", scene={"objects": [disc], "hold": 10**6}, frames=24, pad=on
                )
                results = list(pipeline.stream(seed=seed))
                moved += [result["disc.moved"] for result in results[1:]]
                last, true = results[-1]["disc.shape"], results[-1].frame.truth[0].shape
                inside.append(last.posterior.contains(true))
                off.append(np.hypot(last.x_cm - true.x_cm, last.y_cm - true.y_cm))
            print(
                f"  {load_g} g, {1e3 * noise_v:.1f} mV, {bits} bits: moved {np.mean(moved):6.1%}, "
                f"in 90 % {np.mean(inside):6.1%}, centre/cm {np.mean(off):.3f}"
            )


def step_of(on: dict[str, Any], **settings: Any) -> FollowFootprint:
    return FollowFootprint(settings=FootprintSettings(pad=on, on_pad="whole"), **settings)


def each_alone(on: dict[str, Any]) -> Callable[[], Any]:
    """Return a maker of the step that forgets all frames before."""
    return lambda: FootprintDisc(FootprintSettings(pad=on, on_pad="whole"))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--series", type=int, default=40)
    parser.add_argument("--frames", type=int, default=1000)
    chosen = parser.parse_args()
    warm_up()
    print("Mean error after so many frames or placements", *(f"{k:7d}" for k in SHOWN))
    rest = {"objects": [DISC], "hold": 10**6}
    for name, on in PADS.items():
        rows_of(f"at rest, {name}", rest, on, chosen.series, lambda on=on: step_of(on))
        rows_of("  each frame alone", rest, on, chosen.series, each_alone(on))
    anew = {"objects": [DISC]}
    same = {"objects": [{**DISC, "place": [10.4, 9.9]}]}
    thesis = PADS["thesis' pad"]
    rows_of("put down elsewhere", anew, thesis, chosen.series, lambda: step_of(thesis))
    rows_of("put down at the same place", same, thesis, chosen.series, lambda: step_of(thesis))
    rows_of(
        "  without the fixed share", same, thesis, chosen.series, lambda: step_of(thesis, fixed=0)
    )
    for kind in ("ball on an elastic pad", "weight off centre", "foam, half a cell"):
        for pressure in ("any", "even"):
            rows_of(
                f"{kind}, {pressure}", kind, thesis, chosen.series,
                lambda pressure=pressure: step_of(thesis, pressure=pressure),
            )  # fmt: skip
    moves(chosen.series)
    false_alarms(chosen.frames)
    rests_in_noise(chosen.series)


if __name__ == "__main__":
    main()
