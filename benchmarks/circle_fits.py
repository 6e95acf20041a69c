"""Circle fits: error against arc length, and time a fit, beside SciPy's and scikit-image's.

Run ``python benchmarks/circle_fits.py``; under a minute. ``--points``, ``--noise`` (of the radius
100) and ``--rounds`` change the arcs. Radii are medians, with the share of arcs a method gave up.
"""

from __future__ import annotations

import argparse
import platform
import statistics
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import warm_up
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_fitters.circle.fit_circle_hyper import fit_circle_hyper
from tactile_graph_fitters.circle.fit_circle_kasa import fit_circle_kasa
from tactile_graph_fitters.circle.fit_circle_taubin import fit_circle_taubin
from tactile_graph_fitters.circle.fit_circle_thesis import fit_circle_thesis

Fit = Callable[[NDArray[np.float64]], tuple[float, float, float]]
RADIUS = 100.0
DEGREES = (5, 15, 30, 60, 180, 360)
OURS = (fit_circle, fit_circle_thesis, fit_circle_kasa, fit_circle_taubin, fit_circle_hyper)


def ours(step: Callable[..., object]) -> Fit:
    def fit(xy: NDArray[np.float64]) -> tuple[float, float, float]:
        circle = step(Points(xy))
        return circle.x_cm, circle.y_cm, circle.radius_cm

    return fit


def scipy_fit() -> Fit:
    from scipy.optimize import least_squares

    def fit(xy: NDArray[np.float64]) -> tuple[float, float, float]:
        x, y = xy.T
        mean = xy.mean(axis=0)
        start = [*mean, np.hypot(x - mean[0], y - mean[1]).mean()]
        found = least_squares(
            lambda p: np.hypot(x - p[0], y - p[1]) - p[2], start, method="lm", max_nfev=2000
        )
        if not found.success:
            raise Degenerate("least_squares did not settle")
        return tuple(map(float, found.x))

    return fit


def skimage_fit() -> Fit:
    from skimage.measure import CircleModel

    def fit(xy: NDArray[np.float64]) -> tuple[float, float, float]:
        if hasattr(CircleModel, "from_estimate"):  # scikit-image 0.26 on
            model = CircleModel.from_estimate(xy)
            found = (*model.center, model.radius) if model else None
        else:
            model = CircleModel()
            found = model.params if model.estimate(xy) else None
        if found is None:
            raise Degenerate("CircleModel gave none")
        x, y, radius = map(float, found)
        return x, y, radius

    return fit


def all_fits() -> dict[str, Fit]:
    fits = {step.__name__: ours(step) for step in OURS}
    fits["scipy least_squares"] = scipy_fit()
    try:
        fits["skimage CircleModel"] = skimage_fit()
    except ImportError as error:
        print(f"left out: skimage CircleModel ({error})")
    return fits


def arcs(degrees: float, n: int, noise: float, rounds: int) -> list[NDArray[np.float64]]:
    rng = np.random.default_rng(int(degrees))
    made = []
    for _ in range(rounds):
        angle = np.radians(rng.random(n) * degrees)
        xy = np.column_stack([np.cos(angle), np.sin(angle)]) * RADIUS
        made.append(xy + rng.normal(0.0, noise, xy.shape))
    return made


def accuracy(fits: dict[str, Fit], n: int, noise: float, rounds: int) -> None:
    print(f"\nMedian radius (median centre error), truth {RADIUS:g}; {n} points, noise {noise:g}")
    print(f"{'arc, degrees':22}" + "".join(f"{d:>20}" for d in DEGREES))
    sets = {d: arcs(d, n, noise, rounds) for d in DEGREES}
    for name, fit in fits.items():
        cells = []
        for d in DEGREES:
            # A peer that needs milliseconds a fit gets fewer arcs: its median is stable enough.
            chosen = sets[d][: rounds if name.startswith("fit_") else max(rounds // 4, 1)]
            found = []
            for xy in chosen:
                try:
                    found.append(fit(xy))
                except Degenerate:
                    continue
            given_up = 1.0 - len(found) / len(chosen)
            if not found:
                cells.append("gave up")
                continue
            x, y, radius = np.array(found).T
            text = f"{np.median(radius):.2f} ({np.median(np.hypot(x, y)):.2f})"
            cells.append(text + (f" -{given_up:.0%}" if given_up else ""))
        print(f"{name:22}" + "".join(f"{c:>20}" for c in cells))


def speed(fits: dict[str, Fit], rounds: int = 9) -> None:
    sizes = (20, 50, 1500, 100_000)
    print("\nMicroseconds a fit, full circle, median over rounds (ratio to fit_circle)")
    print(f"{'points':22}" + "".join(f"{n:>20}" for n in sizes))
    base: dict[int, float] = {}
    for name, fit in fits.items():
        cells = []
        for n in sizes:
            xy = arcs(360, n, 2.0, 1)[0]
            fit(xy)
            start = time.perf_counter()
            fit(xy)
            repeats = max(1, int(0.02 / (time.perf_counter() - start)))
            taken = []
            for _ in range(rounds):
                start = time.perf_counter()
                for _ in range(repeats):
                    fit(xy)
                taken.append((time.perf_counter() - start) / repeats * 1e6)
            median = statistics.median(taken)
            base.setdefault(n, median)
            cells.append(f"{median:.1f} ({median / base[n]:.1f})")
        print(f"{name:22}" + "".join(f"{c:>20}" for c in cells))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=50)
    parser.add_argument("--noise", type=float, nargs="*", default=[2.0, 0.02])
    parser.add_argument("--rounds", type=int, default=400)
    options = parser.parse_args()
    warm_up()
    print(f"Python {platform.python_version()}, NumPy {np.__version__}")
    fits = all_fits()
    for noise in options.noise:
        accuracy(fits, options.points, noise, options.rounds)
    speed(fits)


if __name__ == "__main__":
    main()
