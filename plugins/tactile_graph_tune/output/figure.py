"""Error against time: the front, the oracle, what was set by hand and what was chosen."""

from __future__ import annotations

import numpy as np

from tactile_graph.files import whole_file
from tactile_graph_tune.tuned import ALWAYS, CHOSEN, GIVEN, Tuned, Weight

INK, HAND, OWN, BEST = "#3b4a54", "#b3541e", "#0a6ebd", "#6b7d3a"


def write_figure(tuned: Tuned, name: str) -> None:
    """Write the Pareto front as a picture: .png, .svg or .pdf."""
    from pathlib import Path

    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.6), layout="constrained")
    axes = figure.subplots()
    judged = tuned.judged
    front = tuned.front
    errors, oracle_us = oracle_line(tuned)
    axes.plot(oracle_us, errors, color=INK, lw=1.2, ls=":",
              label="oracle: knows each frame's errors")  # fmt: skip
    axes.plot([p.weight.time_us.mean for p in front], [p.weight.error.mean for p in front],
              "o", ms=4, color=OWN, alpha=0.5, label="front, on unseen frames")  # fmt: skip
    marks = {GIVEN: ("s", HAND), ALWAYS: ("D", BEST), CHOSEN: ("*", OWN)}
    for label, (mark, colour) in marks.items():
        weight = tuned.points[label].weight
        (time_us, low_us, high_us), (error, low, high) = weight.time_us, weight.error
        axes.errorbar(time_us, error, xerr=[[time_us - low_us], [high_us - time_us]],
                      yerr=[[error - low], [high - error]], fmt=mark, color=colour, capsize=2,
                      ms=13 if label == CHOSEN else 8, lw=1.0, label=_told(label, weight),
                      )  # fmt: skip
    axes.set_xscale("log")
    if all(p.weight.error.mean > 0.0 for p in (*front, *tuned.points.values())):
        axes.set_yscale("log")
    fastest = min(
        [p.weight.time_us.mean for p in front] + [tuned.points[CHOSEN].weight.time_us.mean]
    )
    axes.set_xlim(left=max(0.1, 0.1 * fastest))
    axes.set_xlabel("time a frame, µs (sum of its steps)")
    unit = f", {judged.unit}" if judged.unit else ""
    axes.set_ylabel(
        f"error of the {judged.quantity} where something lies{unit} (missed: {judged.price:g})"
    )
    axes.set_title(f"{tuned.n_weighed} choices, shown on {tuned.n_reporting} frames they had not "
                   "seen; bars: 95 %", fontsize=9)  # fmt: skip
    axes.grid(alpha=0.25, which="both", lw=0.5)
    axes.legend(fontsize=8, frameon=False)
    with whole_file(name) as file:
        figure.savefig(file, format=Path(name).suffix.lstrip(".").lower(), dpi=150)


def oracle_line(tuned: Tuned, n: int = 25) -> tuple[list[float], list[float]]:
    """Return errors, and the least time an oracle takes for each, missing no more than tuned."""
    missed = tuned.points[CHOSEN].weight.missed.mean
    most = max(p.weight.error.mean for p in (*tuned.front, *tuned.points.values()))
    errors = np.linspace(tuned.bound.least_error, most, n).tolist()
    return errors, [tuned.bound.time_at(e, missed) for e in errors]


def _told(label: str, weight: Weight) -> str:
    shares = (("missed", weight.missed.mean), ("false on empty", weight.false.mean))
    told = ", ".join(f"{name} {100 * x:.0f} %" for name, x in shares if x == x)
    return f"{label}: {told}" if told else label
