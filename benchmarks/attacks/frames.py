"""Attack pipelines with hostile frames: huge, tiny and missing numbers, odd shapes, absurd pitches.

    python benchmarks/attacks/frames.py                               # 2,000 tries, plain pipelines
    python benchmarks/attacks/frames.py --tries 30000 --pipelines all # an hour, kernels compiled

Each try draws values, shape, type, pitch and origin of a frame, each hostile or as the pipeline's
own source gives them. `Frame.of` may refuse it (`ValueError`), the pipeline may (`RuleError`), a
step may find it `Degenerate`; whatever else is raised, in a step too, is foreign. No value may hold
NaN or infinity, and its row must be JSON. After each tenth frame an ordinary one must get the
answer it gets alone. A frame may take 20 times as long as an ordinary one, and in proportion more
if it has more cells; one that takes longer is tried once more, for kernels may have been compiled.
Huge grids may so take hours, and are given up.
"""

from __future__ import annotations

import json
import math
import signal
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from types import FrameType
from typing import Any, NamedTuple

import numpy as np
from attempts import Attempt, parser_of, told
from numpy.typing import NDArray

from tactile_graph import Frame, Pipeline, load
from tactile_graph.api.result import Result
from tactile_graph.cli.output.writers import json_row
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.errors import TactileGraphError
from tactile_graph.plugins.registry import installed
from tactile_graph_stress.finite import not_finite

TIMES_SLOWER = 20.0
LEAST_S = 0.5
GIVEN_UP_S, COMPILED_S = 30.0, 150.0
MEASURED_S = 0.1
"""Of ordinary frames, or a clock that ticks in milliseconds tells nothing of them."""
COMPILED = ("likelihood", "locate", "adaptive", "bayes-objects", "by-order", "followed", "full",
            "identify", "tracks")  # fmt: skip
"""Parts of the names of pipelines whose kernels are compiled before their first answer, or which
read a database that has to be told."""
Values = NDArray[Any]


# -- hostile values ----------------------------------------------------------------------------

SHAPES = ((1, 1), (1, 2), (2, 1), (2, 2), (1, 40), (40, 1), (3, 3), (2, 300), (300, 2), (16, 16),
          (64, 64), (17, 5))  # fmt: skip
HUGE = ((500, 500), (2000, 2000))
PITCHES_CM = ((1e-6, 1e-6), (1e6, 1e6), (1e-6, 1e6), (0.01, 10.0), (1e-4, 1e-4), (100.0, 100.0),
              (0.0, 1.0), (math.nan, 1.0), (1e300, 1e300), (-1.0, 1.0))  # fmt: skip
ORIGINS_CM = ((1e300, 0.0), (1e17, -1e17), (-1e6, 1e6), (math.nan, 0.0), (0.0, math.inf))
TYPES = ("bool", "int8", "uint8", "int16", "uint16", "int64", "uint64", "float16", "float32",
         "longdouble", ">f8", ">i2", "object", "complex128", "U8")  # fmt: skip
EXTREMES = (math.nan, math.inf, -math.inf, 1e300, -1e300, 1e100, 9.9e99, -9.9e99, 1e50, 1e-50,
            1e-99, 1e-300, 5e-324, -5e-324, -0.0, 1e17, -1.0, 65504.0, 2.0**63)  # fmt: skip


def sprinkled(values: Values, rng: np.random.Generator) -> Values:
    """Put extremes, of one kind or of many, in some cells."""
    kinds = rng.choice(EXTREMES, int(rng.choice((1, 1, 1, 3))))
    some = rng.random(values.shape) < rng.choice((0.0, 0.05, 0.5, 0.95))
    some.flat[rng.integers(some.size)] = True
    return np.where(some, rng.choice(kinds, values.shape), values)


def lines_lost(values: Values, rng: np.random.Generator) -> Values:
    lost = values.copy()
    lost[rng.random(values.shape[0]) < 0.4] = math.nan
    lost[:, rng.random(values.shape[1]) < 0.4] = math.nan
    return lost


def but_for_one(values: Values, rng: np.random.Generator) -> Values:
    """Lose all cells but one, or have all at rest but one."""
    only = np.full(values.shape, rng.choice((math.nan, 0.0, 1e-99)))
    at = int(rng.integers(only.size))
    only.flat[at] = rng.choice((values.flat[at], values.max(), 9e99, 1e-90))
    return only


def checkered(values: Values, rng: np.random.Generator) -> Values:
    y, x = np.indices(values.shape)
    return np.where((x + y) % 2 == 0, values.max(), rng.choice((0.0, -values.max(), 1e-99, 9e99)))


VALUES: dict[str, Callable[[Values, np.random.Generator], Values]] = {
    "as they are": lambda v, rng: v,
    "none": lambda v, rng: np.zeros(v.shape),
    "all invalid": lambda v, rng: np.full(v.shape, math.nan),
    "all equal": lambda v, rng: np.full(v.shape, rng.choice((v.max(), *EXTREMES))),
    "extremes": sprinkled,
    "scaled": lambda v, rng: v * 10.0 ** rng.uniform(-99, 99),
    "slightly scaled": lambda v, rng: v * 10.0 ** rng.uniform(-6, 6),
    "negative": lambda v, rng: -v,
    "lines lost": lines_lost,
    "but for one": but_for_one,
    "checkered": checkered,
    "noise": lambda v, rng: v.max() * rng.standard_normal(v.shape),
    "ramp": lambda v, rng: np.add.outer(*(np.linspace(0.0, v.max(), n) for n in v.shape)),
    "saturated": lambda v, rng: np.minimum(v * 1e3, v.max()),
    "rounded off": lambda v, rng: v.max() * (1.0 + 1e-16 * rng.integers(-4, 5, v.shape)),
}


def fitted(values: Values, shape: tuple[int, int]) -> Values:
    """Return values repeated or cut to a shape."""
    rows, columns = (np.arange(n) % old for n, old in zip(shape, values.shape, strict=True))
    return values[np.ix_(rows, columns)]


def of_type(values: Values, kind: str, rng: np.random.Generator) -> Values:
    """Return values as a type has them, whatever becomes of them; some at its limits."""
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if kind in ("object", "U8", "complex128"):
            return values.astype(kind)
        dtype = np.dtype(kind)
        turned = np.nan_to_num(values).astype(dtype)
        if dtype.kind in "iuf" and rng.random() < 0.3:
            limit = np.iinfo(dtype) if dtype.kind in "iu" else np.finfo(dtype)
            turned[rng.random(values.shape) < 0.2] = rng.choice((limit.min, limit.max))
    return turned


class Drawn(NamedTuple):
    """A hostile frame before it is one, and what is hostile about it."""

    what: str
    values: Values
    pitch_cm: Any
    origin_cm: Any
    quantity: str

    @property
    def words(self) -> str:
        """What it is, to look it up again."""
        return (
            f"{self.what}; {self.values.dtype} {self.values.shape}, pitch {self.pitch_cm} cm, "
            f"origin {self.origin_cm} cm"
        )


def drawn(base: Frame, rng: np.random.Generator) -> Drawn:
    """Return a frame of which some is hostile."""
    image = base.image
    values = image.filled(math.nan)
    what = str(rng.choice(list(VALUES)))
    shape, pitch, origin = values.shape, image.pitch_cm, image.origin_cm
    if rng.random() < 0.3:
        shape = SHAPES[rng.integers(len(SHAPES))]
        if rng.random() < 0.03:
            shape = HUGE[rng.integers(len(HUGE))]
        values = fitted(values, shape)
    if rng.random() < 0.2:
        pitch = PITCHES_CM[rng.integers(len(PITCHES_CM))]
    if rng.random() < 0.1:
        origin = ORIGINS_CM[rng.integers(len(ORIGINS_CM))]
    with np.errstate(all="ignore"):
        values = VALUES[what](np.nan_to_num(values), rng)
    if rng.random() < 0.15:
        values = of_type(values, str(rng.choice(TYPES)), rng)
    if rng.random() < 0.1:
        values = np.asfortranarray(values[::-1, ::-1])
    return Drawn(what, values, pitch, origin, image.quantity)


# -- what pipelines make of them ---------------------------------------------------------------


class TooLong(BaseException):
    """A frame that takes so long that it is given up; no `Exception`, which a run survives."""


def given_up(number: int, frame: FrameType | None) -> None:
    raise TooLong


class Target:
    """A pipeline, its runner, and what it makes of ordinary frames."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.pipeline: Pipeline = load(name)
        self.frames = list(islice(self.pipeline.frames(), 4))
        self.runner = self.pipeline.runner()
        self.alone = [answer(self.run(f)) for f in self.frames]
        self.alone = [answer(self.run(f)) for f in self.frames]
        self.usual_s = self._usual_s()

    def _usual_s(self) -> float:
        """Return the CPU seconds of an ordinary frame."""
        n, begun = 0, time.process_time()
        while (taken := time.process_time() - begun) < MEASURED_S:
            self.timed(self.frames[n % len(self.frames)])
            n += 1
        return taken / n

    def run(self, frame: Frame, most_s: float = GIVEN_UP_S) -> Result:
        """Return what comes of a frame, unless it takes too long."""
        signal.setitimer(signal.ITIMER_PROF, most_s)
        try:
            return self.runner(frame)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)

    def timed(self, frame: Frame, most_s: float = GIVEN_UP_S) -> tuple[Result, float]:
        """Return what comes of a frame, and the CPU seconds it took."""
        self.runner.forget()
        begun = time.process_time()
        result = self.run(frame, most_s)
        return result, time.process_time() - begun

    def longest_s(self, frame: Frame) -> float:
        """Return how long a frame may take."""
        cells = frame.image.values.size / self.frames[0].image.values.size
        return max(LEAST_S, TIMES_SLOWER * self.usual_s * max(1.0, cells))

    def as_ever(self, k: int) -> str:
        """Return what is wrong with the answer to an ordinary frame among hostile ones."""
        now = answer(self.runner(self.frames[k % len(self.frames)]))
        if self.runner.stateful or now == self.alone[k % len(self.frames)]:
            return ""
        return "an ordinary frame is answered otherwise than before"


def answer(result: Result) -> str:
    """Return the row of a result as text, to the digits that plain and compiled loops agree in."""
    row = json_row(result, full=False)
    row = {k: v for k, v in row.items() if not k.endswith("_us")}
    return json.dumps(_rounded(row), allow_nan=False)


def _rounded(data: Any) -> Any:
    if isinstance(data, float):
        return float(f"{data:.6g}")
    if isinstance(data, dict):
        return {k: _rounded(v) for k, v in data.items()}
    return [_rounded(v) for v in data] if isinstance(data, list) else data


def judged(result: Result) -> str:
    """Return what is wrong with a result: foreign failures, numbers that are none."""
    for name, outcome in result.outcomes.items():
        if isinstance(outcome, Failed):
            if outcome.kind == "error" and not isinstance(outcome.error, TactileGraphError):
                return f"node {name!r} ({outcome.step}) {outcome.reason} at {outcome.where}"
        elif not isinstance(outcome, Skipped):
            odd = not_finite(outcome)
            if odd:
                return f"node {name!r} gives as good: {odd}"
    answer(result)
    return ""


def once(target: Target, draw: Drawn, most_s: float = GIVEN_UP_S) -> Attempt:
    """Return what came of a hostile frame; one that takes too long gets a second chance."""
    try:
        frame = Frame.of(draw.values, draw.pitch_cm, draw.origin_cm, draw.quantity)
    except ValueError:
        return Attempt(target.name, "no frame")
    seconds = 0.0
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result, seconds = target.timed(frame, most_s)
            if seconds > target.longest_s(frame):
                result, seconds = target.timed(frame)
            why = judged(result)
            came = "answered" if result.ok else "no answer"
    except TactileGraphError:
        return Attempt(target.name, "refused", "", seconds)
    except TooLong:
        if target.longest_s(frame) > GIVEN_UP_S:
            return Attempt(target.name, "given up", "", GIVEN_UP_S)
        if most_s < COMPILED_S:  # kernels may have been compiled
            return once(target, draw, COMPILED_S)
        return Attempt(target.name, "HANGS", draw.words, GIVEN_UP_S)
    except Exception as error:
        return Attempt(target.name, "FOREIGN", f"{error!r}; {draw.words}", seconds)
    if why:
        return Attempt(target.name, "WRONG", f"{why}; {draw.words}", seconds)
    if seconds > target.longest_s(frame):
        usual = f"{seconds:.2f} s, usually {target.usual_s:.4f} s"
        return Attempt(target.name, "SLOW", f"{usual}; {draw.words}", seconds)
    return Attempt(target.name, came, "", seconds)


def attack(names: Sequence[str], n_tries: int, seed: int) -> Iterator[Attempt]:
    """Yield what came of frames, pipeline by pipeline in turn."""
    signal.signal(signal.SIGPROF, given_up)
    targets: dict[str, Target] = {}
    for i in range(n_tries):
        name = names[i % len(names)]
        if name not in targets:
            targets[name] = Target(name)
        target, rng = targets[name], np.random.default_rng([seed, i])
        attempt = once(target, drawn(target.frames[i % len(target.frames)], rng))
        yield attempt._replace(why=f"try {i}: {attempt.why}") if attempt.why else attempt
        if i // len(names) % 10 == 9:
            why = target.as_ever(i)
            yield Attempt(name, "as ever" if not why else "CHANGED", why and f"try {i}: {why}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if anything was foreign, not finite, or out of proportion."""
    parser = parser_of(__doc__, 2_000)
    about = "names, 'all', or 'plain': those of which no kernel has to be compiled"
    parser.add_argument("--pipelines", nargs="+", default=["plain"], help=about)
    args = parser.parse_args(arguments)
    names = installed().names("pipelines")
    if args.pipelines == ["plain"]:
        names = [n for n in names if not any(part in n for part in COMPILED)]
    elif args.pipelines != ["all"]:
        names = args.pipelines
    return told(attack(names, args.tries, args.seed), args)


if __name__ == "__main__":
    sys.exit(main())
