"""A single row of cells tells nothing of what lies across: sizes there are what there can be."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Ellipse, Image
from tactile_graph_likelihood.any_pad.choose import Locate
from tactile_graph_likelihood.any_pad.locate import LocateDisc, LocateEllipse, LocateRectangle
from tactile_graph_likelihood.geometry.outlines import sizes
from tactile_graph_likelihood.settings import LocateSettings
from tactile_graph_likelihood.several.locate_objects import LocateObjects
from tactile_graph_likelihood.single.likely import Likely

# Machine code is compiled for tests that look at many frames; plain code serves the others.
many = pytest.mark.usefixtures("warm_kernels")
plain = pytest.mark.usefixtures("plain_kernels")

ROW = [0.0, 0.0, 0.0, 0.0, 3.0, 5.0, 8.0, 9.0, 7.0, 5.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]


def image(values: object) -> Image:
    return Image(np.array(values, float), pitch_cm=(1.0, 1.0), quantity="raw")


def check(shape: Likely, smallest_cm: float = 0.4) -> None:
    """Check that all sizes are possible, and all numbers are some."""
    its = shape.posterior
    lengths = slice(2, 2 + sizes.call(its.kind))
    for found in (its.mean[lengths], its.points[:, lengths], its.most_likely[lengths]):
        assert found.min() >= smallest_cm
    for numbers in (its.mean, its.covariance, its.points, its.log_evidence, its.reach):
        assert np.isfinite(numbers).all()
    assert np.linalg.eigvalsh(its.covariance).min() > -1e-9
    assert its.contains(shape)


@plain
@pytest.mark.slow
@pytest.mark.parametrize("turned", [False, True])
def test_half_axes_are_positive_and_the_one_along_the_row_is_right(turned: bool) -> None:
    row = image([ROW])
    found = LocateEllipse()(image(np.array([ROW]).T) if turned else row)
    check(found)
    assert isinstance(found, Ellipse)
    along_cm, centre_cm = found.semi_major_cm, found.y_cm if turned else found.x_cm
    assert centre_cm == pytest.approx(7.4, abs=0.2)
    assert along_cm == pytest.approx(3.4, abs=0.4)
    assert found.semi_minor_std_cm > 1.0  # nobody knows it
    assert not found.fits


def noisy(rows: int, columns: int, seed: int) -> Image:
    """Return a disc on a pad of a row or two, with gains and noise."""
    rng = np.random.default_rng([rows, columns, seed])
    y, x = np.mgrid[:rows, :columns] + 0.5
    far = np.hypot(x - rng.uniform(0, columns), y - rng.uniform(0, rows))
    radius_cm = rng.uniform(0.7, max(0.8, 0.35 * max(rows, columns)))
    load = 5.0 * np.clip(radius_cm - far + 0.5, 0.0, 1.0) * np.exp(0.2 * rng.normal(size=far.shape))
    return image(load + 0.05 * np.abs(rng.normal(size=far.shape)))


QUICK = LocateSettings(quick=True)


@many
@pytest.mark.slow
@pytest.mark.parametrize(
    "step",
    [
        LocateDisc(), LocateEllipse(), LocateRectangle(), Locate(), LocateObjects(),
        LocateDisc(QUICK), LocateEllipse(QUICK), LocateRectangle(QUICK), Locate(settings=QUICK),
    ],
    ids=lambda step: type(step).__name__,
)  # fmt: skip
@pytest.mark.parametrize("shape", [(1, 2), (2, 1), (1, 5), (1, 16), (16, 1)])
def test_no_size_is_impossible_on_a_row(step: object, shape: tuple[int, int]) -> None:
    n = 0
    for seed in range(8):
        try:
            found = step(noisy(*shape, seed))  # type: ignore[operator]
        except Degenerate:
            continue
        shapes = getattr(found, "shapes", None) or [getattr(found, "shape", found)]
        for its in shapes:
            check(its)
            n += 1
    assert n > 0


@plain
@pytest.mark.parametrize("step", [Locate(), LocateEllipse(), LocateDisc(), LocateRectangle()])
def test_a_single_cell_is_refused(step: object) -> None:
    with pytest.raises(Degenerate, match="no reading rises above the noise"):
        step(image([[5.0]]))  # type: ignore[operator]
