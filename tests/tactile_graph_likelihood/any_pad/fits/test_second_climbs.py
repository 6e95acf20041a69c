"""What one climb misses, the second finds: likelier outlines, and nearer to the truth."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

from tactile_graph_likelihood.any_pad.fits import localise
from tactile_graph_likelihood.any_pad.fits.second_climbs import grown_beyond
from tactile_graph_likelihood.any_pad.locate import LocateDisc, LocateEllipse, LocateRectangle
from tactile_graph_likelihood.any_pad.observation.clump import without_alone, without_lone
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.any_pad.uncertainty.around import posterior_around
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE
from tactile_graph_likelihood.single.any_pressure import EVEN
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, UNKNOWN
from tactile_graph_likelihood.single.readings import Readings

sys.path.insert(0, str(Path(__file__).parents[4] / "benchmarks"))
from second_simulator import KINDS, Bench

PITCH, SIDE, N = 1.3, 1.0, 12
GRID = np.array([0.0, 0.0, PITCH, SIDE, 0.0, 0.0])
WIDE = N * PITCH - (PITCH - SIDE)


def readings(*touched, unknown=()):
    states = np.full((N, N), OFF, np.uint8)
    for place in touched:
        states[place] = ON
    for place in unknown:
        states[place] = UNKNOWN
    return Readings(GRID, np.zeros((N, N)), states, len(touched))


BLOCK = [(i, j) for i in range(3, 7) for j in range(3, 7)]


def test_what_has_no_touched_neighbour_says_nothing():
    found = without_lone(readings(*BLOCK, (0, 0), (10, 3), (10, 4)))
    assert found.touched == len(BLOCK)
    assert {tuple(map(int, p)) for p in np.argwhere(found.states == UNKNOWN)} == {
        (0, 0), (10, 3), (10, 4)
    }  # fmt: skip
    assert without_lone(readings(*BLOCK)) is None


def test_an_element_between_broken_ones_is_not_lone():
    broken = [(i, j) for i in (4, 5, 6) for j in (4, 5, 6) if (i, j) != (5, 5)]
    assert without_lone(readings((5, 5), unknown=broken)) is None
    assert without_lone(readings((5, 5))).touched == 0


def test_what_stands_alone_away_from_the_others_says_nothing_of_where_a_disc_is_looked_for_first():
    found = without_alone(readings(*BLOCK, (0, 0), (9, 3), (9, 4), (8, 8)))
    assert found.touched == len(BLOCK)
    assert not found.shows[[0, 9, 9, 8], [0, 3, 4, 8]].any()


@pytest.mark.parametrize(
    "lone",
    [
        pytest.param([], id="none stands alone"),
        pytest.param([(7, 7)], id="beside the others"),
        pytest.param([(10, 1), (10, 2), (10, 3)], id="two neighbours"),
        pytest.param([(0, i) for i in range(0, 12, 2)] + [(11, 0), (11, 2), (11, 4)], id="many"),
    ],
)
def test_what_does_not_stand_alone_or_is_near_or_common_is_no_stray(lone):
    assert without_alone(readings(*BLOCK, *lone)) is None


@pytest.mark.parametrize(
    ("x", "y", "toward"),
    [
        (WIDE - 1.0, 8.0, (1, 0)),
        (1.0, 8.0, (-1, 0)),
        (8.0, WIDE - 1.0, (0, 1)),
        (8.0, 1.0, (0, -1)),
    ],
)
def test_a_disc_that_is_cut_off_grows_beyond_the_edge_and_keeps_its_rim_on_the_pad(x, y, toward):
    p = np.array([x, y, 2.0, 3.0, 0.0, 0.0])
    found = grown_beyond(DISC, readings(*BLOCK), p)
    assert found[2] > p[2]
    for far in (0, 1):  # the rim opposite to the edge
        assert (
            found[far] - toward[far] * found[2] == pytest.approx(p[far] - toward[far] * p[2])
            or not toward[far]
        )
    assert list(found[3:]) == list(p[3:])


def test_the_centre_of_what_grows_stays_on_the_pad():
    found = grown_beyond(DISC, readings(*BLOCK), np.array([WIDE - 0.1, WIDE - 0.1, 4.0, 0.0]))
    assert (found[:2] == pytest.approx([WIDE, WIDE])) is True


def test_an_ellipse_grows_along_both_axes_and_what_lies_whole_does_not():
    p = np.array([WIDE - 1.0, 8.0, 3.0, 2.0, 0.3, 1.0])
    found = grown_beyond(ELLIPSE, readings(*BLOCK), p)
    assert found[2] / found[3] == pytest.approx(1.5)
    assert found[4] == p[4]
    assert grown_beyond(DISC, readings(*BLOCK), np.array([8.0, 8.0, 3.0, 1.0])) is None


def many(test):
    """Mark a test that looks at many frames."""
    return pytest.mark.slow(pytest.mark.usefixtures("warm_kernels")(test))


MISSED = 3.0
"""Nats by which another outline is likelier than the one that was found."""

STEPS = {"disc": LocateDisc(), "ellipse": LocateEllipse(), "rectangle": LocateRectangle()}


def searched(kind, shape, pads):
    """Return the likeliest outlines' log evidence, and the centre's error of the answers."""
    step, rows = STEPS[shape], []
    for seed in range(pads):
        bench = Bench(KINDS[kind], np.random.default_rng(seed))
        for frame in bench.frames(3, "rectangle" if shape == "rectangle" else "disc"):
            true = frame.truth[0].shape
            fits, readings, even = step._any_pad.first(observed(frame.image, step._pad, None))
            tops = fits.completed(readings, even)
            x, y = posterior_around(fits, readings, tops).mean[:2]
            rows.append((tops[EVEN].evidence, math.hypot(x - true.x_cm, y - true.y_cm)))
    return np.array(rows).T


@many
@pytest.mark.parametrize(
    ("kind", "shape", "pads", "least", "ratio"),
    [
        ("over the edge", "disc", 20, 5, 0.85),
        ("over the edge", "ellipse", 40, 5, 0.99),
    ],
)
def test_what_the_edge_cuts_off_is_looked_for_beyond_it(
    kind, shape, pads, least, ratio, monkeypatch
):
    evidence, off = searched(kind, shape, pads)
    monkeypatch.setattr(localise, "beyond_the_edge", lambda model, readings, found: found)
    evidence_before, off_before = searched(kind, shape, pads)
    assert (evidence > evidence_before + MISSED).sum() >= least
    assert (evidence > evidence_before - MISSED).all()
    assert off.mean() < ratio * off_before.mean()


@many
def test_a_disc_among_strays_is_begun_at_knowing_of_them_and_found_in_fewer_climbs():
    any_pad, known, likelier = STEPS["disc"]._any_pad, [], []
    for frame in Bench(KINDS["strays 4 %"], np.random.default_rng(2)).frames(24, "disc"):
        seen = observed(frame.image, STEPS["disc"]._pad, None)
        fits, even = any_pad.begun(seen)
        known.append(fits.told.noise.strays)
        plain = fits.fit(EVEN).likeliest(seen)
        likelier.append(even.mode.height - plain.mode.height)
    assert np.max(known) == pytest.approx(0.04, abs=0.03)
    assert np.mean(np.array(known) > any_pad.told.noise.strays) > 0.6
    assert min(likelier) > -MISSED
    assert max(likelier) > MISSED


@many
@pytest.mark.parametrize("kind", ["noise 0", "turn-on 40 g", "voids 0.4"])
def test_without_strays_a_disc_is_begun_at_as_the_readings_have_it(kind):
    any_pad, same = STEPS["disc"]._any_pad, []
    for frame in Bench(KINDS[kind], np.random.default_rng(2)).frames(24, "disc"):
        seen = observed(frame.image, STEPS["disc"]._pad, None)
        fits, even = any_pad.begun(seen)
        plain = any_pad.fit(EVEN).likeliest(seen)
        same.append(fits is any_pad and even.mode.height > plain.mode.height - 0.5)
    assert sum(same) >= 23


@many
def test_among_strays_a_rectangle_is_looked_for_without_what_stands_alone(monkeypatch):
    _, off = searched("strays 4 %", "rectangle", 20)
    monkeypatch.setattr(localise, "among_strays", lambda model, readings, found: found)
    _, off_before = searched("strays 4 %", "rectangle", 20)
    assert off.mean() < 0.9 * off_before.mean()
    assert np.quantile(off, 0.95) < 0.9 * np.quantile(off_before, 0.95)
