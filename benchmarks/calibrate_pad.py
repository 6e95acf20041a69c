"""Fit the thesis pad's unevenness so that circle-1, -2 and -3 err as tables 4.3 to 4.5 say.

Run with ``python benchmarks/calibrate_pad.py`` (about five minutes); ``--check`` only measures
the pad as it is shipped. The result goes by hand into ``pads/thesis.yaml``; it is one pad for
all tables.

Searched are the lognormal width of the elements' gains, the share of voids, the distance over
which both are correlated, and the share of the pattern that stays with the pad. Minimised is the
root mean square of ln(ours / thesis) over the 54 figures of the three tables: average and maximum
error of centre x, centre y and radius, for three objects and three algorithms. The thesis does
not give its number of readings per table; 20, its own choice of section 4.1, is assumed, and
"maximum" is the mean over groups of 20 of each group's maximum. A reading without an answer
counts as an error of its object's own radius.
"""

from __future__ import annotations

import argparse

import numpy as np
import yaml
from numpy.typing import NDArray
from scipy.optimize import minimize

from tactile_graph import Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph.plugins.registry import installed
from tactile_graph_thesis.measure.beside_thesis import spread
from tactile_graph_thesis.measure.circles import circle_errors
from tactile_graph_thesis.numbers import error_table

PIPELINES = ("circle-1", "circle-2", "circle-3")
OBJECTS = ("DISC I", "DISC II", "DISC III")
COLUMNS = ("x max", "x avg", "y max", "y avg", "r max", "r avg")
GROUP = 20

THESIS = np.array([error_table(f"table-4.{k}").values for k in (3, 4, 5)])
# Where the search sets out: sigma, voids, correlation in cm, log odds of the fixed share.
STARTS = (
    (0.5, 0.1, 0.5, -2.0),
    (0.8, 0.15, 1.5, -1.0),
    (0.5, 0.15, 2.5, 2.0),
    (0.3, 0.2, 1.0, 3.0),
)
Array = NDArray[np.float64]


def thesis_pad() -> dict[str, object]:
    """The shipped pad as plain data."""
    text = installed().path("pads", "thesis").read_text(encoding="utf-8")
    return dict(yaml.safe_load(text))


def readings(pad: dict[str, object], groups: int, seed: int) -> list[Frame]:
    """Frames of the three discs in turn, ``groups`` times 20 of each."""
    n = len(OBJECTS) * GROUP * groups
    source = load("circle-1").with_source("simulate", scene="discs", pad=pad, frames=n)
    return list(source.frames(seed))


def table(frames: list[Frame]) -> Array:
    """Return maximum and average errors as the thesis tabulates them, shape (3, 3, 6)."""
    runners = [load(name).runner() for name in PIPELINES]
    errors = circle_errors(frames, runners, OBJECTS)
    return np.array([[_row(of_object) for of_object in of_runner] for of_runner in errors])


def _row(errors: Array) -> list[float]:
    found = [spread(column, GROUP) for column in errors.T]
    return [value for one in found for value in (one.largest, one.average)]


def misfit(ours: Array) -> float:
    """Root mean square of ln(ours / thesis)."""
    return float(np.sqrt(np.mean(np.log(ours / THESIS) ** 2)))


def uneven(parameters: Array) -> dict[str, float]:
    """Unbounded search parameters as the pad's settings."""
    sigma, voids, correlation, fixed = parameters
    return {
        "sigma": float(np.exp(sigma)),
        "voids": float(1 / (1 + np.exp(-voids))),
        "correlation_cm": float(np.exp(correlation)),
        "fixed": float(1 / (1 + np.exp(-fixed))),
    }


def search(groups: int, seed: int) -> dict[str, float]:
    """Return the settings of least misfit; every trial sees the same random numbers."""
    pad = thesis_pad()
    trials = 0

    def objective(parameters: Array) -> float:
        nonlocal trials
        trials += 1
        settings = uneven(parameters)
        found = misfit(table(readings({**pad, "unevenness": settings}, groups, seed)))
        if trials % 20 == 1:
            shown = ", ".join(f"{k} {v:.3f}" for k, v in settings.items())
            print(f"trial {trials:4}: misfit {found:.4f}  ({shown})", flush=True)
        return found

    starts = [np.array([np.log(s), np.log(v / (1 - v)), np.log(c), f]) for s, v, c, f in STARTS]
    best = min(
        (minimize(objective, x, method="Nelder-Mead", options={"maxfev": 90}) for x in starts),
        key=lambda r: float(r.fun),
    )
    print(f"{trials} trials, least misfit {best.fun:.4f}")
    return uneven(best.x)


def show(ours: Array) -> None:
    """Print ours beside the thesis', and the ratio of the means of each column."""
    for name, mine, theirs in zip(PIPELINES, ours, THESIS, strict=True):
        print(f"\n{name:10} " + "".join(f"{c:>16}" for c in COLUMNS))
        for label, a, b in zip(OBJECTS, mine, theirs, strict=True):
            print(
                f"{label:10} " + "".join(f"{x:9.2f} /{y:5.1f}" for x, y in zip(a, b, strict=True))
            )
        ratio = mine.mean(axis=0) / theirs.mean(axis=0)
        print(f"{'ratio':10} " + "".join(f"{r:16.2f}" for r in ratio))
    print(f"\nours / thesis, in cm; root mean square of ln(ours/thesis): {misfit(ours):.3f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--check", action="store_true", help="measure the shipped pad only")
    parser.add_argument("--groups", type=int, default=4, help="groups of 20 readings a trial")
    arguments = parser.parse_args()
    warm_up()
    pad = thesis_pad()
    if not arguments.check:
        pad["unevenness"] = search(arguments.groups, seed=1)
        print("unevenness: " + str({k: round(v, 3) for k, v in pad["unevenness"].items()}))  # type: ignore[attr-defined]
    show(table(readings(pad, 25, seed=2)))


if __name__ == "__main__":
    main()
