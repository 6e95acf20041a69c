"""The bundled recordings: small, on the thesis' pad, with truth."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph.steps import Report
from tactile_graph.wires import Circle
from tactile_graph_sources.sample import FOLDER, sample


def test_discs_are_the_three_of_table_4_2_twice_on_the_thesis_pad() -> None:
    frames = list(sample(report=Report()))
    assert [f.index for f in frames] == list(range(6))
    table = [("DISC I", 1860.0, 6.8), ("DISC II", 6360.0, 5.1), ("DISC III", 6810.0, 7.7)]
    for frame, (name, weight_g, radius_cm) in zip(frames, table * 2, strict=True):
        image = frame.image
        assert (image.shape, image.quantity) == ((16, 16), "volt")
        assert (image.pitch_cm, image.origin_cm) == ((1.3, 1.3), (-0.15, -0.15))
        assert image.x_cm[0] == pytest.approx(0.5)
        assert frame.truth is not None
        (disc,) = frame.truth
        assert (disc.name, disc.weight_g) == (name, weight_g)
        assert isinstance(disc.shape, Circle)
        assert disc.shape.radius_cm == radius_cm
        y, x = np.meshgrid(image.y_cm, image.x_cm, indexing="ij")
        away_cm = np.hypot(x - disc.shape.x_cm, y - disc.shape.y_cm)
        # What is above the thesis' threshold lies under the disc, and most of the disc is.
        on = image.values >= 0.01
        assert away_cm[on].max() < radius_cm + 1.3
        assert on[away_cm < radius_cm - 1.3].mean() > 0.7


def test_the_samples_are_small() -> None:
    assert sum(p.stat().st_size for p in FOLDER.iterdir()) < 20_000


def test_an_unknown_sample_says_what_there_is() -> None:
    with pytest.raises(
        UsageError, match=r"no sample named 'disks', there are: discs; did you mean"
    ):
        list(sample(name="disks", report=Report()))
