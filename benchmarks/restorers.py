"""Restorers: energy against time, beside peers, all in one run.

Run ``python benchmarks/restorers.py``; some minutes. Every result, ours or a peer's, is scored by
the one energy of `tactile_graph_mrf.energy.total`: a truncated parabola, lambda 4, truncation 30,
200 levels. Up to `PROVED` cells the least energy is bounded by tree-reweighted messages. The
images: synthetic ones of 16 to 256 cells a side, the simulated pad, and frames of the bed mat and
of the capacitive panel, whole and 16 by 16 cells of them. gco-wrapper (``pip install gco-wrapper``;
``--gco`` names its folder, if not beside us) runs apart, for some costs abort the process; it is
left out where it is missing. scikit-image's filters minimise something else and are a reference
only. Times are processor time (all run in one thread), the least of a few runs, so that a machine
shared with others hurts little.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import warm_up
from tactile_graph.steps import Report
from tactile_graph.wires import Image
from tactile_graph_mrf.descent.gnc import gnc
from tactile_graph_mrf.descent.graph_cuts import graph_cuts
from tactile_graph_mrf.descent.icm import icm
from tactile_graph_mrf.descent.mean_field import mean_field
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.descent.trw import trw
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.total import energy
from tactile_graph_mrf.samplers.gibbs import gibbs
from tactile_graph_sources.recording import recording
from tactile_graph_sources.simulate import simulate

DATA = Path(__file__).parents[1].parent / "shared/data"
MODEL = Model(smoothness="truncated_quadratic", lines="none")
METRIC = Model(smoothness="truncated_absolute", lambda_d=60.0, lines="none")
PROVED = 64 * 64
SLOW = 32 * 32
GCO = """
import sys, time, json, numpy as np
sys.path.insert(0, sys.argv[1])
import gco
data = np.load(sys.argv[2])
x = np.arange(len(data["smooth"]))
unary = np.rint((data["observed"][..., None] - x) ** 2).astype(np.int32)
pair = np.rint(data["smooth"][np.abs(x[:, None] - x)]).astype(np.int32)
start = time.process_time()
labels = gco.cut_grid_graph_simple(unary, pair, n_iter=-1, connect=4, algorithm=sys.argv[3])
print(json.dumps({"s": time.process_time() - start, "labels": labels.tolist()}))
"""
SCALES = (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1.0 / 200**2)
"""Energy scales of the thesis' sampler: from squared levels to squares of the range."""
Array = NDArray[np.float64]
Scenes = Iterable[tuple[str, Image]]
Run = Callable[[Problem], tuple[float, float, float | None]]
"""Returns seconds, energy and, where there is one, a bound."""


def piecewise(size: int) -> Array:
    """A raised square and a disc on a floor, in levels."""
    truth = np.full((size, size), 40.0)
    truth[size // 8 : size // 2, size // 8 : size // 2] = 160.0
    i, j = np.indices(truth.shape)
    truth[(i - 0.7 * size) ** 2 + (j - 0.65 * size) ** 2 < (0.2 * size) ** 2] = 100.0
    return truth


def images(sizes: list[int]) -> Iterator[tuple[str, Image]]:
    rng = np.random.default_rng(0)
    for size, sigma in [*((size, 20.0) for size in sizes), (16, 40.0)]:
        noise = sigma * rng.standard_normal((size, size))
        yield (
            f"synthetic {size}, noise {sigma:g}",
            Image(np.clip(np.rint(piecewise(size) + noise), 0, 199)),
        )
    for frame in simulate(scene="bayes", frames=3, rng=rng, report=Report()):
        yield f"pad, {frame.truth[0].name}", frame.image
    for name in ("popu_bed", "capcontact"):
        folder = DATA / name
        paths = sorted(folder.glob("*.json" if name == "popu_bed" else "*.npz"))
        for path in paths[1:8:6]:
            sensor = "" if name == "popu_bed" else "cap"
            frames = recording(path=path, sensor=sensor, report=Report())
            first = [frame.image for frame, _ in zip(frames, range(50), strict=False)]
            whole = max(first, key=lambda image: image.total)
            yield f"{name}/{path.stem}", whole
            yield f"{name}/{path.stem}, 16x16 of it", densest(whole)


def densest(image: Image, size: int = 16) -> Image:
    """The part of so many cells a side that bears most."""
    sums = np.pad(np.maximum(image.filled(0.0), 0.0), ((1, 0), (1, 0))).cumsum(0).cumsum(1)
    n = size
    loads = sums[n:, n:] - sums[:-n, n:] - sums[n:, :-n] + sums[:-n, :-n]
    i, j = np.unravel_index(int(np.argmax(loads)), loads.shape)
    return Image(np.ascontiguousarray(image.values[i : i + n, j : j + n]))


def ours(step: Callable[..., object], best_of: int = 3, **settings: object) -> Run:
    def run(problem: Problem) -> tuple[float, float, float | None]:
        spent = []
        small = problem.in_field.size <= 16 * 16
        for _ in range(10 * best_of if small and best_of > 1 else best_of):
            start = time.process_time()
            given = step(problem.image, model=problem.model, **settings)
            spent.append(time.process_time() - start)
        return min(spent), given.energy, getattr(given, "bound", None)  # type: ignore[attr-defined]

    return run


def filtered(smooth: Callable[[Array], Array]) -> Run:
    def run(problem: Problem) -> tuple[float, float, float | None]:
        unit = problem.observed / (problem.n_levels - 1)
        start = time.process_time()
        values = smooth(unit)
        spent = time.process_time() - start
        top = problem.n_levels - 1
        labels = np.clip(np.rint(values * top), 0, top).astype(np.int64)
        return spent, energy(problem, labels), None

    return run


def gco(folder: str, algorithm: str = "swap") -> Run:
    def run(problem: Problem) -> tuple[float, float, float | None]:
        with tempfile.TemporaryDirectory() as where:
            file = str(Path(where) / "problem.npz")
            np.savez(file, observed=problem.observed, smooth=problem.pairwise.smooth)
            done = subprocess.run(
                [sys.executable, "-c", GCO, folder, file, algorithm],
                capture_output=True, text=True, check=False, timeout=300,
            )  # fmt: skip
        if done.returncode:
            raise RuntimeError(done.stderr.strip().splitlines()[-1:] or "aborted")
        found = json.loads(done.stdout)
        labels = np.array(found["labels"]).reshape(problem.shape)
        return found["s"], energy(problem, labels), None

    return run


def pymaxflow(problem: Problem) -> tuple[float, float, float | None]:
    """Expansions of PyMaxflow; three cycles of its swaps took 34 s on 256 cells: not run."""
    from maxflow import fastmin

    x = np.arange(problem.n_levels)
    unary, pair = problem.own_costs(), problem.pairwise.smooth[np.abs(x[:, None] - x)]
    start = time.process_time()
    labels = np.asarray(fastmin.aexpansion_grid(unary, pair), np.int64)
    return time.process_time() - start, energy(problem, labels), None


def contestants(gco_folder: str) -> dict[str, tuple[Run, int]]:
    """Return each method and the number of cells up to which it is run."""
    from skimage.restoration import denoise_bilateral, denoise_tv_chambolle

    rng = np.random.default_rng(0)
    big = 10**9
    annealed = {"temperature": 2e4, "cooling": 0.96, "n_sweeps": 300, "rng": rng}
    return {
        "restore": (ours(restore), big),
        "restore, effort 2": (ours(restore, effort=2), big),
        "restore, effort 3": (ours(restore, 1, effort=3), 128 * 128),
        "gnc": (ours(gnc, 1), big),
        "icm": (ours(icm, 1), big),
        "mean_field": (ours(mean_field, 1), 64 * 64),
        "gibbs, 300 sweeps from 2e4": (ours(gibbs, 1, **annealed), 64 * 64),
        "trw, 30 sweeps": (ours(trw, 1), PROVED),
        "graph_cuts, swap": (ours(graph_cuts, 1, n_cycles=100), SLOW),
        "gco swap": (gco(gco_folder), SLOW),
        "skimage TV": (filtered(lambda x: denoise_tv_chambolle(x, weight=0.2)), big),
        "skimage bilateral": (
            filtered(lambda x: denoise_bilateral(x, sigma_color=0.2, sigma_spatial=1.5)), big,
        ),
    }  # fmt: skip


def cutters(gco_folder: str) -> dict[str, tuple[Run, int]]:
    """Return the contestants where expansion moves are submodular."""
    return {
        "restore": (ours(restore), 10**9),
        "graph_cuts, expansion": (ours(graph_cuts, 1), SLOW),
        "PyMaxflow aexpansion_grid": (pymaxflow, SLOW),
        "gco expansion": (gco(gco_folder, "expansion"), SLOW),
        "gco swap": (gco(gco_folder), SLOW),
        "icm": (ours(icm, 1), 10**9),
        "trw, 30 sweeps": (ours(trw, 1), SLOW),
    }


def race(model: Model, scenes: Scenes, rivals: dict[str, tuple[Run, int]], plot: str) -> None:
    points: dict[str, list[tuple[float, float]]] = {name: [] for name in rivals}
    for title, image in scenes:
        problem = prepare(model, image)
        size = image.rows * image.columns
        found: dict[str, tuple[float, float]] = {}
        bound = None
        for name, (run, most) in rivals.items():
            if size > most:
                continue
            try:
                spent, reached, proof = run(problem)
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                print(f"    {name}: left out, {error}")
                continue
            found[name] = spent, reached
            bound = proof if proof is not None else bound
        least = min(reached for _, reached in found.values())
        proved = "" if bound is None else f", none below {bound:.1f} ({least / bound - 1:.1e})"
        print(f"\n{title}, {image.rows}x{image.columns}: best {least:.1f}{proved}")
        own = found["restore"][0]
        for name, (spent, reached) in found.items():
            above = 100.0 * (reached / least - 1.0)
            points[name].append((1e9 * spent / size, above))
            cost = f"{1e3 * spent:11.2f} ms{spent / own:9.1f} x{1e9 * spent / size:10.0f} ns/cell"
            print(f"  {name:30}{cost}{reached:14.1f}{above:10.4f} % above best")
    if plot:
        draw(points, plot)


def draw(points: dict[str, list[tuple[float, float]]], plot: str) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(10, 5), layout="constrained")
    for (name, dots), marker in zip(points.items(), "osD^v<>Pp*Xh", strict=False):
        if dots:
            x, y = np.array(dots).T
            axes.plot(x, np.maximum(y, 1e-4), marker, label=name, alpha=0.8)
    axes.set(xscale="log", yscale="log", xlabel="time, ns per cell", ylabel="energy above best, %")
    figure.legend(fontsize=8, loc="outside right upper")
    figure.savefig(plot, dpi=120)
    print(f"\nplot: {plot}")


def thesis_sampler(scenes: Scenes) -> None:
    """Print the time of the thesis' 110 sweeps with lines, at several scales of the energy."""
    print("\nGibbs sampler, explicit lines, 200 levels, T0 = 5, T <- 0.9 T, at most 110 sweeps:")
    print(f"  {'':28}" + "".join(f"  scale {scale:<8g}" for scale in SCALES))
    for title, image in scenes:
        cells = []
        for scale in SCALES:
            spent = []
            for _ in range(15):
                rng = np.random.default_rng(1)
                start = time.process_time()
                done = gibbs(image, rng=rng, model=Model(), energy_scale=scale)
                spent.append(time.process_time() - start)
            cells.append(f"{1e3 * min(spent):6.2f} ms {done.sweeps:4}")
        print(f"  {title:28}" + "  ".join(cells))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=[16, 32, 64, 128, 256])
    parser.add_argument("--gco", default="", help="folder gco-wrapper is installed in")
    parser.add_argument("--plot", default="restorers.png")
    chosen = parser.parse_args()
    warm_up()
    small = Image(np.arange(16.0).reshape(4, 4))
    for step in (restore, gnc, icm, mean_field, trw, graph_cuts):
        step(small, model=MODEL)  # compiles
    gibbs(small, model=MODEL, rng=np.random.default_rng(0), n_sweeps=2)
    race(MODEL, images(chosen.sizes), contestants(chosen.gco), chosen.plot)
    print("\nTruncated absolute differences, which expansion moves allow:")
    race(METRIC, list(images([16, 32]))[:5], cutters(chosen.gco), "")
    thesis_sampler([scene for scene in images([16]) if scene[1].shape == (16, 16)][:5])


if __name__ == "__main__":
    main()
