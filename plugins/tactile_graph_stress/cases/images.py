"""Cases for steps that take an image: restorers, and all others but decouplers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image
from tactile_graph_stress import scenes
from tactile_graph_stress.affine import Affine
from tactile_graph_stress.case import Case
from tactile_graph_stress.cases.stress_cases import StressCases
from tactile_graph_stress.subject import Subject

Values = NDArray[np.float64]

SCALES = (1e-9, 1e9, 1e-6, 1e-3, 1e3, 1e6)
OFFSETS = (1e8, 1e2, 1e4, 1e6)


def quantity_of(subject: Subject) -> str:
    """Return a quantity that all ports of a step take."""
    rules = [p.quantity for p in subject.signature.ports if p.quantity is not None]
    return rules[0].names[0] if rules and rules[0].names else "volt"


def image_cases(subject: Subject, rng: np.random.Generator, quick: bool) -> Iterator[Case]:
    """Yield the cases, few of each group if ``quick``."""
    few = 2 if quick else 6
    quantity = quantity_of(subject)
    values = scenes.load(rng)

    def image(v: NDArray[Any], valid: NDArray[np.bool_] | None = None) -> Image:
        return Image(np.array(v), (1.3, 1.3), (0.0, 0.0), quantity, valid)

    base = image(values)
    if subject.kind == "restore":
        for scale in SCALES[:few]:
            law = Affine(scale)
            yield Case("scale", f"times {scale:g}", image(law.of(values)), base, law)
        for offset in OFFSETS[:few]:
            law = Affine(1.0, offset)
            yield Case("offset", f"plus {offset:g}", image(law.of(values)), base, law)
        narrow = values.astype(np.float32)
        wide = image(narrow.astype(np.float64))
        yield Case("float32", "float32 values", image(narrow), wide, Affine())
        steps = np.where(values > 0.1, 1.0, 0.0)
        yield Case("truth", "two levels, no noise", image(steps), facts={"restored": steps})
    else:
        yield Case("truth", "as it is", base)
        yield Case("float32", "float32 values", image(values.astype(np.float32)))
    for group, name, odd in _odd(values, rng):
        yield Case(group, name, image(odd))
    broken = rng.random(values.shape) < 0.3
    yield Case("cells", "a third invalid", image(np.where(broken, 0.0, values), ~broken))
    one = np.arange(values.size).reshape(values.shape) == 27
    yield Case("cells", "one cell valid", image(np.where(one, values, 0.0), one))
    yield Case("empty", "no cell valid", image(np.zeros((8, 8)), np.zeros((8, 8), np.bool_)))


def _odd(values: Values, rng: np.random.Generator) -> Iterator[tuple[str, str, Values]]:
    """Yield images at the limits, each with its group."""
    yield "empty", "all 0", np.zeros((8, 8))
    yield "empty", "full pad", np.full((8, 8), 5.0)
    yield "empty", "full, 0.1 everywhere", np.full((8, 8), 0.1)
    x = np.arange(64.0).reshape(8, 8)
    yield "cells", "one cell on", np.where(x == 27, 0.2, 0.0)
    yield "cells", "every other cell", (x + x // 8) % 2
    yield "cells", "a ramp", x
    yield "cells", "-0.0 and 0.0", np.where(x % 2 == 0, -0.0, 0.0)
    yield "cells", "below 0", -values
    for shape in ((1, 1), (1, 12), (12, 1), (2, 2)):
        yield "cells", f"{shape[0]} x {shape[1]}", rng.random(shape)
    yield "size", "subnormal", values * 1e-318
    yield "size", "times 1e-200", values * 1e-200
    yield "size", "times 1e200", values * 1e200
    yield "size", "up to 1.7e308", values / values.max() * 1.7e308
    yield "size", "from -1.7e308 to 1.7e308", np.where(x % 2 == 0, 1.7e308, -1.7e308)
    yield "size", "one cell of 1e300", np.where(x == 27, 1e300, values)
    yield "size", "equal but for the last bit", np.where(x % 3 == 0, 0.1, np.nextafter(0.1, 1.0))
    for name, bad in (("a NaN", np.nan), ("infinity", np.inf), ("-infinity", -np.inf)):
        yield "NaN", name, np.where(x == 27, bad, values)
    yield "NaN", "all NaN", np.full((8, 8), np.nan)


IMAGES = StressCases(
    lambda subject: subject.feed == "image" and subject.kind != "decouple", image_cases
)
