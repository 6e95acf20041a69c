"""Figures 5.8 to 5.14 of the thesis drawn anew, and its table 5.2 beside ours.

    python benchmarks/bayes_figures.py [--seed 0] [--readings 100] [--pad thesis] [-o FOLDER]

Writes figure-5-8.png (with 5.9), figure-5-10.png (to 5.13) and figure-5-14.png into the folder and
prints the table. The thesis gives neither the test image of figure 5.8 nor its noise in numbers;
ours are in `tactile_graph_thesis.measure.simulated_rectangle`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from tactile_graph.compiled import warm_up
from tactile_graph_thesis.drawing.line_fields import draw_5_8, draw_5_10_to_5_13, draw_5_14
from tactile_graph_thesis.measure.restorations import (
    WAYS,
    Restoration,
    figures_5_10_to_5_13,
    hulls,
    table_5_2,
)
from tactile_graph_thesis.measure.simulated_rectangle import (
    NOISE,
    TITLES,
    cells_amiss,
    figure_5_8,
)
from tactile_graph_thesis.numbers import error_table


def judge(made: Restoration) -> None:
    """Say how near the restored images come to the original, and the lines to its outline."""
    assert made.truth is not None
    print(f"figure 5.8 by {made.restorer}, energy {made.energy:.0f}")
    print(f"  root mean square error in grey levels, the noise being {NOISE:g}")
    for name, image in (
        ("corrupted", made.observed),
        ("without lines", made.smooth),
        ("with lines", made.lined),
    ):
        off = image.values - made.truth.values
        print(f"  {name:16}{np.sqrt(np.mean(off**2)):8.2f}")
    amiss = cells_amiss(made)
    print(f"figure 5.9: {made.lines.count} lines, {amiss} cells amiss in what they enclose")


def show_table(seed: int, readings: int, pad: str) -> None:
    rows = table_5_2(seed, readings, pad)
    thesis = error_table("table-5.2")
    print(
        f"\ntable 5.2: radii in cm, mean ± standard deviation (mean error) of {readings} readings"
    )
    print(f"{'':38}" + "".join(f"{f'{r.name}, {r.actual_cm} cm':>22}" for r in rows))
    for way in WAYS:
        cells = (
            f"{r.mean_cm(way):.2f} ± {r.sd_cm(way):.2f} ({np.nanmean(r.error_cm(way)):.2f})"
            for r in rows
        )
        print(f"{way:38}" + "".join(f"{cell:>22}" for cell in cells))
    for k, words in ((1, "thesis, by lines"), (2, "thesis, heuristic")):
        told = (thesis.values[thesis.objects.index(r.name)][k] for r in rows)
        print(f"{words:38}" + "".join(f"{value:>22.1f}" for value in told))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--readings", type=int, default=100)
    parser.add_argument("--pad", default="thesis")
    parser.add_argument("-o", "--out", type=Path, default=Path())
    chosen = parser.parse_args()
    warm_up()
    ways = [figure_5_8(chosen.seed, way) for way in TITLES]
    for made in ways:
        judge(made)
    raw, ours = (figures_5_10_to_5_13(chosen.seed, chosen.pad, way) for way in ("thesis", "bayes"))
    chosen.out.mkdir(parents=True, exist_ok=True)
    for name, figure in (
        ("figure-5-8", draw_5_8(*ways)),
        ("figure-5-10", draw_5_10_to_5_13([*raw, *ours])),
        ("figure-5-14", draw_5_14(hulls(chosen.seed, 1, chosen.pad))),
    ):
        figure.savefig(chosen.out / f"{name}.png", dpi=110)
        print(f"wrote {chosen.out / name}.png")
    show_table(chosen.seed, chosen.readings, chosen.pad)


if __name__ == "__main__":
    main()
