"""circle-3 on one 16x16 frame: against scikit-image and OpenCV scripts, and the engine's own cost.

Run with ``python benchmarks/circle_frame.py``. Needs the ``bench`` extra for OpenCV; peers that
are not installed are left out. All contestants see the same two frames in turn (so that nothing
is reused), and all run in the same process, round by round. Times of frames are processor time:
what the engine adds is a small difference, which on a shared machine would drown otherwise.
"""

from __future__ import annotations

import itertools
import os
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parent))
from rounds import Timed, print_table
from suite_parts.rounds_of import in_turn

from tactile_graph import Frame, Pipeline, Result, load, loads
from tactile_graph.compiled import warm_up
from tactile_graph.inspect import Runner

LEVEL_V, PITCH_CM, ORIGIN_CM = 0.01, 1.3, -0.15
DISC5 = np.array(
    [[0, 0, 1, 0, 0], [0, 1, 1, 1, 0], [1, 1, 1, 1, 1], [0, 1, 1, 1, 0], [0, 0, 1, 0, 0]], np.uint8
)
Values = NDArray[np.float64]
Circle = tuple[float, float, float]


def frames() -> list[Frame]:
    """Two frames of the second disc of table 4.2, from the bundled recording."""
    found = [f for f in load("circle-3").frames() if f.index % 3 == 1]
    return found[:2]


def fit_circle_numpy(xy: Values) -> Circle:
    """Algebraic (Kåsa) fit by least squares: the cheapest a script would write."""
    a = np.column_stack([xy, np.ones(len(xy))])
    p, q, r = np.linalg.lstsq(a, (xy * xy).sum(axis=1), rcond=None)[0]
    x, y = p / 2, q / 2
    return float(x), float(y), float(np.sqrt(r + x * x + y * y))


def to_cm(points: Values) -> Values:
    return ORIGIN_CM + (points + 0.5) * (PITCH_CM / 2)


def opencv_script() -> Callable[[Values], Circle]:
    import cv2

    def script(values: Values) -> Circle:
        mask = (values >= LEVEL_V).view(np.uint8)
        fine = cv2.resize(mask, None, fx=2, fy=2, interpolation=cv2.INTER_NEAREST)
        eroded = cv2.erode(fine, DISC5, borderType=cv2.BORDER_CONSTANT, borderValue=0)
        dilated = cv2.dilate(eroded, DISC5)
        contours, _ = cv2.findContours(dilated, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        hull = cv2.convexHull(np.vstack(contours))
        return fit_circle_numpy(to_cm(hull[:, 0, :].astype(np.float64)))

    return script


def skimage_script() -> Callable[[Values], Circle]:
    from skimage.measure import CircleModel
    from skimage.morphology import convex_hull_image, dilation, erosion
    from skimage.segmentation import find_boundaries

    del convex_hull_image
    from scipy.spatial import ConvexHull

    def script(values: Values) -> Circle:
        fine = np.kron(values >= LEVEL_V, np.ones((2, 2))).astype(np.uint8)
        opened = dilation(erosion(fine, DISC5, mode="constant", cval=0), DISC5)
        rows, columns = np.nonzero(find_boundaries(opened, mode="inner"))
        xy = to_cm(np.column_stack([columns, rows]).astype(np.float64))
        model = CircleModel.from_estimate(xy[ConvexHull(xy).vertices])
        return float(model.center[0]), float(model.center[1]), float(model.radius)

    return script


def cycled(call: Callable[[object], object], inputs: list[object]) -> Callable[[], object]:
    source: Iterator[object] = itertools.cycle(inputs)
    return lambda: call(next(source))


def unguarded() -> Pipeline:
    """circle-3 without its three conditions."""
    text = re.sub(r", when: [^}]*", "", load("circle-3").text)
    return loads(text)


def by_hand(guards: bool) -> Callable[[Frame], object]:
    """The same step functions and conditions as a person would write them, without the engine."""
    pipeline = load("circle-3")
    steps = {n: node.bound() for n, node in pipeline.nodes.items()}
    threshold, subdivide, erode, dilate = (
        steps[n] for n in ("footprint", "fine", "eroded", "dilated")
    )
    boundary, hull, fit = (steps[n] for n in ("boundary", "hull", "circle"))

    def call(frame: Frame) -> object:
        footprint = threshold(frame.image)
        if guards and not (footprint.count > 0 and footprint.fraction < 1):
            return None
        eroded = erode(subdivide(footprint))
        if guards and not eroded.count > 0:
            return None
        return fit(hull(boundary(dilate(eroded))).points)

    return call


def prepared(pipeline: Pipeline) -> Runner[Result]:
    """A runner with all its machine code, as `tactile-graph prepare` leaves it."""
    runner = pipeline.runner()
    runner.prepare()
    return runner


def alone(pipeline: Pipeline) -> Runner[Result]:
    """A runner that calls every step by itself."""
    return pipeline.runner().each_alone()


def empty_frames() -> list[Frame]:
    rng = np.random.default_rng(0)
    return [
        Frame.of(rng.uniform(0, 0.005, (16, 16)), PITCH_CM, (ORIGIN_CM,) * 2, "volt")
        for _ in range(2)
    ]


def one_frame() -> None:
    both, runner = frames(), prepared(load("circle-3"))
    images: list[object] = [f.image.values for f in both]
    ours = {
        # Not shown: whoever follows the scikit-image script is a quarter slower for it.
        "first": cycled(prepared(load("circle-3")), list(both)),  # type: ignore[arg-type]
        "tactile-graph, circle-3": cycled(runner, list(both)),  # type: ignore[arg-type]
        "each step by itself": cycled(alone(load("circle-3")), list(both)),  # type: ignore[arg-type]
        "the same steps by hand": cycled(by_hand(True), list(both)),  # type: ignore[arg-type]
        "without conditions, each by itself": cycled(
            alone(unguarded()),
            list(both),  # type: ignore[arg-type]
        ),
        "the same by hand": cycled(by_hand(False), list(both)),  # type: ignore[arg-type]
        "tactile-graph, an empty pad": cycled(
            prepared(load("circle-3")),
            list(empty_frames()),  # type: ignore[arg-type]
        ),
        "the same steps by hand, an empty pad": cycled(
            by_hand(True),
            list(empty_frames()),  # type: ignore[arg-type]
        ),
        "tactile-graph, the same frame again": lambda: runner(both[0]),
    }
    peers = {
        "OpenCV script": ("cv2", opencv_script),
        "scikit-image script": ("skimage", skimage_script),
    }
    for name, (module, make) in peers.items():
        if find_spec(module):
            ours[name] = cycled(make(), images)  # type: ignore[arg-type]
    print("One 16x16 frame with a disc; answers (x, y, radius in cm):")
    circle = runner(both[0])["circle"]
    print(f"  tactile-graph  {circle.x_cm:.3f} {circle.y_cm:.3f} {circle.radius_cm:.3f}")
    for name, (module, make) in peers.items():
        if find_spec(module):
            x, y, r = make()(both[0].image.values)
            print(f"  {name.split()[0]:14} {x:.3f} {y:.3f} {r:.3f}")
    spent_us = in_turn(ours, rounds=101, round_s=0.005, most_s=1.0)
    times = {name: Timed(name, rounds) for name, rounds in spent_us.items() if name != "first"}
    print_table(times, "OpenCV script" if "OpenCV script" in times else "scikit-image script")
    full = times["each step by itself"]
    for what, with_it, without in (
        ("with its three conditions", "each step by itself", "the same steps by hand"),
        ("without conditions", "without conditions, each by itself", "the same by hand"),
    ):
        pairs = zip(times[with_it].rounds_us, times[without].rounds_us, strict=True)
        extra = statistics.median(a - b for a, b in pairs) / 7
        print(f"engine cost per node, {what}: {extra:.2f} us (7 nodes, target 0.6 us)")
    share, by_itself = (
        100 * times[name].ratio_to(full)[0]
        for name in ("tactile-graph, an empty pad", "the same steps by hand, an empty pad")
    )
    print(
        f"an empty pad takes {share:.1f} % of a full frame whose steps run by themselves "
        f"(target 10 %), by hand {by_itself:.1f} %"
    )
    spent = [runner(both[i % 2]).times_us for i in range(400)]
    medians = {n: statistics.median(t[n] for t in spent) for n in spent[0]}
    print("per node, us: " + ", ".join(f"{n} {t:.2f}" for n, t in medians.items()) + "\n")


def start_up(rounds: int = 15) -> None:
    """Whole-process time of ``--help`` over that of an interpreter that does nothing."""
    command = [sys.executable, "-m", "tactile_graph", "--help"]
    bare = [sys.executable, "-c", "pass"]
    extra = []
    for _ in range(rounds):
        spent = []
        for argv in (command, bare):
            start = time.perf_counter()
            subprocess.run(argv, check=True, stdout=subprocess.DEVNULL, env={**os.environ})
            spent.append(time.perf_counter() - start)
        extra.append(spent[0] - spent[1])
    print(f"--help over bare Python: {statistics.median(extra):.3f} s (target 0.12 s)")


if __name__ == "__main__":
    warm_up()
    one_frame()
    start_up()
