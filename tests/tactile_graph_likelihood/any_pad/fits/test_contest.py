"""Kinds of outlines are looked at as long as they may win, and compare where all know the same."""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from helpers_likelihood import made
from tactile_graph import Image, load
from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.any_pad.choose import Locate, probabilities
from tactile_graph_likelihood.any_pad.fits.contest import _first_look, tops_of_each
from tactile_graph_likelihood.any_pad.locate import LocateDisc, LocateRectangle
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.settings import LocateSettings
from tactile_graph_likelihood.single.any_pressure import EVEN
from tactile_graph_likelihood.single.model import EVERY, FIRST, MORE, SAME, Model

sys.path.insert(0, str(Path(__file__).parents[4] / "benchmarks"))
from second_simulator import KINDS, Bench

# Machine code is compiled for tests that look at many frames; plain code serves the others.
many = pytest.mark.usefixtures("warm_kernels")
plain = pytest.mark.usefixtures("plain_kernels")


def frames_of(kind, shape="disc", n=12, seed=7):
    return [*Bench(KINDS[kind], np.random.default_rng(seed)).frames(n, shape)]


@plain
@pytest.mark.slow
def test_a_kind_that_is_hopelessly_behind_is_left_as_it_was_found():
    step = Locate()
    frame = frames_of("noise 0.2 mV", n=3)[2]
    readings = step.readings(frame.image)
    _, readings, tops = tops_of_each(step._every, readings)
    assert [*tops["rectangle"]] == [EVEN]
    assert tops["disc"][EVEN].evidence > tops["rectangle"][EVEN].evidence + 12.0
    chance = probabilities(tops, readings)
    assert chance["disc"] > 0.5
    assert chance["rectangle"] < 1e-4


def alone(any_pad, readings):
    """Return a kind's outlines as they are found where it is the only one."""
    its, readings, even = any_pad.first(readings)
    return its.completed(readings, even)


@many
@pytest.mark.slow
@pytest.mark.parametrize("shape", ["disc", "rectangle"])
@pytest.mark.parametrize("kind", ["noise 1 mV", "foam 0.6 cells", "over the edge"])
def test_what_is_left_out_would_not_have_won(kind, shape):
    step, off = Locate(), []
    for frame in frames_of(kind, shape):
        _, readings, tops = tops_of_each(step._every, step.readings(frame.image))
        every = {name: alone(its, readings) for name, its in step._every.items()}
        full, found = probabilities(every, readings), probabilities(tops, readings)
        off.append(abs(full[shape] - found[shape]))
    assert np.median(off) < 0.01
    assert np.mean(np.array(off) > 0.3) < 0.1


@many
@pytest.mark.slow
def test_the_shape_is_told_among_strays():
    step = Locate()
    names = [step(frame.image).name for frame in frames_of("strays 4 %")]
    assert names.count("disc") >= 11


@many
@pytest.mark.slow
def test_all_kinds_know_of_the_same_strays():
    step = Locate()
    readings = step.readings(frames_of("strays 4 %")[0].image)
    _, every, _ = _first_look(step._every, readings)
    (strays,) = {any_pad.told.noise.strays for any_pad in every.values()}
    assert 0.008 < strays < 0.12


@many
@pytest.mark.slow
def test_a_quick_search_ends_where_its_first_attempt_finds_no_more(monkeypatch):
    """Of a kind that was looked at near its moments; otherwise all attempts follow."""
    find, asked = Model._find, []

    def noted(self, problem, begin, attempts, way, known=None):
        found = find(self, problem, begin, attempts, way, known)
        before = -np.inf if known is None else known.mode.height
        asked.append(
            (tuple(attempts), known is not None and attempts[0] == 0, found.mode.height - before)
        )
        return found

    monkeypatch.setattr(Model, "_find", noted)
    n_ended = {}
    for quick in (False, True):
        asked.clear()
        step = made(Locate, quick=quick)
        for frame in [*frames_of("gains 0.9"), *frames_of("gains 0.9", "rectangle")]:
            step(frame.image)
        anew = [attempts for attempts, is_anew, _ in asked if is_anew]
        assert anew
        assert set(anew) == {tuple(FIRST if quick else EVERY)}
        n_ended[quick] = 0
        for (_, is_anew, gained), (after, *_) in pairwise(asked):
            if quick and is_anew and gained <= SAME:
                n_ended[quick] += 1
                assert after != tuple(MORE)
    assert n_ended[True] > 0


@many
def test_kinds_compare_where_all_know_of_as_many_strays():
    frames = load("circle-3").with_source("simulate", scene="rectangles", frames=1).frames()
    volts = next(iter(frames)).image
    # Read as counts of an unknown pad, elements beside the rectangle pass for strays.
    image = Image(np.round(volts.values * 1000.0), (1.0, 1.0), (0.0, 0.0), "raw")
    step = Locate()
    found = step(image)
    assert (found.name, found.rectangle > 0.99) == ("rectangle", True)


@many
@pytest.mark.slow
def test_strays_are_believed_where_readings_are_likelier_for_them():
    outline = LocateRectangle()
    step, learned = outline._any_pad, []
    for kind in ("strays 4 %", "noise 1 mV"):
        for frame in frames_of(kind, "rectangle", 8):
            readings = observed(frame.image, outline._pad, None)
            its, readings, even = step.first(readings)
            fits, top = its.likelier_with(0.04, readings, even)
            assert fits is its or top is not even
            learned.append(fits is not its)
    assert sum(learned[:8]) >= 7
    assert sum(learned[8:]) <= 1


@many
def test_a_few_elements_are_a_disc_as_likely_as_anything_else():
    values = np.zeros((16, 16))
    values[7:9, 7] = 3.0, 2.0
    image = Image(values, (1.3, 1.3), (-0.15, -0.15), "volt")
    found, disc = Locate()(image), LocateDisc()(image)
    assert (found.name, found.probability) == ("disc", found.rectangle)
    assert found.shape.centre_std_cm == disc.centre_std_cm < 1.0
    assert Locate(shapes=["ellipse", "rectangle"])(image).name != "disc"


@many
def test_a_books_edge_is_as_narrow_as_it_is():
    rng, fine = np.random.default_rng(3), np.arange(0.05, 1.0, 0.1)
    at = (1.3 * np.arange(16)[:, None] + fine).ravel()
    held = 0
    for turn in np.linspace(0.2, 1.4, 10):
        x, y = at[None, :] - 10.0, at[:, None] - 9.7
        cos, sin = np.cos(turn), np.sin(turn)
        lies = (abs(x * cos - y * sin) < 7.5) & (abs(x * sin + y * cos) < 0.25)
        share = (lies * 1.0).reshape(16, 10, 16, 10).mean(axis=(1, 3))
        loads = 300.0 * share * np.exp(0.3 * rng.standard_normal(share.shape))
        image = Image(np.where(loads > 3.0, loads, 0.0), (1.3, 1.3), (-0.15, -0.15), "gram")
        found = LocateRectangle()(image)
        held += abs(found.breadth_cm - 0.5) < 2.5 * found.breadth_std_cm
    assert held >= 8


@many
@pytest.mark.parametrize("largest_cm", [0.3, 0.5, 0.4 * 1.3])
def test_a_largest_size_below_the_usual_least_one_leaves_thin_rectangles_alone(largest_cm):
    values = np.zeros((16, 16))
    values[6:9, 6:9] = 3.0
    image = Image(values, (1.3, 1.3), (-0.15, -0.15), "volt")
    settings = LocateSettings(largest_cm=largest_cm)
    with pytest.raises(Degenerate, match="no such outline"):
        LocateDisc(settings)(image)
    found = LocateRectangle(settings)(image)
    assert 0.0 < found.breadth_cm <= found.length_cm <= 2.0 * largest_cm
    assert Locate(settings=settings)(image).name == "rectangle"
