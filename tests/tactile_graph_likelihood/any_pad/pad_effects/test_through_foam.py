"""Foam that lies on a pad, undone."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.ndimage import correlate1d
from scipy.stats import norm

from tactile_graph import Circle, Frame, Image
from tactile_graph_likelihood.any_pad.choose import Locate
from tactile_graph_likelihood.any_pad.locate import LocateDisc
from tactile_graph_likelihood.any_pad.pad_effects.foam_undone import FIRST, widest
from tactile_graph_likelihood.any_pad.pad_effects.spread_loads import shares_of, spread, unspread
from tactile_graph_likelihood.any_pad.pad_effects.through_foam import has_no_foam, without_foam
from tactile_graph_likelihood.settings import LocateSettings
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNDER, UNKNOWN
from tactile_graph_likelihood.single.readings import Readings

GRID = np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0])
MIDDLE = 0.5 + 1.3 * np.arange(16)
RADIUS_CM, LEAST = 5.5, 8.0
CENTRES_CM = 9.0, 11.2


def by_foam(width: float) -> np.ndarray:
    far = np.arange(-6, 7)
    return norm.cdf((far + 0.5) / width) - norm.cdf((far - 0.5) / width)


def with_tails(width: float) -> np.ndarray:
    taps = np.exp(-np.abs(np.arange(-6, 7)) / width)
    return taps / taps.sum()


def carried(loads: np.ndarray, taps: np.ndarray) -> np.ndarray:
    for axis in (0, 1):
        loads = correlate1d(loads, taps, axis, mode="constant")
    return loads


def even(u2: np.ndarray) -> np.ndarray:
    return np.ones_like(u2)


def ball(u2: np.ndarray) -> np.ndarray:
    return np.sqrt(np.maximum(1.0 - u2, 0.0))


def pressed(
    seed: int,
    voids: float = 0.15,
    sigma: float = 0.5,
    face: Callable[[np.ndarray], np.ndarray] = even,
) -> np.ndarray:
    """Loads of a disc: nothing beyond it, uneven gains and voids within."""
    rng = np.random.default_rng(seed)
    far = np.hypot(MIDDLE - CENTRES_CM[0], MIDDLE[:, None] - CENTRES_CM[1])
    covered = np.clip(0.5 + RADIUS_CM - far, 0.0, 1.0)
    gains = np.exp(sigma * rng.standard_normal(far.shape))
    borne = covered * face(np.square(far / RADIUS_CM)) * gains
    return 80.0 * borne * (rng.random(far.shape) >= voids)


def readings_of(loads: np.ndarray, least: float = LEAST) -> Readings:
    shows = loads >= least
    logs = np.log(np.maximum(loads, least))
    return Readings(GRID, logs, np.where(shows, np.uint8(ON), np.uint8(UNDER)), int(shows.sum()))


INNER = (slice(1, -1), slice(1, -1))


@pytest.mark.parametrize("width", [0.3, 0.52, 0.9])
def test_loads_are_spread_and_found_again(width: float) -> None:
    loads = np.random.default_rng(3).random((11, 14))
    shares = shares_of.call(width)
    found = spread.call(loads, shares)
    np.testing.assert_allclose(found, carried(loads, by_foam(width)), atol=1e-4)
    unspread.call(found, shares)
    np.testing.assert_allclose(found, loads, atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("width", [0.48, 0.55, 0.62])
def test_the_width_is_that_of_the_foam(width: float) -> None:
    for seed in range(10):
        its = readings_of(carried(pressed(seed), by_foam(width)))
        assert widest.call(np.exp(its.logs), its.states, FIRST) == pytest.approx(width, rel=0.04)


@pytest.mark.slow
def test_loads_under_foam_are_those_that_were_pressed() -> None:
    for seed in range(10):
        loads = pressed(seed)
        found = without_foam(readings_of(carried(loads, by_foam(0.52))))
        assert found is not None
        shows = found.states == ON
        assert found.touched == shows.sum()
        assert (loads[shows] > 0.0).mean() > 0.95
        off = np.abs(found.logs[shows & (loads > 25.0)] - np.log(loads[shows & (loads > 25.0)]))
        assert np.median(off) < 0.05
        bare = (loads == 0.0)[INNER]
        assert (found.states[INNER][bare] == UNDER).mean() > 0.95
        edge = np.ones(loads.shape, bool)
        edge[INNER] = False
        assert (found.states[edge] == UNKNOWN).all()


@pytest.mark.slow
@pytest.mark.parametrize("voids", [0.0, 0.15, 0.4])
def test_a_bare_pad_has_no_foam(voids: float) -> None:
    found = [without_foam(readings_of(pressed(seed, voids))) for seed in range(100)]
    assert sum(its is not None for its in found) <= 3


@pytest.mark.parametrize("face", [even, ball])
@pytest.mark.parametrize("sigma", [0.2, 0.3])
def test_a_bare_pad_of_like_elements_has_no_foam(
    sigma: float, face: Callable[[np.ndarray], np.ndarray]
) -> None:
    found = [without_foam(readings_of(pressed(seed, 0.0, sigma, face))) for seed in range(60)]
    assert sum(its is not None for its in found) <= 5


def test_foam_on_a_pad_of_like_elements_is_seen() -> None:
    foam = [carried(pressed(seed, 0.15, 0.2), by_foam(0.52)) for seed in range(30)]
    assert all(without_foam(readings_of(its)) is not None for its in foam)


@pytest.mark.parametrize("share", [0.01, 0.02, 0.03])
def test_what_carries_less_than_foam_is_left_to_the_fit(share: float) -> None:
    taps = np.array([share, 1.0 - 2.0 * share, share])
    leaking = [has_no_foam(readings_of(carried(pressed(s), taps), 0.3)) for s in range(30)]
    assert not any(leaking)


def test_readings_far_below_their_neighbours_leave_no_foam_possible() -> None:
    bare = [has_no_foam(readings_of(pressed(seed, 0.4))) for seed in range(30)]
    foam = [has_no_foam(readings_of(carried(pressed(s, 0.4), by_foam(0.4)))) for s in range(30)]
    assert sum(bare) >= 20
    assert not any(foam)


@pytest.mark.slow
def test_foam_that_is_too_wide_or_has_tails_is_left_to_the_fit() -> None:
    wide = [without_foam(readings_of(carried(pressed(s), by_foam(1.1)))) for s in range(20)]
    tails = [without_foam(readings_of(carried(pressed(s), with_tails(0.8)))) for s in range(20)]
    assert sum(its is not None for its in wide) <= 2
    assert sum(its is not None for its in tails) <= 6


def test_noise_of_a_hundredth_leaves_the_width_as_it_is() -> None:
    for seed in range(10):
        rng, under = np.random.default_rng(seed), carried(pressed(seed), by_foam(0.5))
        its = readings_of(under + 0.5 * rng.standard_normal(under.shape))
        assert widest.call(np.exp(its.logs), its.states, FIRST) == pytest.approx(0.5, rel=0.08)


def test_it_does_not_matter_how_the_pad_is_held() -> None:
    its = readings_of(carried(pressed(1), by_foam(0.52)))
    turned = its._replace(logs=its.logs.T.copy(), states=its.states.T.copy())
    found, other = without_foam(its), without_foam(turned)
    assert found is not None
    assert other is not None
    np.testing.assert_array_equal(found.states, other.states.T)
    np.testing.assert_allclose(found.logs, other.logs.T, atol=1e-6)


def test_saturated_elements_bear_at_least_what_they_read() -> None:
    loads = pressed(0)
    under = carried(loads, by_foam(0.52))
    its = readings_of(np.minimum(under, 100.0))
    its.states[under > 100.0] = OVER
    found = without_foam(its)
    assert found is not None
    over = (its.states == OVER)[INNER] & (found.states == ON)[INNER]
    assert over.sum() > 3
    off = found.logs[INNER][over] - np.log(loads[INNER][over])
    assert abs(np.median(off)) < 0.3


def test_broken_elements_say_nothing() -> None:
    its = readings_of(carried(pressed(5), by_foam(0.52)))
    broken = np.random.default_rng(5).random(its.states.shape) < 0.05
    found = without_foam(its.without(broken))
    assert found is not None
    assert (found.states[broken] == UNKNOWN).all()
    whole = without_foam(its)
    assert whole is not None
    both = (found.states == ON) & (whole.states == ON) & (whole.logs > math.log(40.0))
    assert np.median(np.abs(found.logs - whole.logs)[both]) < 0.05


@pytest.mark.parametrize("shape", [(1, 16), (2, 16), (16, 2), (3, 3)])
def test_pads_without_elements_within_are_left_as_they_are(shape: tuple[int, int]) -> None:
    its = readings_of(np.full(shape, 50.0))
    assert without_foam(its) is None


def frame_of(loads: np.ndarray) -> Frame:
    return Frame.of(np.where(loads >= LEAST, loads, 0.0), 1.3, (-0.15, -0.15), "gram")


@pytest.mark.slow
def test_a_disc_under_foam_is_found_about_as_well_as_on_a_bare_pad() -> None:
    step = LocateDisc(LocateSettings(gap_cm=0.3))
    off = []
    for seed in range(12):
        loads = pressed(seed)
        for its in (loads, carried(loads, by_foam(0.52))):
            found = step(frame_of(its).image)
            centre = math.hypot(found.x_cm - CENTRES_CM[0], found.y_cm - CENTRES_CM[1])
            off.append([centre, abs(found.radius_cm - RADIUS_CM)])
    bare, foam = np.mean(off[::2], axis=0), np.mean(off[1::2], axis=0)
    assert (foam < 1.5 * bare + 0.02).all()


def test_an_answer_says_that_the_face_is_on_foam() -> None:
    step, loads = LocateDisc(LocateSettings(gap_cm=0.3)), pressed(4)
    bare, foam = (
        step(frame_of(its).image).posterior for its in (loads, carried(loads, by_foam(0.52)))
    )
    assert foam.pressures["foam"] > 0.5
    assert "even" not in foam.pressures
    assert bare.pressures.get("foam", 0.0) < 0.1


def test_foam_that_the_pad_tells_of_is_undone_where_it_explains_the_readings() -> None:
    step = LocateDisc(LocateSettings(gap_cm=0.3, foam_cm=0.35 * 1.3))
    off, untold = [], []
    for seed in range(10):
        image = frame_of(carried(pressed(seed), by_foam(0.35))).image
        its, other = step(image), LocateDisc(LocateSettings(gap_cm=0.3))(image)
        assert its.posterior.pressures["foam"] > 0.5
        off.append(abs(its.radius_cm - RADIUS_CM))
        untold.append(abs(other.radius_cm - RADIUS_CM))
    assert np.mean(off) < 0.8 * np.mean(untold)


def test_foam_that_is_told_wrongly_is_not_believed() -> None:
    bare = frame_of(pressed(3)).image
    told = LocateDisc(LocateSettings(gap_cm=0.3, foam_cm=0.8))(bare)
    assert told.radius_cm == LocateDisc(LocateSettings(gap_cm=0.3))(bare).radius_cm
    assert told.posterior.pressures.get("foam", 0.0) < 0.1


def over_uneven(seed: int, width: float, sigma: float = 0.5, voids: float = 0.15) -> Image:
    """Readings of a disc on foam, under which elements keep gains and voids of their own."""
    rng = np.random.default_rng(seed)
    loads = carried(pressed(seed, 0.0, 0.0), by_foam(width))
    gains = np.exp(sigma * rng.standard_normal(loads.shape))
    return frame_of(loads * gains * (rng.random(loads.shape) >= voids)).image


@pytest.mark.slow
def test_foam_over_uneven_elements_is_no_round_face() -> None:
    step, off, held, foam = LocateDisc(LocateSettings(gap_cm=0.3, quick=True)), [], 0, []
    for seed in range(24):
        found = step(over_uneven(seed, 0.6))
        off.append(abs(found.radius_cm - RADIUS_CM))
        held += found.posterior.contains(Circle(*CENTRES_CM, RADIUS_CM))
        foam.append(found.posterior.pressures.get("foam", 0.0))
    assert np.mean(off) < 0.45
    assert held >= 18
    assert np.mean(foam) > 0.4


@pytest.mark.slow
def test_foam_that_is_told_is_known_over_uneven_elements() -> None:
    untold = LocateDisc(LocateSettings(gap_cm=0.3))
    told = LocateDisc(LocateSettings(gap_cm=0.3, foam_cm=0.6 * 1.3))
    choice = Locate(settings=LocateSettings(gap_cm=0.3, foam_cm=0.6 * 1.3))
    off = []
    for seed in range(10):
        image = over_uneven(seed, 0.6)
        shapes = told(image), untold(image), choice(image).shape
        off.append([abs(getattr(its, "radius_cm", RADIUS_CM) - RADIUS_CM) for its in shapes])
    with_it, without_it, chosen = np.mean(off, axis=0)
    assert with_it < 0.85 * without_it
    assert chosen < 1.5 * with_it
