"""Every fitter gives the very answers in ``answers.yaml``, in as many rounds, or the same refusal.

They were written down once the tests beside this one, against other optimisers, definitions and
truths, had passed; what they add is that a search takes no more rounds than it did, which no clock
tells, and says the same in words. After a change that is meant,
``python tests/tactile_graph_fitters/test_answers.py`` writes them anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from helpers_answers import Case, alike, answer
from helpers_ellipses import drawn
from tactile_graph.wires import Circle, Image, Mask, Points, Polygon
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_fitters.circle.fit_circle_hyper import fit_circle_hyper
from tactile_graph_fitters.circle.fit_circle_kasa import fit_circle_kasa
from tactile_graph_fitters.circle.fit_circle_load import FitCircleLoad
from tactile_graph_fitters.circle.fit_circle_taubin import fit_circle_taubin
from tactile_graph_fitters.circle.fit_circle_thesis import fit_circle_thesis
from tactile_graph_fitters.ellipse.ellipse_sweep import ellipse_sweep
from tactile_graph_fitters.ellipse.fit_ellipse import fit_ellipse
from tactile_graph_fitters.ellipse.fit_ellipse_direct import fit_ellipse_direct
from tactile_graph_fitters.ellipse.fit_ellipse_origin import fit_ellipse_origin
from tactile_graph_fitters.orientation.heavier_side import heavier_side
from tactile_graph_fitters.orientation.orientation import Orientation, orientation
from tactile_graph_fitters.orientation.orientation_robust import orientation_robust
from tactile_graph_fitters.orientation.rotate_mask import rotate_mask
from tactile_graph_fitters.rectangle.fit_rectangle import fit_rectangle
from tactile_graph_fitters.rectangle.fit_rectangle_load import FitRectangleLoad
from tactile_graph_fitters.rectangle.min_area_rectangle import min_area_rectangle
from tactile_graph_fitters.shape.shape_decision import shape_decision
from tactile_graph_fitters.shape.simplify_polygon import SimplifyPolygon

pytestmark = pytest.mark.slow

FILE = Path(__file__).parent / "answers.yaml"


def rng(*seed: int) -> np.random.Generator:
    return np.random.default_rng([17, *seed])


def arc(degrees: float, noise: float, n: int = 25) -> np.ndarray:
    """Points of a circle of 5 cm about (8, -3), with noise."""
    t = np.radians(20.0 + np.linspace(0.0, degrees, n))
    circle = np.column_stack([8.0 + 5.0 * np.cos(t), -3.0 + 5.0 * np.sin(t)])
    return circle + rng(int(degrees), int(1e4 * noise)).normal(0.0, noise, (n, 2))


def sides(n: int, angle: float, noise: float) -> np.ndarray:
    """Points of the outline of 9 by 4 cm about (6, 7) but for one corner, with noise."""
    t = np.linspace(0.03, 0.93, n) * 26.0
    u = np.select([t < 9, t < 13, t < 22], [t - 4.5, 4.5, 17.5 - t], -4.5)
    v = np.select([t < 9, t < 13, t < 22], [-2.0, t - 11.0, 2.0], 24.0 - t)
    cos, sin = math.cos(angle), math.sin(angle)
    xy = np.column_stack([6.0 + u * cos - v * sin, 7.0 + u * sin + v * cos])
    return xy + rng(n).normal(0.0, noise, (n, 2))


ROWS = np.array([[x, y] for y in (1.0, 3.0) for x in range(7)], float)
STRAY = np.vstack([sides(40, 0.3, 0.05), [[30.0, 2.0], [-9.0, 20.0]]])
CURVE = np.column_stack([np.linspace(-4, 4, 30), 0.3 * np.linspace(-4, 4, 30) ** 2])
SETS: dict[str, np.ndarray] = {
    "short arc": arc(35, 0.002),
    "arc": arc(120, 0.2),
    "straight arc": arc(8, 0.05),
    "ring": arc(350, 0.4),
    "exact arc": arc(60, 1e-7, 9),
    "cluster": rng(3).normal(0.0, 2.0, (15, 2)),
    "two rows": ROWS,
    "sides": sides(40, 0.5, 0.1),
    "level sides": sides(23, 0.0, 0.0),
    "strays": STRAY,
    "curve": CURVE + rng(4).normal(0.0, 0.02, CURVE.shape),
    "long curve": 1e3 * CURVE + rng(5).normal(0.0, 60.0, CURVE.shape),
    "three": np.array([[0.0, 0.0], [2.0, 0.5], [1.0, 3.0]]),
    "square": np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [2.0, 0.0]]),
    "line": np.column_stack([np.arange(6.0), 2.0 * np.arange(6.0)]),
    "one place": np.ones((4, 2)),
    "one": np.array([[1.0, 2.0]]),
    "none": np.empty((0, 2)),
    "tiny": 1e-200 * arc(90, 0.1),
    "not finite": np.array([[0.0, 1.0], [math.nan, 2.0], [3.0, math.inf], [4.0, 0.0], [1.0, 1.0]]),
    **{f"{kind} {k}": drawn(kind, k) for kind in ("cells", "blob", "flat", "arc", "broken")
       for k in (1, 2)},
    **{kind: drawn(kind, 1) for kind in ("hyperbola", "repeated", "five", "grid")},
}  # fmt: skip
AXIS = Orientation(0.4, 7.0, -2.0, 0.5, 0.1, False)


def shape(*, broken: float, angle: float = 0.4, size: tuple[float, float] = (6.0, 2.4)) -> Mask:
    """The cells of 1.3 by 1.1 cm that a turned rectangle covers, some of them void."""
    x, y = np.meshgrid((np.arange(14) + 0.5) * 1.3 + 2.0, (np.arange(12) + 0.5) * 1.1 - 5.0)
    cos, sin = math.cos(angle), math.sin(angle)
    u, v = (x - 11.0) * cos - (y - 1.5) * sin, (x - 11.0) * sin + (y - 1.5) * cos
    on = (abs(u) < size[0]) & (abs(v) < size[1])
    return Mask(on & (rng(1).random(on.shape) >= broken), (1.3, 1.1), (2.0, -5.0))


def parts(*texts: str) -> Mask:
    return Mask(np.array([[c == "#" for c in row] for row in texts]), (1.3, 1.1), (2.0, -5.0))


MASKS: dict[str, Mask] = {
    "whole": shape(broken=0.0),
    "broken": shape(broken=0.25),
    "nearly square": shape(broken=0.1, angle=0.9, size=(4.0, 3.4)),
    "apart": parts(
        "##........", "###....##.", ".##....##.", "..........", "...###....", "#........."
    ),
    "row": parts("........", ".######.", "........"),
    "cell": parts("...", ".#.", "..."),
    "off": parts("...", "..."),
}


def loads(mask: Mask, void: bool = False) -> Image:
    """Uneven readings of a mask's cells, a little beside it; some not valid, or nothing there."""
    grams = np.where(mask.values, 40.0, 0.0) * np.exp(rng(8).normal(0.0, 0.3, mask.shape))
    grams[0, 0] = 3.0
    valid = rng(9).random(mask.shape) > 0.05
    if void:
        grams[rng(10).random(mask.shape) < 0.15] = 0.0
    return Image(grams, mask.pitch_cm, mask.origin_cm, "gram", valid)


def disc(radius: float, uneven: float = 0.0, at: tuple[float, float] = (9.0, 11.0)) -> Image:
    """A disc's load on 16 by 16, each cell sampled at 81 points, with a few cells not valid."""
    fine = (np.arange(16 * 9) + 0.5) * 1.3 / 9.0
    within = np.hypot(fine[:, None] - at[1], fine - at[0]) < radius
    share = within.reshape(16, 9, 16, 9).mean(axis=(1, 3))
    grams = 50.0 * share * np.exp(rng(6).normal(0.0, uneven, share.shape))
    return Image(grams, (1.3, 1.3), (0.0, 0.0), "gram", rng(7).random(share.shape) > 0.03)


DISCS = {
    "disc": disc(5.0),
    "uneven": disc(4.2, 0.4),
    "small": disc(1.5),
    "beyond": disc(5.0, 0.2, (1.0, 11.0)),
    "dot": disc(0.4),
    "nothing": disc(0.01),
    "two": Image(disc(2.5).values + disc(2.5, at=(3.0, 4.0)).values, (1.3, 1.3), quantity="gram"),
    "oblong": Image(disc(5.0).values, (1.3, 1.2), quantity="gram"),
}


def of_points(fit: Callable[..., Any], *names: str, **settings: Any) -> list[Case]:
    """Return a fitter's cases on sets of points, on all of them unless named."""
    told = "".join(f" {k}={v}" for k, v in settings.items())
    return [
        Case(f"{fit.__name__} {name}{told}", lambda p: fit(p, **settings), (Points(SETS[name]),))
        for name in names or SETS
    ]


def about_axis(points: Points) -> Any:
    return fit_ellipse_origin(points, AXIS)


def about_axis_shortly(points: Points) -> Any:
    return fit_ellipse_origin(points, AXIS, max_iterations=30)


def sweep_about_axis(points: Points) -> Any:
    return ellipse_sweep(points, AXIS, step_deg=20.0)


def simplified(name: str, **settings: Any) -> Case:
    told = "".join(f" {k}={v}" for k, v in settings.items())
    return Case(f"simplify {name}{told}", SimplifyPolygon(**settings), (Polygon(SETS[name]),))


FEW = ("arc", "cluster", "strays", "square", "line", "one place", "one", "tiny", "not finite")
HULLS = ("ring", "cells 1", "square", "sides")
CASES = [
    *(c for fit in (fit_circle_hyper, fit_circle_kasa, fit_circle_taubin)
      for c in of_points(fit, *FEW)),
    *of_points(fit_circle_thesis, "arc", "short arc", max_iterations=5),
    *(c for fit in (fit_circle, fit_circle_thesis, fit_ellipse, fit_ellipse_direct, about_axis)
      for c in of_points(fit)),
    *of_points(about_axis_shortly, *FEW),
    *of_points(ellipse_sweep, "sides", "ring", "arc 1", "line", "one", "not finite", "two rows"),
    *of_points(ellipse_sweep, "sides", "arc 1", "two rows", refine=False),
    *of_points(sweep_about_axis, "sides", "arc 1"),
    *of_points(fit_rectangle, *(name for name in SETS if "arc" not in name)),
    *of_points(fit_rectangle, "sides", scale_cm=0.1, inside_cm=0.4),
    *(c for fit in (min_area_rectangle, orientation) for c in of_points(fit, *FEW, "two rows")),
    *of_points(shape_decision, *FEW, "sides", "ring", "cells 1", "two rows", "five"),
    *of_points(shape_decision, *HULLS, max_corners=4, temperature=2.0),
    *(simplified(name, corners=k) for name in HULLS for k in (3, 4, 6)),
    *(simplified(name, corners=4, refine=False) for name in HULLS),
    *(simplified(name, tolerance_cm=0.3) for name in HULLS),
    simplified("three", corners=5),
    simplified("not finite", corners=4),
    *(Case(f"{fit.__name__} {name}", fit, (mask,)) for name, mask in MASKS.items()
      for fit in (orientation, orientation_robust, FitRectangleLoad())
      if hasattr(fit, "__name__")),
    *(Case(f"rotate_mask {name}", lambda m: rotate_mask(m, AXIS), (mask,))
      for name, mask in MASKS.items()),
    *(Case(f"fit_rectangle_load {name}", FitRectangleLoad(), (mask,))
      for name, mask in MASKS.items()),
    *(Case(f"fit_rectangle_load {name} loaded{' with voids' * void}",
           FitRectangleLoad(load_power=1.5), (mask, loads(mask, void)))
      for name, mask in MASKS.items() for void in (False, True)),
    *(Case(f"heavier_side {name}", heavier_side, (loads(mask), mask))
      for name, mask in MASKS.items()),
    Case("heavier_side of a shape", heavier_side, (loads(MASKS["whole"]), MASKS["whole"],
                                                   Circle(11.0, 1.5, 4.0))),
    *(Case(f"fit_circle_load {name}", FitCircleLoad(), (image,))
      for name, image in DISCS.items()),
    Case("fit_circle_load with its gap", FitCircleLoad(gap_cm=0.0, shows_from=1.0),
         (DISCS["uneven"],)),
]  # fmt: skip


@cache
def written() -> dict[str, Any]:
    """Return the answers written down; read when first asked for, since that takes a while."""
    return dict(yaml.safe_load(FILE.read_text(encoding="utf-8")))


def test_there_is_an_answer_for_each_and_no_other() -> None:
    assert list(written()) == [case.name for case in CASES]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_answer_is_the_one_written_down(case: Case) -> None:
    found, wanted = answer(case), written()[case.name]
    assert alike(found, wanted), f"{found} is not {wanted}"


if __name__ == "__main__":
    texts = {case.name: answer(case) for case in CASES}
    FILE.write_text(yaml.safe_dump(texts, sort_keys=False, width=100, default_flow_style=None))
