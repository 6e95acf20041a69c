"""Outlines on pads of more than 1024 elements, by a law or a circuit that nobody has told."""

from typing import NamedTuple

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from tactile_graph import Image, load
from tactile_graph.wires import Circle
from tactile_graph_likelihood.any_pad.locate import LocateDisc
from tactile_graph_likelihood.settings import LocateSettings

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

SIDE, PITCH_CM, FINE = 40, 0.5, 10


class Pad(NamedTuple):
    """Elements a side, the part of a pitch that senses, foam on it; and radii of discs."""

    side: int = SIDE
    sensing: slice = slice(FINE)
    foam_cells: float = 0.0
    radii: tuple[float, float] = (6.0, 9.0)


PLAIN = Pad()


def loaded(rng: np.random.Generator, pad: Pad = PLAIN) -> tuple[np.ndarray, Circle]:
    """Return the load on elements of various gains under a disc, in grams."""
    radius = PITCH_CM * rng.uniform(*pad.radii)
    x, y = rng.uniform(radius, pad.side * PITCH_CM - radius, 2)
    places = (np.arange(pad.side * FINE) + 0.5) * PITCH_CM / FINE
    inside = (places - x) ** 2 + (places[:, None] - y) ** 2 <= radius**2
    inside = inside.reshape(pad.side, FINE, pad.side, FINE)[:, pad.sensing][..., pad.sensing]
    share = inside.mean(axis=(1, 3))
    if pad.foam_cells:
        share = gaussian_filter(share, pad.foam_cells)
    load_g = 400.0 * share * np.exp(0.3 * rng.standard_normal(share.shape))
    load_g *= rng.random(share.shape) > 0.05
    return load_g, Circle(float(x), float(y), radius)


def pressed(
    rng: np.random.Generator, exponent: float, pad: Pad = PLAIN
) -> tuple[np.ndarray, Circle]:
    """Return a divider's volts under a disc."""
    load_g, true = loaded(rng, pad)
    siemens = np.where(load_g > 10.0, (load_g / 100.0) ** exponent / 80e3, 0.0)
    volts = 5.0 * siemens / (1.0 / 33e3 + siemens.sum(axis=0))
    return volts + 5e-4 * rng.standard_normal(load_g.shape), true


def test_a_law_of_another_exponent_leaves_the_truth_within_the_region() -> None:
    pipeline, rng = load("locate-circle"), np.random.default_rng(31)
    held = errors = 0.0
    for _ in range(20):
        volts, true = pressed(rng, 1.15)
        found = pipeline.run(Image(volts, (PITCH_CM,) * 2, quantity="volt"))["circle"]
        held += found.fits and found.posterior.contains(true)
        errors += (found.radius_cm - true.radius_cm) / 20
    assert held >= 14
    assert abs(errors) < 0.03 * PITCH_CM


def test_counts_of_a_divider_are_not_flagged_for_its_own_pattern() -> None:
    pipeline, rng = load("locate-circle"), np.random.default_rng(32)
    held = fits = 0
    for _ in range(12):
        volts, true = pressed(rng, 1.463)
        counts = np.round(np.clip(volts, 0.0, 5.0) / 5.0 * 4095.0)
        found = pipeline.run(Image(counts, (PITCH_CM,) * 2))["circle"]
        held += found.posterior.contains(true)
        fits += found.fits
    assert fits >= 11
    assert held >= 9


def test_foam_is_undone_as_on_a_small_pad() -> None:
    pipeline, rng = load("locate-circle"), np.random.default_rng(33)
    held = fits = errors = 0.0
    for _ in range(12):
        volts, true = pressed(rng, 1.463, Pad(foam_cells=0.7))
        found = pipeline.run(Image(volts, (PITCH_CM,) * 2, quantity="volt"))["circle"]
        fits += found.fits
        held += found.posterior.contains(true)
        errors += abs(found.radius_cm - true.radius_cm) / 12
    assert fits >= 11
    assert held >= 9
    assert errors < 0.12 * PITCH_CM


def test_a_wide_outline_knows_that_nobody_told_its_elements_gap() -> None:
    rng, untold = np.random.default_rng(34), LocateDisc()
    told = LocateDisc(LocateSettings(gap_cm=0.2 * PITCH_CM))
    for _ in range(3):
        load_g, _ = loaded(rng, Pad(100, slice(1, FINE - 1), radii=(40.0, 48.0)))
        assert (load_g > 0.0).sum() > 4096
        image = Image(load_g, (PITCH_CM,) * 2, quantity="gram")
        found, surer = untold(image), told(image)
        assert found.radius_cm == pytest.approx(surer.radius_cm, abs=0.03 * PITCH_CM)
        assert surer.radius_std_cm < found.radius_std_cm < 0.25 * PITCH_CM


@pytest.mark.parametrize("sensing", [slice(FINE), slice(1, FINE), slice(2, FINE - 1)])
def test_a_wide_outline_is_as_large_as_it_is_whatever_the_gap(sensing: slice) -> None:
    locate, rng = LocateDisc(), np.random.default_rng(36)
    middle_cm = 0.5 * PITCH_CM / FINE * ((sensing.start or 0) + sensing.stop - FINE)
    held, fits, errors = 0, 0, []
    for _ in range(8):
        load_g, true = loaded(rng, Pad(96, sensing, radii=(40.0, 46.0)))
        found = locate(Image(load_g, (PITCH_CM,) * 2, quantity="gram"))
        shifted = Circle(true.x_cm - middle_cm, true.y_cm - middle_cm, true.radius_cm)
        held += found.posterior.contains(shifted)
        fits += found.fits
        errors.append(found.radius_cm - true.radius_cm)
    assert abs(np.mean(errors)) < 0.03 * PITCH_CM
    assert held >= 7
    assert fits >= 7


def test_where_a_limit_holds_what_a_wide_outline_reads_its_size_says_that_the_gap_is_open() -> None:
    locate, rng = LocateDisc(), np.random.default_rng(37)
    for _ in range(2):
        load_g, true = loaded(rng, Pad(100, slice(FINE), radii=(40.0, 46.0)))
        most_g = float(np.quantile(load_g[load_g > 0.0], 0.5))
        limited = np.minimum(load_g, most_g) + rng.normal(0.0, 0.003 * most_g, load_g.shape)
        found = locate(Image(limited, (PITCH_CM,) * 2, quantity="gram"))
        assert found.posterior.contains(true)
        assert found.radius_std_cm > 0.1 * PITCH_CM
