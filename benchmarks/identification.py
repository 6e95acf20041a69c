"""Thesis section 4.4 again: table 4.9 and figures 4.38 to 4.43, as tables and plots.

Run ``python benchmarks/identification.py [FOLDER]``; plots go into the folder, if one is named.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from tactile_graph_thesis.measure.identification_errors import (
    Curve,
    Trials,
    added,
    mean_curves,
    strangers_rejected,
    table_4_9,
)
from tactile_graph_thesis.measure.weighing import Kind
from tactile_graph_thesis.numbers import numbers

SEEDS = range(4)
THESIS_BEYOND_G = numbers("identification")["beyond_g"]
THESIS_AT_MOST = 0.01 * numbers("identification")["error_below_percent"]
WEIGHINGS: dict[Kind, str] = {
    "curve": "calibration curve alone, area from the circle, as in the thesis",
    "decoupled": "circuit inverted, area from the circle",
    "footprint": "circuit inverted, area of the footprint",
}


def show_table_4_9() -> None:
    print("Table 4.9: five objects, 25 readings each to learn, 25 others to test, 10 pads")
    print("thesis: 100 % identified")
    for kind, words in WEIGHINGS.items():
        print(f" {words}")
        results = [table_4_9(seed=seed, kind=kind) for seed in range(10)]
        for step in results[0]:
            one = added([r[step] for r in results])
            shares = f"{100 * one.share_right:6.2f} % right, {100 * one.share_rejected:.2f} %"
            print(f"  {step:<28} {shares} rejected, of {one.n}")
    print("One of the five not learned: its readings rejected as unknown")
    shares = [strangers_rejected(seed=seed) for seed in range(4)]
    for step in shares[0]:
        print(f"  {step:<28} {100 * np.mean([s[step] for s in shares]):6.2f} %")


def show(curves: list[Curve], kind: Kind) -> None:
    print(f"\nFigures 4.38 to 4.43, weight by {WEIGHINGS[kind]}: error in % over difference in g")
    print("thesis: below 5 % beyond 1000 g in all six")
    grams = curves[0].differences_g
    print(
        f"  {'fig.':<5} {'radii/cm':<9} {'classifier':<28}", *(f"{g:5.0f}" for g in grams), " worst"
    )
    for curve in curves:
        pair = curve.pair
        for step, error in curve.error.items():
            worst = error[grams > THESIS_BEYOND_G].max()
            verdict = "ok" if worst < THESIS_AT_MOST else "ABOVE"
            print(
                f"  {pair.figure:<5} {pair.radius_cm}/{pair.other_radius_cm:<5} {step:<28}",
                *(f"{100 * e:5.1f}" for e in error),
                f" {verdict}",
            )


def plot(curves: list[Curve], kind: Kind, folder: Path) -> None:
    """Draw the six figures side by side."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(2, 3, figsize=(13, 7), sharex=True, sharey=True)
    for one, curve in zip(axes.flat, curves, strict=True):
        for step, error in curve.error.items():
            one.plot(curve.differences_g, 100 * error, "o-", ms=3, label=step)
        one.axhline(100 * THESIS_AT_MOST, color="0.6", ls=":", label="5 %")
        pair = curve.pair
        one.set_title(f"figure {pair.figure}: {pair.radius_cm} and {pair.other_radius_cm} cm")
        one.grid(alpha=0.3)
    axes[0, 0].legend()
    figure.supxlabel("difference in weight / g")
    figure.supylabel("readings taken for the wrong disc / %")
    figure.suptitle(f"Identification error, weight by {WEIGHINGS[kind]}")
    figure.tight_layout()
    path = folder / f"identification-{kind}.png"
    figure.savefig(path, dpi=120)
    print(f"{path} written")


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    start = time.perf_counter()
    show_table_4_9()
    for kind in WEIGHINGS:
        curves = mean_curves(SEEDS, Trials(kind))
        show(curves, kind)
        if folder is not None:
            plot(curves, kind, folder)
    print(f"\n{time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
