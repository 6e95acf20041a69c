"""Filters leave an image where it was, and a table counts what came of them."""

import sys
from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Image

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from filtered_images import FILTERS, Found, filtered, table


@pytest.mark.parametrize("name", FILTERS)
def test_an_image_covers_what_it_covered_and_keeps_its_middle(name: str) -> None:
    y, x = np.mgrid[:9, :12]
    image = Image(np.exp(-((x - 5.5) ** 2 + (y - 4.0) ** 2) / 8.0), (1.3, 1.0), (2.0, 3.0), "volt")
    found = filtered(image, FILTERS[name])
    assert np.multiply(found.shape[::-1], found.pitch_cm) == pytest.approx([15.6, 9.0])
    middle = [np.average(g, weights=found.values) for g in np.meshgrid(found.x_cm, found.y_cm)]
    assert middle == pytest.approx([image.x_cm.mean(), image.y_cm.mean()])
    assert found.quantity == "volt"


def test_a_table_counts_what_was_noticed_and_what_regions_held() -> None:
    of_pads = {name: [Found(noticed=False, fits=True, held=True)] for name in FILTERS}
    of_pads["3x3 mean"] += [
        Found(noticed=True, fits=False, held=True),
        Found(noticed=True, fits=True, held=False),
        Found(noticed=False, fits=False, held=False),
    ]
    lines = table("two kinds", [of_pads, of_pads]).splitlines()
    assert "| none | 0 of 2 (0%) | 2 of 2 |  |" in lines
    assert "| 3x3 mean | 4 of 8 (50%) | 2 of 2 | 2 of 4 |" in lines
