"""Figures 5.8 to 5.14 of the thesis drawn anew, and its table 5.2 beside ours.

    python benchmarks/bayes_figures.py [--seed 0] [--readings 100] [--pad thesis] [-o FOLDER]

Writes figure-5-8.png (with 5.9), figure-5-10.png (to 5.13) and figure-5-14.png into the folder and
prints the table. The thesis gives neither the test image of figure 5.8 nor its noise in numbers;
ours are in `tactile_graph_thesis.measure.restorations`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from tactile_graph.compiled import warm_up
from tactile_graph_thesis.drawing.line_fields import draw_5_8, draw_5_10_to_5_13, draw_5_14
from tactile_graph_thesis.measure.restorations import (
    NOISE,
    RECTANGLE,
    Restoration,
    figure_5_8,
    figure_5_14,
    figures_5_10_to_5_13,
    table_5_2,
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
    on = np.zeros(made.truth.shape, np.bool_)
    on[RECTANGLE] = True
    wanted = on[:-1] ^ on[1:], on[:, :-1] ^ on[:, 1:]
    got = made.lines.horizontal, made.lines.vertical
    missing = sum(int(np.count_nonzero(w & ~g)) for w, g in zip(wanted, got, strict=True))
    stray = sum(int(np.count_nonzero(g & ~w)) for w, g in zip(wanted, got, strict=True))
    total = sum(int(np.count_nonzero(w)) for w in wanted)
    print(f"figure 5.9: of {total} lines around the rectangle {missing} missing, {stray} elsewhere")


def show_table(seed: int, readings: int, pad: str) -> None:
    print(f"\ntable 5.2: radii in cm, mean ± standard deviation of {readings} readings each")
    print(f"{'':10}{'actual':>8}{'lines in volts':>16}{'thesis':>8}", end="")
    print(f"{'bayes-lines':>15}{'bayes-circle':>15}{'circle-3':>15}{'thesis':>8}")
    thesis = error_table("table-5.2")
    for row in table_5_2(seed, readings, pad):
        _, by_lines, by_opening = thesis.values[thesis.objects.index(row.name)]
        columns = row.volt_hull_cm, row.line_hull_cm, row.bayesian_cm, row.heuristic_cm
        volts, lines, fitted, opened = (f"{mean:.2f} ± {std:.2f}" for mean, std in columns)
        print(
            f"{row.name:10}{row.actual_cm:8.1f}{volts:>16}{by_lines:8.1f}"
            f"{lines:>15}{fitted:>15}{opened:>15}{by_opening:8.1f}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--readings", type=int, default=100)
    parser.add_argument("--pad", default="thesis")
    parser.add_argument("-o", "--out", type=Path, default=Path())
    chosen = parser.parse_args()
    warm_up()
    both = figure_5_8(chosen.seed), figure_5_8(chosen.seed, "restore")
    for made in both:
        judge(made)
    chosen.out.mkdir(parents=True, exist_ok=True)
    for name, figure in (
        ("figure-5-8", draw_5_8(*both)),
        ("figure-5-10", draw_5_10_to_5_13(figures_5_10_to_5_13(chosen.seed, chosen.pad))),
        ("figure-5-14", draw_5_14(figure_5_14(chosen.seed, chosen.pad))),
    ):
        figure.savefig(chosen.out / f"{name}.png", dpi=110)
        print(f"wrote {chosen.out / name}.png")
    show_table(chosen.seed, chosen.readings, chosen.pad)


if __name__ == "__main__":
    main()
