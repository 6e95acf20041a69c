"""Outlines found in images that the model itself has made."""

import math

import numpy as np
import pytest

from helpers_likelihood import NOISE, drawn, made
from helpers_modes import answered_by
from tactile_graph.engine.tables.rows import as_data
from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph.wires import Circle, Ellipse, Image, Polygon, Rectangle
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, packed, unpacked
from tactile_graph_likelihood.single.fit_footprint import FitFootprint
from tactile_graph_likelihood.single.footprint_of import FootprintDisc, FootprintRectangle
from tactile_graph_likelihood.single.likely import LikelyCircle, LikelyPolygon, likely
from tactile_graph_likelihood.single.model import Model

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

DISCS = Model(DISC, noise=NOISE, whole=True)
SLABS = Model(RECTANGLE, noise=NOISE, whole=True)


def discs(n, seed, **noise):
    rng = np.random.default_rng(seed)
    for _ in range(n):
        radius = rng.uniform(3.0, 7.0)
        shape = Circle(*rng.uniform(radius, 20.5 - radius, 2), radius)
        yield shape, drawn(shape, 60.0, rng, **noise)


def slabs(n, seed):
    rng = np.random.default_rng(seed)
    for _ in range(n):
        shape = Rectangle(*rng.uniform(8.5, 12.0, 2), 14.0, 5.0, rng.uniform(-1.5, 1.5))
        yield shape, drawn(shape, 60.0, rng)


def test_discs_are_found_as_well_as_they_say():
    scores, errors, inside = [], [], 0
    for shape, image in discs(150, 1):
        found = DISCS.posterior(image)
        off = found.mean[:3] - packed(shape)[2]
        errors.append(math.hypot(*off[:2]))
        scores.append(off @ np.linalg.solve(found.covariance[:3, :3], off))
        inside += found.contains(shape)
        assert found.contains(unpacked(DISC, 0, found.mean))
    assert np.mean(errors) < 0.1
    assert 2.2 < np.mean(scores) < 4.5  # 3 if the covariance is right
    assert 0.83 <= inside / 150 <= 0.97


def test_a_line_tells_its_numbers_and_pressures_and_not_its_points():
    _, image = next(discs(1, 1))
    found = likely(DISCS.posterior(image))
    told = as_data(found, full=False)
    assert {"x_cm", "y_cm", *found.columns_shown} < set(told)
    assert told["posterior"]["equal_points"] == found.posterior.equal_points
    assert told["posterior"]["pressures"] == {"even": 1.0}
    left_out = set(as_data(found)["posterior"]) - set(told["posterior"])
    assert left_out == {"mean", "covariance", "points", "weights", "most_likely"}


def test_rectangles_are_found_and_their_sides_ordered():
    off, angles, inside = [], [], 0
    for shape, image in slabs(40, 2):
        posterior = SLABS.posterior(image)
        found = likely(posterior)
        assert isinstance(found, Rectangle)
        assert found.length_cm >= found.breadth_cm
        off.append(math.hypot(found.x_cm - shape.x_cm, found.y_cm - shape.y_cm))
        angles.append(abs(math.remainder(found.angle_rad - shape.angle_rad, math.pi)))
        inside += posterior.contains(shape)
    assert np.mean(off) < 0.15
    assert np.mean(angles) < math.radians(1.2)
    assert inside >= 30


def test_the_same_seed_gives_the_same_bits():
    _, image = next(discs(1, 5))
    one, two = DISCS.posterior(image), DISCS.posterior(image)
    np.testing.assert_array_equal(one.points, two.points)
    assert one.log_evidence == two.log_evidence
    other = Model(DISC, noise=NOISE, whole=True, seed=1).posterior(image)
    assert other.mean == pytest.approx(one.mean, abs=0.05)
    assert not np.array_equal(other.mean, one.mean)


def test_precision_is_what_more_points_would_not_change():
    for _, image in discs(20, 6):
        quick, long = (
            Model(DISC, noise=NOISE, precision=p, most_points=4096).posterior(image)
            for p in (0.15, 0.02)
        )
        assert len(long.points) > 4 * len(quick.points)
        spread = np.sqrt(np.diag(long.covariance))
        assert np.abs((quick.mean - long.mean) / spread).max() < 0.5
        assert quick.log_evidence == pytest.approx(long.log_evidence, abs=0.6)


def test_plain_and_compiled_agree():
    shape, image = next(discs(1, 9))
    del shape
    model = Model(DISC, noise=NOISE, most_points=32, precision=1.0)
    fast = model.posterior(image)
    with answered_by("plain"):
        plain = model.posterior(image)
    np.testing.assert_allclose(plain.mean, fast.mean, rtol=1e-6)
    assert plain.log_evidence == pytest.approx(fast.log_evidence, rel=1e-6)


def test_a_start_is_used_and_one_of_another_shape_refused():
    shape, image = next(discs(1, 11))
    found = DISCS.posterior(image, start=shape)
    assert found.mean == pytest.approx(DISCS.posterior(image).mean, abs=0.05)
    with pytest.raises(ValueError, match="start: a Rectangle is not of the shape"):
        DISCS.posterior(image, start=Rectangle(8.0, 8.0, 4.0, 2.0, 0.0))


def test_a_belief_pulls_and_narrows():
    shape, image = next(discs(1, 12))
    free = DISCS.posterior(image)
    mean = packed(shape)[2] + np.array([0.3, 0.0, 0.0])
    pulled = DISCS.posterior(image, belief=(mean, np.diag([1e6, 0.0, 0.0])))
    assert pulled.mean[0] == pytest.approx(mean[0], abs=0.01)
    assert pulled.std(0) < 0.01 < free.std(0)


def test_another_shape_or_unevenness_raises_the_flag():
    step, slab = (
        made(FootprintDisc, sigma=0.48, voids=0.16, shows_from=5.0),
        made(FootprintRectangle),
    )
    assert sum(step(image).fits for _, image in discs(30, 13)) >= 28
    assert sum(slab(image).fits for _, image in slabs(10, 13)) >= 9
    assert sum(step(image).fits for _, image in slabs(10, 14)) <= 1


def test_broken_elements_say_nothing():
    shape, image = next(discs(1, 15))
    values = image.values.copy()
    valid = np.ones(values.shape, bool)
    row, column = int(shape.y_cm / 1.3), int(shape.x_cm / 1.3)
    valid[row - 1 : row + 2, column] = False
    values[~valid] = 0.0
    hidden = DISCS.posterior(Image(values, image.pitch_cm, image.origin_cm, "gram", valid))
    seen = DISCS.posterior(Image(values, image.pitch_cm, image.origin_cm, "gram"))
    assert hidden.log_evidence > seen.log_evidence + 2.0
    assert hidden.mean[:3] == pytest.approx(packed(shape)[2], abs=0.3)


def test_an_object_partly_off_the_pad_is_found():
    shape = Circle(2.0, 10.0, 5.0)
    image = drawn(shape, 80.0, np.random.default_rng(16))
    found = Model(DISC, noise=NOISE, whole=False).posterior(image)
    assert found.mean[:3] == pytest.approx(packed(shape)[2], abs=0.4)
    assert Model(DISC, noise=NOISE, whole=True).posterior(image).log_evidence < (
        found.log_evidence - 10.0
    )


def test_unevenness_is_estimated_with_the_object():
    even = Model(DISC, noise=Model(DISC, noise=NOISE).noise.__class__(
        0.5, 0.1, 1e-3, 5.0, 0.0, ("sigma", "voids")))  # fmt: skip
    found = [even.posterior(im).mean for _, im in discs(30, 17, sigma=0.25, voids=0.3)]
    assert np.mean([math.exp(m[4]) for m in found]) == pytest.approx(0.25, rel=0.15)
    assert np.mean([1.0 / (1.0 + math.exp(-m[5])) for m in found]) == pytest.approx(0.3, abs=0.06)


@pytest.mark.parametrize(
    ("shape", "settings", "kind"),
    [
        (Circle(9.0, 10.0, 4.0), {"shape": "disc"}, LikelyCircle),
        (Ellipse(9.0, 10.0, 6.0, 3.0, 0.5), {"shape": "ellipse"}, Ellipse),
        (Rectangle(9.0, 10.0, 9.0, 5.0, 0.5), {"shape": "rectangle"}, Rectangle),
        (
            Polygon(9.0 + 5.0 * np.array([[1.0, 0], [-0.5, 0.866], [-0.5, -0.866]])),
            {"shape": "regular", "corners": 3},
            LikelyPolygon,
        ),
        (
            Polygon(np.array([[3.0, 4.0], [14.0, 5.0], [15.0, 12.0], [5.0, 13.0]])),
            {"shape": "polygon", "corners": 4},
            LikelyPolygon,
        ),
    ],
    ids=lambda v: v.get("shape") if isinstance(v, dict) else "",
)
def test_every_shape_is_found(shape, settings, kind):
    image = drawn(shape, 80.0, np.random.default_rng(18))
    found = made(FitFootprint, **settings)(image)
    assert isinstance(found, kind)
    assert math.hypot(found.x_cm - shape.x_cm, found.y_cm - shape.y_cm) < 0.4
    assert found.area_cm2 == pytest.approx(shape.area_cm2, rel=0.12)
    assert found.fits


def test_what_holds_no_answer_says_why():
    empty = Image(np.zeros((16, 16)), (1.3, 1.3), (-0.15, -0.15), "gram")
    with pytest.raises(Degenerate, match="no element bears a load"):
        made(FootprintDisc)(empty)
    part = Image(
        empty.values, (1.3, 1.3), (-0.15, -0.15), "gram", np.arange(256).reshape(16, 16) > 3
    )
    with pytest.raises(
        Degenerate, match=r"no element with a valid reading .* \(4 of 256 have none"
    ):
        made(FootprintDisc)(part)
    oblong = Image(np.ones((4, 4)), (1.3, 1.0), (0.0, 0.0), "gram")
    with pytest.raises(RuleError, match="needs square cells"):
        made(FootprintDisc)(oblong)
    with pytest.raises(RuleError, match=r"gap_cm: must be below the pitch of 0\.2 cm"):
        made(FootprintDisc)(Image(np.ones((4, 4)), (0.2, 0.2), (0.0, 0.0), "gram"))
    bad = Image(np.full((4, 4), np.nan), (1.3, 1.3), (0.0, 0.0), "gram")
    with pytest.raises(DataError, match="NaN or infinity"):
        made(FootprintDisc)(bad)
    with pytest.raises(ValueError, match="smallest_cm: must be below largest_cm"):
        made(FootprintDisc, smallest_cm=5.0, largest_cm=2.0)


def test_one_touched_element_gives_an_answer_that_is_not_sure_of_itself():
    values = np.zeros((16, 16))
    values[5, 6] = 200.0
    found = made(FootprintDisc)(Image(values, (1.3, 1.3), (-0.15, -0.15), "gram"))
    assert math.hypot(found.x_cm - 8.3, found.y_cm - 7.0) < 0.3
    assert found.centre_std_cm > 0.2


def test_an_image_in_another_unit_is_told_which_setting_says_what_shows() -> None:
    image = Image(np.full((16, 16), 0.4), (1.3, 1.3), (-0.15, -0.15), "raw")
    with pytest.raises(Degenerate, match=r"no reading reaches 5, .*shows_from.* largest is 0\.4"):
        made(FootprintDisc)(image)


def test_readings_that_are_no_numbers_of_a_pad_are_refused() -> None:
    image = Image(np.full((16, 16), 1e150), (1.3, 1.3), (-0.15, -0.15), "raw")
    with pytest.raises(DataError, match=r"readings must be at most 1e\+100, got 1e\+150"):
        made(FootprintDisc)(image)
