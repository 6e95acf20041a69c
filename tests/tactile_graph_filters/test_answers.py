"""Filters that part, level and average give the very answers in ``answers.yaml`` on five scenes.

They were written down once the tests beside this one, against definitions, scipy and
scikit-image, had passed. After a change that is meant,
``python tests/tactile_graph_filters/test_answers.py`` writes them anew.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from helpers_answers import Case, alike, answer, told
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.bridge_lines import bridge_lines
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_filters.contacts.lean_contacts import lean_contacts
from tactile_graph_filters.contacts.sharpen_contacts import sharpen_contacts
from tactile_graph_filters.images.crop import crop
from tactile_graph_filters.images.low_pass import LowPass
from tactile_graph_filters.images.subdivide_image import subdivide_image
from tactile_graph_filters.morphology.close import Close
from tactile_graph_filters.morphology.hit_or_miss import HitOrMiss
from tactile_graph_filters.morphology.open import Open
from tactile_graph_filters.morphology.skeleton import skeleton
from tactile_graph_filters.parting.split_contacts import SplitContacts
from tactile_graph_filters.parting.split_watershed import split_watershed
from tactile_graph_filters.readings.inpaint import inpaint
from tactile_graph_filters.readings.load import LoadOf
from tactile_graph_filters.thresholds.noise_level import noise_level
from tactile_graph_filters.thresholds.threshold import Threshold
from tactile_graph_filters.thresholds.threshold_otsu import threshold_otsu
from tactile_graph_filters.thresholds.threshold_valley import threshold_valley
from tactile_graph_filters.thresholds.threshold_variable import threshold_variable

pytestmark = pytest.mark.slow

FILE = Path(__file__).parent / "answers.yaml"
PITCH, ORIGIN = (1.3, 1.1), (-0.5, 2.0)


def scene(shape: tuple[int, int], bumps: list[tuple[float, ...]], noise: float = 0.3,
          torn: float = 0.0, known: float = 1.0, flat: bool = False) -> Image:  # fmt: skip
    """Bumps (row, column, radius, height), round or with a flat top, some of their cells torn."""
    rng = np.random.default_rng([int(10 * noise), *shape])
    i, j = np.indices(shape)
    values = noise * rng.standard_normal(shape)
    for row, column, radius, height in bumps:
        far = np.hypot(i - row, j - column) / radius
        values += height * (far < 1.0 if flat else np.exp(-2.0 * far * far))
    values[rng.random(shape) < torn] = 0.0
    valid = None if known == 1.0 else rng.random(shape) < known
    return Image(values, PITCH, ORIGIN, "raw", valid)


SCENES = {
    "fingers": scene((16, 18), [(3, 3, 3, 40), (4, 8, 3, 60), (11, 4, 2.5, 30), (10, 14, 4, 50)]),
    "discs": scene((14, 15), [(5, 4, 4, 20), (6, 10.5, 3.5, 25)], 0.5, 0.12, 0.95, True),
    "torn": scene((26, 24), [(7, 7, 7, 30), (17, 16, 8, 30)], 0.2, 0.3, flat=True),
    "one": scene((9, 11), [(4, 5, 4, 10)], 0.1, flat=True),
    "edge": scene((7, 9), [(0, 0, 3, 10), (6, 8, 2, 12), (0, 8, 1, 9)], 0.1, known=0.9),
    "empty": Image(np.zeros((5, 6)), PITCH, ORIGIN, "raw"),
}


def footprint(image: Image) -> Mask:
    on = image.values > 5.0
    return image.mask(on if image.valid is None else on & image.valid)


def of_image(name: str, step: Callable[..., Any], *scenes: str) -> list[Case]:
    return [Case(f"{name} {k}", step, (SCENES[k],)) for k in scenes or SCENES]


def of_both(name: str, step: Callable[..., Any], *scenes: str) -> list[Case]:
    return [
        Case(f"{name} {k}", lambda image: step(image, footprint(image)), (SCENES[k],))
        for k in scenes or SCENES
    ]


def of_mask(name: str, step: Callable[..., Any], *scenes: str) -> list[Case]:
    return [
        Case(f"{name} {k}", lambda image: step(footprint(image)), (SCENES[k],))
        for k in scenes or SCENES
    ]


def summed(found: Any) -> Any:
    """Return of each contact what is counted, its box, places and sizes, and its own image."""
    return tuple(
        (c.n_cells, *c.box, c.x_cm, c.y_cm, c.centroid_x_cm, c.centroid_y_cm, c.area_cm2, c.load,
         c.peak, *told(c.image))
        for c in found.contacts
    )  # fmt: skip


def labelled(image: Image, mask: Mask) -> Any:
    return summed(contacts(image, mask, connectivity=4, min_cells=2, margin=1))


def sharpened(image: Image, mask: Mask) -> Any:
    whole = contacts(image, mask, margin=1)
    return summed(sharpen_contacts(whole.contacts, share=0.4, finer=3))


def leaned(image: Image, mask: Mask) -> Any:
    return summed(lean_contacts(image, contacts(image, mask).contacts))


def watershed(**settings: Any) -> Callable[..., Any]:
    return lambda image, mask: summed(split_watershed(image, mask, **settings))


def told_apart(**settings: Any) -> Callable[..., Any]:
    step = SplitContacts(**settings)
    return lambda image, mask: summed(step(image, mask))


WINDOW = ((1.0, 2.0, 1.0), (0.0, 3.0, 1.0), (1.0, 0.5, 0.0))
CASES = [
    *of_both("contacts", labelled),
    *of_both("sharpen_contacts", sharpened),
    *of_both("lean_contacts", leaned),
    *of_both("bridge_lines", bridge_lines, "edge"),
    *of_both("crop", crop, "fingers", "one", "edge"),
    *of_both("split_watershed", watershed()),
    *of_both("split_watershed by load", watershed(by="load", min_cells=3, margin=1)),
    *of_both("split_watershed by distance", watershed(by="distance", bridge_cells=0, neck=0.9)),
    *of_both("split_contacts", told_apart()),
    *of_both("split_contacts once", told_apart(recut=False, hold=0.2, usual_cells=3.0)),
    *of_both("split_contacts coarsely", told_apart(working_cells=12, margin=1), "torn", "fingers"),
    *of_image("low_pass", LowPass()),
    *of_image("low_pass weighted", LowPass(weights=WINDOW)),
    *of_image("subdivide_image", lambda image: subdivide_image(image, factor=2), "edge", "one"),
    *of_image("inpaint", inpaint, "discs", "edge"),
    *of_image("inpaint nearest", lambda image: inpaint(image, method="nearest"), "discs", "edge"),
    *of_image("load", LoadOf(above=1.0)),
    *of_image("noise_level", noise_level),
    *of_image("threshold", Threshold(above=True, level=5.0)),
    *of_image("threshold_otsu", threshold_otsu),
    *of_image("threshold_valley", threshold_valley),
    *of_image("threshold_valley of few", lambda i: threshold_valley(i, n_bins=12, smoothing=3)),
    *of_image("threshold_variable", threshold_variable),
    *of_image("threshold_variable high", lambda i: threshold_variable(i, fraction=0.7, floor=2.0)),
    *of_mask("close", Close(element="disc5", times=2), "torn", "discs"),
    *of_mask("open", Open(element="square3"), "torn", "discs"),
    *of_mask("hit_or_miss", HitOrMiss(hit=[[0, 1, 0], [1, 1, 0], [0, 0, 0]]), "torn", "discs"),
    *of_mask("skeleton", skeleton, "torn", "discs"),
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
