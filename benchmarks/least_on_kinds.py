"""The least error possible on each kind of pad that nobody described, were all of it known.

Run with ``python benchmarks/least_on_kinds.py`` (an hour and a half on one core; ``--workers N``
shares the kinds among processes, ``--kinds`` takes some only, ``--scenes N`` so many of each);
``--shape rectangle`` takes rectangles instead of discs, ``--markdown FILE`` writes the table.

The frames are those of `unknown_pads`. The bound is told what no localiser is: the kind's law,
turn-on, saturation, gains, voids, strays, noise and steps, the face's pressure, and which elements
are dead or stuck. It is the posterior mean by Markov chains (Metropolis, steps of four lengths, one
chain from the truth and one from ``locate``'s answer), under a likelihood written anew here from
the simulator's own definition: none of the project's geometry or likelihood is in it. Beforehand
any place is likely at which the simulator puts an object, and log-uniform sizes and loads. No
estimate errs less in the mean square; in the mean, chance may bring one a few per cent below it.

Left out are kinds whose elements are not independent, given the load: gains that are alike nearby
or by row, and foam, which blurs gains and voids.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
from by_workers import add_workers, in_order
from numpy.typing import NDArray
from second_simulator import BIAS_OHM, KINDS, SUPPLY_V, Bench, Kind, Outline
from unknown_pads import BENCH_FRAMES, Asked, Off, off, table

from tactile_graph import Circle, Frame, Rectangle, load
from tactile_graph.compiled import warm_up

Values = NDArray[np.float64]
DEPENDENT = ("gains correlated", "gains by row", "foam 0.6 cells")
FACES = ("even", "leaning", "round_face", "hollow")
"""Names of the simulator's pressures, in the order that `pressure` numbers them."""
SMALLEST_CM, LARGEST_CM = 0.5, 15.0
STRIPS = 20
"""Lines across an element on which it is found how much of it is covered."""
OFF, ON, FULL, SILENT = range(4)
"""What an element reads: nothing, a load, as much as it can, or nothing that says anything."""
LENGTHS = (0.3, 1.0, 1.0, 3.0)
"""Of steps, over what suits a normal distribution."""


class Known(NamedTuple):
    """What the likelihood of a frame is told; arrays have the pad's shape.

    ``low`` and ``high`` are logarithms of the least and most load that a reading may mean, equal
    where it means one; ``extra`` is the deviation that the noise of the reading adds to the
    logarithm; ``numbers`` are pitch, element's side, sigma, voids, strays and turn-on; ``face``
    numbers the pressure.
    """

    state: NDArray[np.int64]
    low: Values
    high: Values
    extra: Values
    dull: Values
    numbers: Values
    face: int


def known(kind: Kind, bench: Bench, frame: Frame) -> Known:
    """Return what a frame says to somebody who knows its pad."""
    volts = np.asarray(frame.image.values, np.float64)
    half = 0.5 * kind.step_v
    total = SUPPLY_V - volts.sum(axis=0)

    def log_load(some: Values) -> Values:
        """Of a divider whose column draws what it draws in the frame."""
        conductance_s = np.maximum(some, 1e-12) / BIAS_OHM / total
        return np.log(100.0) + np.log(conductance_s * 80e3) / kind.exponent

    logs = log_load(volts)
    noise_v = math.hypot(kind.noise_v, kind.offset_v / math.sqrt(3.0))
    shows_v = SUPPLY_V * (kind.turn_on_g / 100.0) ** kind.exponent / 80e3 * BIAS_OHM
    shows_v = shows_v * total / SUPPLY_V
    on = volts > max(half, 1e-9)
    state = np.where(on, ON, OFF)
    state[on & (logs > math.log(kind.saturation_g) - 0.02)] = FULL
    state[bench.dead | bench.stuck] = SILENT
    seen_v = np.maximum(volts, 0.5 * shows_v)
    extra = noise_v / seen_v / kind.exponent
    dull = np.zeros(volts.shape)
    if noise_v > 0.0 and not half:
        dull = kind.exponent * volts * np.exp(-0.5 * (volts / noise_v) ** 2)
        dull = np.maximum(dull, 0.0) / (noise_v * math.sqrt(2.0 * math.pi))
    low, high = log_load(np.maximum(volts - half, 1e-9)), log_load(volts + half)
    numbers = np.array([
        kind.pitch_cm, kind.element_cm, kind.sigma, kind.voids, kind.strays, kind.turn_on_g
    ])  # fmt: skip
    return Known(state, low, high, extra, dull, numbers, FACES.index(kind.pressure.__name__))


@numba.njit
def pressure(face: int, u: float, v: float) -> float:
    if face == 1:
        return max(1.0 + 0.7 * (0.8 * u + 0.6 * v), 0.0)
    if face == 2:
        return math.sqrt(max(1.0 - u * u - v * v, 0.0))
    if face == 3:
        return 1.0 if u * u + v * v >= 0.36 else 0.0
    return 1.0


@numba.njit
def chord(p: Values, y: float) -> tuple[float, float]:
    """Return where a line at ``y`` enters and leaves the outline; the same place if it does not."""
    dy = y - p[1]
    if p.shape[0] == 4:
        root = p[2] * p[2] - dy * dy
        return (p[0], p[0]) if root <= 0.0 else (p[0] - math.sqrt(root), p[0] + math.sqrt(root))
    cos, sin = math.cos(p[4]), math.sin(p[4])
    low, high = -1e9, 1e9
    for along, off_, half in ((cos, -sin * dy, p[2]), (sin, cos * dy, p[3])):
        if abs(along) < 1e-12:
            if abs(off_) > half:
                return p[0], p[0]
            continue
        one, other = (-half - off_) / along, (half - off_) / along
        low, high = max(low, min(one, other)), min(high, max(one, other))
    return (p[0], p[0]) if high <= low else (p[0] + low, p[0] + high)


@numba.njit
def place_in(p: Values, x: float, y: float) -> tuple[float, float]:
    """Return a point's place in the object, of the length 1 at its rim."""
    dx, dy = x - p[0], y - p[1]
    if p.shape[0] == 4:
        return dx / p[2], dy / p[2]
    cos, sin = math.cos(p[4]), math.sin(p[4])
    u, v = (dx * cos - dy * sin) / p[2], (dx * sin + dy * cos) / p[3]
    far = math.hypot(u, v)
    to_rim = max(abs(u), abs(v)) / far if far > 0.0 else 1.0
    return u * to_rim, v * to_rim


@numba.njit
def share(p: Values, x0: float, y0: float, side: float, face: int) -> float:
    """Return the mean pressure of the outline on an element."""
    total = 0.0
    for i in range(STRIPS):
        y = y0 + side * (i + 0.5) / STRIPS
        left, right = chord(p, y)
        if face == 0:
            total += max(min(right, x0 + side) - max(left, x0), 0.0) / side
            continue
        for j in range(STRIPS):
            x = x0 + side * (j + 0.5) / STRIPS
            if left < x < right:
                u, v = place_in(p, x, y)
                total += pressure(face, u, v) / STRIPS
    return total / STRIPS


@numba.njit
def below(z: float) -> float:
    return 0.5 * math.erfc(-z * math.sqrt(0.5))


@numba.njit
def reading(known: Known, i: int, j: int, mean: float) -> float:
    """Return the log likelihood of an element's reading; ``mean`` is its load but for its gain."""
    sigma, voids, strays, turn_on = known.numbers[2:6]
    state, low, high = known.state[i, j], known.low[i, j], known.high[i, j]
    extra, mu = known.extra[i, j], math.log(max(mean, 1e-12))
    wide, shown, stray = math.hypot(sigma, extra), 0.0, 0.0
    none = 1.0
    if mean > 0.0:
        none = voids + (1.0 - voids) * below((math.log(turn_on) - mu) / sigma)
    if state == OFF:
        return math.log((1.0 - strays) * none)
    if state == FULL:
        shown = below((mu - high) / sigma)
    elif high > low + 1e-9:
        low = max(low, math.log(turn_on) - 0.1)
        shown = below((high - mu) / wide) - below((low - mu) / wide)
        stray = max(math.exp(high) - math.exp(low), 0.0) / (19.0 * turn_on)
    else:
        z = (low - mu) / wide
        shown = math.exp(-0.5 * z * z) / (wide * math.sqrt(2.0 * math.pi))
        shown *= below((low - math.log(turn_on)) / max(extra, 0.01))
        stray = math.exp(low) / (19.0 * turn_on) if low < math.log(21.0 * turn_on) else 0.0
    shown = (1.0 - strays) * (1.0 - voids) * shown if mean > 0.0 else 0.0
    read = shown + strays * stray + (1.0 - strays) * none * known.dull[i, j]
    return math.log(max(read, 1e-300))


@numba.njit
def log_likelihood(known: Known, p: Values) -> float:
    """Return the log likelihood of a frame; ``p`` ends with a fully covered element's log load."""
    pitch, side = known.numbers[0], known.numbers[1]
    scale, total = math.exp(p[p.shape[0] - 1]), 0.0
    reach = side + (p[2] if p.shape[0] == 4 else math.hypot(p[2], p[3]))
    for i in range(known.state.shape[0]):
        for j in range(known.state.shape[1]):
            if known.state[i, j] == SILENT:
                continue
            x, y = j * pitch, i * pitch
            far = max(abs(x + 0.5 * side - p[0]), abs(y + 0.5 * side - p[1]))
            its = share(p, x, y, side, known.face) if far < reach else 0.0
            total += reading(known, i, j, scale * its)
    return total


@numba.njit
def log_prior(p: Values, size: Values, whole: bool) -> float:
    """Return the log density of an outline: uniform places, log-uniform sizes and loads."""
    n = p.shape[0] - 1
    sizes, total = (3 if n == 3 else 4), 0.0
    for m in range(2, sizes):
        if not SMALLEST_CM < p[m] < LARGEST_CM:
            return -math.inf
        total -= math.log(p[m])
    wide = high = p[2]
    if n > 3:
        cos, sin = abs(math.cos(p[4])), abs(math.sin(p[4]))
        wide, high = p[2] * cos + p[3] * sin, p[2] * sin + p[3] * cos
    if not whole:
        wide = high = 0.0
    # A place that the simulator draws: uniform over what the size leaves.
    across, down = size[0] - 2.0 * wide, size[1] - 2.0 * high
    if across <= 0.0 or down <= 0.0:
        return -math.inf
    if not (wide <= p[0] <= size[0] - wide and high <= p[1] <= size[1] - high):
        return -math.inf
    return total - math.log(across * down)


@numba.njit
def chain(
    known: Known, start: Values, root: Values, size: Values, whole: bool, steps: int, seed: int
) -> Values:
    """Return the mean of a Metropolis chain after its first fifth."""
    np.random.seed(seed)  # noqa: NPY002
    p, n = start.copy(), start.shape[0]
    mean, kept = np.zeros(n), 0
    now = log_prior(p, size, whole)
    if now > -math.inf:
        now += log_likelihood(known, p)
    for t in range(steps):
        length = 2.0 / math.sqrt(n) * LENGTHS[np.random.randint(4)]  # noqa: NPY002
        trial = p + length * (root @ np.random.standard_normal(n))  # noqa: NPY002
        new = log_prior(trial, size, whole)
        if new > -math.inf:
            new += log_likelihood(known, trial)
        if math.log(np.random.random()) < new - now:  # noqa: NPY002
            p, now = trial, new
        if 5 * t >= steps:
            mean += p
            kept += 1
    return mean / kept


def point(shape: Outline, log_load: float, near_rad: float) -> Values:
    """Return an outline as the chains take it, its angle near another."""
    if isinstance(shape, Circle):
        return np.array([shape.x_cm, shape.y_cm, shape.radius_cm, log_load])
    angle = near_rad + math.remainder(shape.angle_rad - near_rad, math.pi)
    halves = 0.5 * shape.length_cm, 0.5 * shape.breadth_cm
    return np.array([shape.x_cm, shape.y_cm, *halves, angle, log_load])


def least(kind: Kind, bench: Bench, frame: Frame, answer: Any, steps: int) -> Outline:
    """Return the shape of the posterior mean."""
    assert frame.truth is not None
    true, weight_g = frame.truth[0].shape, frame.truth[0].weight_g
    assert isinstance(true, Circle | Rectangle)
    assert weight_g is not None
    told = known(kind, bench, frame)
    near = getattr(true, "angle_rad", 0.0)
    area = true.area_cm2 * kind.element_cm**2 / kind.pitch_cm**2
    log_load = math.log(weight_g * kind.element_cm**2 / area)
    starts = [point(true, log_load, near)]
    if isinstance(answer, type(true)):
        starts.append(point(answer, log_load, near))
    n, deviation_cm = len(starts[0]), 0.07
    if (posterior := getattr(answer, "posterior", None)) is not None:
        deviation_cm = min(max(posterior.centre_std_cm, 0.03), 0.5)
    spread = np.full(n, deviation_cm)
    if isinstance(true, Rectangle):
        spread[4] /= 0.5 * true.length_cm
    size = np.array([m * kind.pitch_cm - kind.gap_cm for m in (kind.columns, kind.rows)])
    whole = not kind.over_edge
    means = [
        chain(told, start, np.diag(spread), size, whole, steps, seed)
        for seed, start in enumerate(starts)
    ]
    mean = np.mean(means, axis=0)
    if n == 4:
        return Circle(*mean[:3])
    return Rectangle(mean[0], mean[1], 2.0 * mean[2], 2.0 * mean[3], mean[4])


class Scores(NamedTuple):
    """Mean errors on a kind: the bound's, ``locate``'s and the thesis' third localiser's."""

    bound: Off
    locate: Off
    third: Off


def scores(asked: Asked, steps: int, kind: str) -> Scores:
    """Return the errors on a kind of pad."""
    shape = "circle" if asked.shape == "disc" else "rectangle"
    runs = [load(f"{name}-{last}").runner() for name, last in (("locate", shape), (shape, "3"))]
    rng = np.random.default_rng([asked.seed, *kind.encode()])
    found: list[list[Off]] = [[], [], []]
    while len(found[0]) < asked.n_scenes:
        bench = Bench(KINDS[kind], rng)
        for frame in bench.frames(BENCH_FRAMES, asked.shape):
            if len(found[0]) == asked.n_scenes:
                break
            true: Any = (frame.truth or ())[0].shape
            answers = [run(frame).get(shape) for run in runs]
            bound = least(KINDS[kind], bench, frame, answers[0], steps)
            for errors, answer in zip(found, (bound, *answers), strict=True):
                errors.append(
                    off(answer, true)
                    if isinstance(answer, Circle | Rectangle)
                    else Off(math.nan, math.nan, math.nan)
                )
    return Scores(*(mean_of(errors) for errors in found))


def mean_of(errors: Sequence[Off]) -> Off:
    """Return the mean of errors, without frames that have no answer."""
    answered = [its for its in errors if not math.isnan(its.centre_cm)]
    return Off(*np.mean(np.array(answered or errors), axis=0))


def cells(errors: Off, over: Off | None = None) -> str:
    """Return errors as text, or their ratios to others."""
    some = errors if over is None else [a / b for a, b in zip(errors, over, strict=True)]
    form = "{:.3f}" if over is None else "{:.2f}"
    return " / ".join(form.format(number) for number in some if not math.isnan(number))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--shape", choices=("disc", "rectangle"), default="disc")
    parser.add_argument("--scenes", type=int, default=120, help="of each kind")
    parser.add_argument("--seed", type=int, default=241)
    parser.add_argument("--steps", type=int, default=6000, help="of each chain")
    kinds = [kind for kind in KINDS if kind not in DEPENDENT]
    parser.add_argument("--kinds", nargs="*", choices=kinds, default=kinds, metavar="KIND")
    parser.add_argument("--markdown", type=Path)
    add_workers(parser)
    args = parser.parse_args()
    warm_up()
    work = partial(scores, Asked(args.shape, args.scenes, args.seed), args.steps)
    found: Sequence[Scores] = in_order(work, args.kinds, args.workers)
    third = "circle-3" if args.shape == "disc" else "rectangle-3"
    head = ("pad", "least, cm", "`locate` over it", f"`{third}` over it", f"least over `{third}`")
    rows = [
        [kind, cells(s.bound), cells(s.locate, s.bound), cells(s.third, s.bound),
         cells(s.bound, s.third)]
        for kind, s in zip(args.kinds, found, strict=True)
    ]  # fmt: skip
    text = table(head, rows)
    print(text)
    if args.markdown:
        args.markdown.write_text(text + "\n")


if __name__ == "__main__":
    main()
