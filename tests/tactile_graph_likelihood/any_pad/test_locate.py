"""Outlines on pads that are not the one told: places, radii, regions, flags."""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from helpers_likelihood import made
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Image
from tactile_graph_likelihood.any_pad.choose import Locate
from tactile_graph_likelihood.any_pad.fits.left_open import is_scattered
from tactile_graph_likelihood.any_pad.locate import LocateDisc, LocateEllipse, LocateRectangle
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import variance_inflation
from tactile_graph_likelihood.any_pad.uncertainty import under_pressure
from tactile_graph_likelihood.geometry.outlines import DISC
from tactile_graph_likelihood.settings import LocateSettings
from tactile_graph_likelihood.single import readings
from tactile_graph_pads.pad import load_pad

sys.path.insert(0, str(Path(__file__).parents[3] / "benchmarks"))
from second_simulator import BASE, KINDS, Bench

# Machine code is compiled for tests that look at many frames; plain code serves the others.
many = pytest.mark.usefixtures("warm_kernels")
plain = pytest.mark.usefixtures("plain_kernels")


def looked_at(kind, n=18, seed=5, step=None, shape="disc"):
    """Return centres' and radii's errors, regions that hold the truth, and flags."""
    step = step or LocateDisc()
    rows = []
    for frame in Bench(kind, np.random.default_rng(seed)).frames(n, shape):
        (true,) = frame.truth
        found = step.posterior(frame.image)
        x, y, size = found.mean[:3]
        off = math.hypot(x - true.shape.x_cm, y - true.shape.y_cm)
        sized = abs(size - true.shape.radius_cm) if shape == "disc" else 0.0
        rows.append((off, sized, found.contains(true.shape), found.fits))
    return np.mean(np.array(rows, float), axis=0)


def check_a_disc_is_found(kind, centre_cm, radius_cm):
    off, sized, held, fits = looked_at(KINDS[kind])
    assert off < centre_cm
    assert sized < radius_cm
    assert held >= 0.7
    assert fits >= (0.4 if "foam" in kind else 0.7)


@plain
@pytest.mark.parametrize(
    ("kind", "centre_cm", "radius_cm"),
    [
        ("law 1/F", 0.13, 0.12),
        pytest.param("leaning face", 0.22, 0.10, marks=pytest.mark.slow),
    ],
)
def test_a_disc_is_found_on_a_pad_that_nobody_described(kind, centre_cm, radius_cm):
    check_a_disc_is_found(kind, centre_cm, radius_cm)


@many
@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "centre_cm", "radius_cm"),
    [
        ("noise 0", 0.13, 0.08),
        ("noise 3 mV", 0.13, 0.08),
        ("noise 5 mV", 0.14, 0.09),
        ("drift 5 mV", 0.13, 0.08),
        ("turn-on 2 g", 0.10, 0.07),
        ("saturation 60 g", 0.14, 0.12),
        ("gains 0.2", 0.07, 0.13),
        ("voids 0.4", 0.14, 0.11),
        ("strays 4 %", 0.20, 0.12),
        ("dead column", 0.14, 0.09),
        ("foam 0.6 cells", 0.30, 0.20),
    ],
)
def test_a_disc_is_found_on_more_pads_that_nobody_described(kind, centre_cm, radius_cm):
    check_a_disc_is_found(kind, centre_cm, radius_cm)


@many
@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "centre_cm"),
    [
        ("noise 1 mV", 0.13),
        ("law 1/F", 0.13),
        ("leaning face", 0.22),
        ("foam 0.6 cells", 0.30),
        ("small objects", 0.25),
    ],
)
def test_a_quick_disc_is_as_good_and_no_surer_than_it_may_be(kind, centre_cm):
    off, _, held, _ = looked_at(KINDS[kind], step=made(LocateDisc, quick=True))
    assert off < centre_cm
    assert held >= 0.8


@pytest.mark.slow
@many
def test_a_quick_disc_is_sampled_where_it_is_vaguer_than_allowed():
    frames = [*Bench(KINDS["gains 0.9"], np.random.default_rng(7)).frames(12, "disc")]
    quick = [made(LocateDisc, quick=True)(f.image) for f in frames]
    stds = sorted(found.centre_std_cm for found in quick)
    always = [made(LocateDisc, quick=True, sampled_above_cm=0.0)(f.image) for f in frames]
    # The distribution around the likeliest disc is narrower than what is told of any pad.
    middle_cm = 0.8 * stds[len(stds) // 2]
    some = [made(LocateDisc, quick=True, sampled_above_cm=middle_cm)(f.image) for f in frames]
    which = [[*map(found.__eq__, pair)] for found, *pair in zip(some, quick, always, strict=True)]
    assert all(any(pair) for pair in which)
    assert [False, True] in which
    assert [True, False] in which


@pytest.mark.slow
@many
def test_of_few_elements_an_outline_is_sampled_as_much_more_precisely(monkeypatch):
    step = LocateDisc()
    frames = [*Bench(KINDS["small objects"], np.random.default_rng(3)).frames(24, "disc")]

    def worth():
        return np.mean([step.posterior(frame.image).equal_points for frame in frames])

    finer = worth()
    monkeypatch.setattr(under_pressure, "FINER", 0.0)
    assert finer > 2.0 * worth() > 2.0 * step._any_pad.told.precision**-2


@pytest.mark.slow
@plain
def test_on_a_large_pad_a_quick_disc_is_the_disc(monkeypatch):
    monkeypatch.setattr(readings, "MANY", 100)
    rng = np.random.default_rng(3)
    y, x = np.mgrid[:40, :40]
    values = np.where(np.hypot(x - 20.3, y - 19.6) < 8.0, 100.0, 0.0)
    values *= np.exp(0.3 * rng.standard_normal(values.shape))
    image = Image(values, (1.3, 1.3), (-0.15, -0.15), "gram")
    one, other = (made(LocateDisc, quick=quick)(image) for quick in (False, True))
    assert (one.x_cm, one.radius_cm, one.fits) == (other.x_cm, other.radius_cm, other.fits)
    one, other = (
        made(Locate, shapes=["disc"], quick=quick)(image).shape for quick in (False, True)
    )
    assert (one.x_cm, one.radius_cm, one.fits) == (other.x_cm, other.radius_cm, other.fits)


@pytest.mark.slow
@plain
def test_an_object_over_the_edge_is_found():
    off, sized, held, _ = looked_at(KINDS["over the edge"])
    assert off < 0.4
    assert sized < 0.25
    assert held >= 0.7


@pytest.mark.slow
@plain
def test_where_next_to_nothing_shows_it_says_so():
    few = replace(KINDS["turn-on 40 g"], discs=((1860.0, 6.8),))
    off, _, held, fits = looked_at(few)
    assert off > 0.5
    assert held >= 0.7
    assert fits <= 0.2


@many
@pytest.mark.slow
def test_a_rectangle_is_found_on_a_pad_that_nobody_described():
    for kind in ("noise 3 mV", "law 1/F"):
        off, _, held, _ = looked_at(KINDS[kind], step=LocateRectangle(), shape="rectangle")
        assert off < 0.3
        assert held >= 0.7


@many
@pytest.mark.slow
def test_a_quick_rectangle_is_as_good_and_no_surer_than_it_may_be():
    quick = made(LocateRectangle, quick=True)
    for kind, centre_cm in (("noise 3 mV", 0.3), ("law 1/F", 0.3)):
        off, _, held, _ = looked_at(KINDS[kind], step=quick, shape="rectangle")
        assert off < centre_cm
        assert held >= 0.8


@many
@pytest.mark.slow
def test_a_quick_rectangle_over_the_edge_says_how_little_is_known():
    _, _, held, fits = looked_at(
        KINDS["over the edge"], step=made(LocateRectangle, quick=True), shape="rectangle"
    )
    assert held >= 0.6
    assert fits <= 0.6


@pytest.mark.slow
@plain
def test_a_quick_choice_has_no_sample():
    (frame,) = Bench(KINDS["noise 1 mV"], np.random.default_rng(3)).frames(1)
    (true,) = frame.truth
    full, quick = (made(Locate, quick=quick)(frame.image) for quick in (False, True))
    assert quick.name == full.name == "disc"
    assert math.hypot(quick.shape.x_cm - full.shape.x_cm, quick.shape.y_cm - full.shape.y_cm) < 0.1
    assert math.hypot(quick.shape.x_cm - true.shape.x_cm, quick.shape.y_cm - true.shape.y_cm) < 0.3
    assert np.ptp(quick.shape.posterior.weights) == 0.0
    assert np.ptp(full.shape.posterior.weights) > 0.0


def test_scattered_noise_is_not_looked_at_for_long():
    cells = np.zeros((16, 16))
    cells[[2, 3, 11, 13], [3, 12, 5, 14]] = 1.0
    readings = observed(Image(cells, (1.3, 1.3), (-0.15, -0.15), "counts"), load_pad("thesis"))
    wide = np.array([10.0, 10.0, 9.0, 0.0])
    assert is_scattered(DISC, readings, wide)
    assert not is_scattered(DISC, readings, np.array([10.0, 10.0, 1.5, 0.0]))
    assert not is_scattered(DISC, readings._replace(touched=6), wide)


@many
@pytest.mark.slow
def test_a_quick_choice_names_as_many_shapes():
    right = dict.fromkeys((False, True), 0)
    for quick in right:
        step, bench = (
            made(Locate, quick=quick),
            Bench(KINDS["noise 3 mV"], np.random.default_rng(1)),
        )
        for shape in ("disc", "rectangle"):
            right[quick] += sum(step(f.image).name == shape for f in bench.frames(6, shape))
    assert right[True] >= right[False] - 1


@many
@pytest.mark.slow
def test_the_shape_is_told_by_the_evidence():
    step, right = Locate(), 0
    bench = Bench(KINDS["noise 3 mV"], np.random.default_rng(1))
    for shape in ("disc", "rectangle"):
        for frame in bench.frames(6, shape):
            found = step(frame.image)
            assert found.disc + found.ellipse + found.rectangle == pytest.approx(1.0)
            assert found.probability == getattr(found, found.name)
            right += found.name == shape
    assert right >= 10


@many
@pytest.mark.slow
@pytest.mark.parametrize("kind", ["3 stuck elements", "strays 1 %", "gains correlated"])
def test_a_good_answer_is_hardly_ever_flagged(kind):
    off, _, _, fits = looked_at(KINDS[kind], 60)
    assert off < 0.15
    assert fits >= 0.9


@many
@pytest.mark.slow
def test_what_is_flagged_is_further_off():
    frames = Bench(KINDS["turn-on 40 g"], np.random.default_rng(5)).frames(60)
    off, fits = [], []
    for frame in frames:
        (true,), found = frame.truth, LocateDisc().posterior(frame.image)
        off.append(math.dist(found.mean[:2], (true.shape.x_cm, true.shape.y_cm)))
        fits.append(found.fits)
    far, near = np.array(off)[~np.array(fits)], np.array(off)[fits]
    assert 5 < far.size < 40
    assert far.mean() > 3.0 * near.mean()


@many
@pytest.mark.slow
def test_an_ellipse_that_is_hardly_one_is_a_disc():
    frame = next(iter(Bench(BASE, np.random.default_rng(1)).frames(1)))
    found, (true,) = LocateEllipse()(frame.image), frame.truth
    assert found.semi_major_cm == pytest.approx(true.shape.radius_cm, abs=0.4)
    assert found.semi_minor_cm == pytest.approx(true.shape.radius_cm, abs=0.4)


@plain
def test_readings_need_no_quantity_and_no_scale():
    """Counts of a circuit that nobody knows, from a zero of their own."""
    rng = np.random.default_rng(3)
    y, x = np.mgrid[0:16, 0:16] * 1.3 + 0.5
    load = np.where(
        np.hypot(x - 9.0, y - 11.0) < 5.0, np.exp(0.4 * rng.standard_normal(x.shape)), 0
    )
    counts = np.round(512.0 + 200.0 * load + 3.0 * rng.standard_normal(x.shape))
    found = LocateDisc()(Image(counts, (1.3, 1.3), (-0.15, -0.15), "counts"))
    assert math.hypot(found.x_cm - 9.0, found.y_cm - 11.0) < 0.35
    assert found.radius_cm == pytest.approx(5.0, abs=0.5)
    assert found.fits


@pytest.mark.slow
def test_an_even_pad_that_reads_in_proportion_is_not_taken_for_a_law_of_its_own():
    """Where gains scatter by a tenth and nobody says so, radii are right and regions hold them."""
    rng, at = np.random.default_rng(12), (np.arange(12 * 9) + 0.5) / 9.0
    offs, held = [], []
    for _ in range(40):
        radius = rng.uniform(2.2, 4.0)
        x, y = rng.uniform(radius, 12.0 - radius, 2)
        inside = np.hypot(at[None, :] - x, at[:, None] - y) < radius
        covered = inside.reshape(12, 9, 12, 9).mean((1, 3))
        values = 100.0 * covered * np.exp(0.1 * rng.standard_normal((12, 12)))
        values += 0.5 * rng.standard_normal((12, 12))
        found = LocateDisc()(Image(values, (1.0, 1.0)))
        offs.append(found.radius_cm - radius)
        held.append(found.posterior.contains(Circle(x, y, radius)))
    assert abs(np.mean(offs)) < 0.05
    assert np.mean(held) > 0.5


@pytest.mark.slow
@plain
def test_cells_that_are_nearly_square_lie_where_they_lie():
    rng = np.random.default_rng(8)
    y, x = np.mgrid[0:30, 0:20] + 0.5
    near = np.hypot(x - 8.0, y - 24.0) < 4.0
    counts = 5.0 * rng.standard_normal(x.shape) + near * rng.uniform(150.0, 250.0, x.shape)
    square = LocateDisc()(Image(counts, (0.5, 0.5), (0.0, 0.0), "counts"))
    lower = LocateDisc()(Image(counts, (0.5, 0.49), (0.0, 0.0), "counts"))
    assert lower.x_cm == pytest.approx(square.x_cm, rel=1e-3)
    assert lower.y_cm == pytest.approx(0.98 * square.y_cm, rel=1e-3)
    assert lower.radius_cm == pytest.approx(math.sqrt(0.98) * square.radius_cm, rel=1e-3)
    assert lower.posterior.contains(Circle(4.0, 24.0 * 0.49, 2.0))


@plain
def test_noise_alone_is_no_object():
    rng = np.random.default_rng(4)
    image = Image(np.zeros((16, 16)), (1.3, 1.3), (0.0, 0.0), "volt")
    with pytest.raises(Degenerate, match="no reading rises above the noise"):
        LocateDisc()(image)
    risen = 0
    for _ in range(20):
        noise = image.with_values(1e-3 * rng.standard_normal((16, 16)))
        try:
            LocateDisc()(noise)
        except Degenerate:
            continue
        risen += 1
    assert risen <= 3


@pytest.mark.slow
@plain
def test_the_same_frame_has_the_same_answer():
    frame = next(iter(Bench(BASE, np.random.default_rng(6)).frames(1)))
    one, other = (LocateDisc().posterior(frame.image) for _ in range(2))
    assert np.array_equal(one.mean, other.mean)
    assert np.array_equal(one.covariance, other.covariance)


@pytest.mark.parametrize(
    ("neighbours", "least", "most"), [(0.0, 1.0, 1.0), (1.5, 1.0, 1.2), (6.0, 1.4, 2.2)]
)
def test_what_hangs_together_widens(neighbours, least, most):
    assert least <= variance_inflation(neighbours, 60) <= most


@many
@pytest.mark.slow
@plain
@pytest.mark.parametrize(
    ("kind", "least", "most"), [("gains correlated", 1.2, 2.0), ("8 bits", 1, 1)]
)
def test_where_neighbours_are_alike_gains_scatter_more_than_they_seem_to(
    kind, least, most, monkeypatch
):
    (frame,) = Bench(KINDS[kind], np.random.default_rng(6)).frames(1)
    learned, ratios = under_pressure.learned, []

    def kept(*args):
        *its, shared = args
        noise = learned(*its, shared)
        ratios.append(noise.sigma / learned(*its, 1.0).sigma)
        return noise

    monkeypatch.setattr(under_pressure, "learned", kept)
    LocateDisc().posterior(frame.image)
    assert least <= ratios[-1] <= most


def test_an_outline_lies_on_the_pad_mostly():
    """One whose rim is as likely beyond the pad's edge as before it comes out before it."""
    frame = next(iter(Bench(BASE, np.random.default_rng(7)).frames(1)))
    logs = {
        on_pad: LocateDisc(LocateSettings(on_pad=on_pad)).posterior(frame.image)
        for on_pad in ("whole", "mostly", "partly")
    }
    assert logs["mostly"].mean[:3] == pytest.approx(logs["whole"].mean[:3], abs=0.05)
    assert logs["partly"].mean[:3] == pytest.approx(logs["whole"].mean[:3], abs=0.15)


def counted(rng, circle, load):
    """Return an image of whole counts, of noise 1, of a disc on a pad of 16 x 16 cells of 1 cm."""
    points = (np.arange(16 * 9) + 0.5) / 9.0
    inside = np.hypot(points - circle.x_cm, points[:, None] - circle.y_cm) < circle.radius_cm
    share = inside.reshape(16, 9, 16, 9).mean(axis=(1, 3))
    loads = load * share * np.exp(rng.normal(0.0, 0.3, (16, 16)))
    return np.round(rng.standard_normal((16, 16)) + loads)


@pytest.mark.slow
@many
@pytest.mark.parametrize(
    ("lowest", "highest", "load"), [(0.0, 65535.0, 300.0), (-99.0, 255.0, 3000.0)]
)
def test_a_device_that_ends_at_zero_or_saturates_costs_hardly_anything(lowest, highest, load):
    rng, step = np.random.default_rng(9), LocateDisc()
    true, errors = Circle(8.2, 7.7, 4.9), []
    for _ in range(8):
        values = np.clip(counted(rng, true, load), lowest, highest)
        found = step(Image(values, (1.0, 1.0), (0.0, 0.0), "counts"))
        centre = math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm)
        errors.append((centre, abs(found.radius_cm - true.radius_cm)))
    assert np.mean(errors, axis=0).max() < 0.15
