"""Cases for steps that take points."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Points
from tactile_graph_stress import scenes
from tactile_graph_stress.case import Case
from tactile_graph_stress.cases.stress_cases import StressCases
from tactile_graph_stress.similarity import Similarity
from tactile_graph_stress.subject import Subject

Values = NDArray[np.float64]

SCALES = (1e-9, 1e9, 1e-6, 1e-3, 1e3, 1e6)
OFFSETS = (1e8, 1e2, 1e4, 1e6)
TURNS_DEG = (90.0, 31.0, 1e-9, 45.0, 137.0, 179.0)
ARCS_DEG = (180.0, 5.0, 90.0, 45.0, 20.0, 10.0)
ASPECTS = (10.0, 1000.0, 1.0, 3.0, 100.0, 300.0)
FLAT = (1e-6, 1e-12, 1e-3, 1e-9, 1e-14, 1e-16)
POWERS = (-1060, 1015, -1030, -600, -450, 500, 900)
"""Exponents of 2: subnormal, nearly infinite, and sizes whose squares are no numbers."""


def point_cases(subject: Subject, rng: np.random.Generator, quick: bool) -> Iterator[Case]:
    """Yield the cases, few of each group if ``quick``."""
    few = 2 if quick else 6
    base = _base(subject.kind, rng)
    yield from _laws(subject, base, rng, few)
    yield from _shapes(subject.kind, rng, few)
    yield from _lines(base, few)
    yield from _counts(base)
    yield from _numbers(subject, base, few)


def _base(kind: str, rng: np.random.Generator) -> Values:
    if kind == "circle":
        return scenes.noisy(scenes.arc(300.0), rng)
    if kind == "ellipse":
        return scenes.noisy(scenes.ellipse(), rng)
    if kind == "rectangle":
        return scenes.noisy(scenes.rectangle(), rng)
    return scenes.cloud(rng)


def _law(
    group: str, name: str, base: Values, law: Similarity, subject: Subject | None = None
) -> Case:
    lengths = {} if subject is None else subject.lengths
    settings = {k: v * law.scale for k, v in lengths.items()} if law.scale != 1.0 else {}
    return Case(group, name, Points(law.of(base)), Points(base.copy()), law, settings)


def _laws(subject: Subject, base: Values, rng: np.random.Generator, few: int) -> Iterator[Case]:
    yield Case("truth", "as it is", Points(base.copy()), Points(base.copy()), Similarity())
    for scale in SCALES[:few]:
        yield _law("scale", f"times {scale:g}", base, Similarity(scale), subject)
    for offset in OFFSETS[:few]:
        shift = Similarity(1.0, 0.0, offset, -0.7 * offset)
        yield _law("offset", f"{offset:g} cm away", base, shift)
    for degrees in TURNS_DEG[:few]:
        yield _law("turn", f"by {degrees:g} deg", base, Similarity(1.0, math.radians(degrees)))
    orders = [base[::-1], *(rng.permutation(base) for _ in range(few))]
    for k, xy in enumerate(orders):
        name = "reversed" if k == 0 else f"shuffled {k}"
        yield Case("order", name, Points(xy.copy()), Points(base.copy()), Similarity())
    for times in (2, 5)[:few]:
        xy = np.tile(base, (times, 1))
        name = f"each point {times} times"
        yield Case("twice", name, Points(xy), Points(base.copy()), Similarity())
    narrow: Any = base.astype(np.float32)  # no wire promises it, but arrays from outside may be
    wide = Points(narrow.astype(np.float64))
    yield Case("float32", "float32 points", Points(narrow), wide, Similarity())


def _shapes(kind: str, rng: np.random.Generator, few: int) -> Iterator[Case]:
    """Yield exact shapes: short arcs and long ones."""
    if kind == "circle":
        for degrees in ARCS_DEG[:few]:
            yield Case("arc", f"{degrees:g} deg", Points(scenes.arc(degrees)))
        yield Case("arc", "20 deg, 10000 cm away", Points(1e4 + scenes.arc(20.0)))
        loose = scenes.noisy(scenes.arc(30.0), rng, 0.005)
        yield Case("arc", "30 deg, noise 0.1 %", Points(loose))
    if kind == "ellipse":
        for degrees in ARCS_DEG[:few]:
            yield Case("arc", f"{degrees:g} deg", Points(scenes.ellipse(1.6, degrees)))
    for aspect in ASPECTS[:few]:
        name = f"{aspect:g} : 1"
        if kind == "ellipse":
            yield Case("aspect", name, Points(scenes.ellipse(aspect)))
        elif kind == "rectangle":
            yield Case("aspect", name, Points(scenes.rectangle(aspect)), facts={"aspect": aspect})
        elif kind != "circle":
            yield Case("aspect", name, Points(scenes.cloud(rng, aspect)))


def _lines(base: Values, few: int) -> Iterator[Case]:
    t = np.arange(12.0)
    for name, step in (("level", (1.3, 0.0)), ("slanting", (1.3, 0.1)), ("upright", (0.0, 1.3))):
        yield Case("line", name, Points(0.65 + np.outer(t, step)))
    yield Case("line", "two places", Points(np.tile([[1.0, 2.0], [3.0, 5.0]], (6, 1))))
    turn = Similarity(1.0, 0.5)
    for flat in FLAT[:few]:
        xy = turn.of((base - base.mean(axis=0)) * (1.0, flat))
        yield Case("near line", f"flattened by {flat:g}", Points(xy))


def _counts(base: Values) -> Iterator[Case]:
    for n in range(1, 6):
        yield Case("few", f"{n} point{'s' * (n > 1)}", Points(base[:: len(base) // n][:n].copy()))
    yield Case("few", "all at one place", Points(np.full((12, 2), 3.7)))
    yield Case("few", "all at the origin", Points(np.zeros((12, 2))))
    yield Case("empty", "no point", Points(np.empty((0, 2))))


def _numbers(subject: Subject, base: Values, few: int) -> Iterator[Case]:
    for power in POWERS[: few + 1]:
        with np.errstate(under="ignore"):
            xy = np.ldexp(base, power)
        name = f"times 2^{power}"
        if subject.lengths:  # which cannot follow: with them the law does not hold
            yield Case("size", name, Points(xy))
        else:
            law = Similarity(math.ldexp(1.0, power))
            yield Case("size", name, Points(xy), Points(base.copy()), law)
    largest = base / np.abs(base).max() * np.finfo(np.float64).max
    yield Case("size", "up to the largest number", Points(largest))
    signs = np.where(np.arange(2 * len(base)).reshape(-1, 2) % 3 == 0, -1.0, 1.0)
    yield Case("size", "from -1.8e308 to 1.8e308", Points(largest * signs))
    for name, bad in (("a NaN", np.nan), ("infinity", np.inf), ("-infinity", -np.inf)):
        xy = base.copy()
        xy[3, 1] = bad
        yield Case("NaN", name, Points(xy), must_refuse=True)
    yield Case("NaN", "all NaN", Points(np.full_like(base, np.nan)), must_refuse=True)


POINTS = StressCases(lambda subject: subject.feed == "points", point_cases)
