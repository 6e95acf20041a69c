"""What recordings taught of a pad: what it says of an image, and what localisers make of it."""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from tactile_graph import Frame, load
from tactile_graph.errors import RuleError
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.above_noise import AboveNoise
from tactile_graph_likelihood.any_pad.choose import Locate
from tactile_graph_likelihood.any_pad.fits.first_fit import first_fit
from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.any_pad.locate import ANY_PAD, LocateDisc
from tactile_graph_likelihood.any_pad.observation.learned_pad import (
    Placing,
    at,
    known_quantities,
    taught,
    unevenness_left,
)
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.geometry.outlines import DISC
from tactile_graph_likelihood.single.density.element_terms import UNKNOWN
from tactile_graph_pads.learned import Elements, write_elements
from tactile_graph_pads.learning.patch import N_PLACE, PatchKind
from tactile_graph_pads.learning.place import PlaceCorrection, write_place
from tactile_graph_pads.pad import load_pad

sys.path.insert(0, str(Path(__file__).parents[4] / "benchmarks"))
from second_simulator import BASE, Bench

OFFSETS = replace(BASE, noise_v=1e-3, offset_v=50e-3, stuck_elements=2)


@pytest.fixture
def bench():
    return Bench(OFFSETS, np.random.default_rng(3))


@pytest.fixture
def pad(tmp_path, bench):
    """Return the file of a pad as it was learned from the bench, without a correction of place."""
    return written(tmp_path, bench)


def written(folder, bench, **more):
    shape = bench.zero_v.shape
    state = np.where(bench.stuck, "stuck", "good")
    elements = Elements(bench.zero_v, np.full(shape, 1e-3), np.ones(shape), state)
    write_elements(folder / "elements.csv", elements)
    learned = {
        "reading": "volt", "rows": 16, "columns": 16, "pitch_cm": [1.3, 1.3],
        "origin_cm": [-0.15, -0.15], "elements": "elements.csv", "noise": 1e-3,
        "touched_from": 6e-3, **more,
    }  # fmt: skip
    path = folder / "pad.yaml"
    path.write_text(yaml.safe_dump({"learned": learned}))
    return str(path)


def centre_off(step, frames):
    off = []
    for frame in frames:
        (true,) = frame.truth
        found = step(frame.image)
        found = getattr(found, "shape", found)
        off.append(math.hypot(found.x_cm - true.shape.x_cm, found.y_cm - true.shape.y_cm))
    return np.mean(off)


def radius_of(found):
    return getattr(found, "shape", found).radius_cm


def test_of_an_image_like_those_recorded_all_is_known(pad, bench):
    image = next(bench.frames(1)).image
    its = taught(load_pad(pad), image)
    assert its.offset[~bench.stuck] == pytest.approx(bench.zero_v[~bench.stuck], abs=1e-6)
    assert (its.offset[bench.stuck] == 0.0).all()
    assert (its.good == ~bench.stuck).all()
    assert (its.least, its.noise[0, 0]) == (6e-3, 1e-3)


def test_offsets_say_nothing_of_grams_made_of_the_volts_but_bad_elements_stay_bad(pad, bench):
    image = next(bench.frames(1)).image
    its = taught(load_pad(pad), image.with_values(image.values, quantity="gram"))
    assert (its.offset, its.noise, its.least) == (0.0, None, 0.0)
    assert its.stuck.sum() == 2


def test_images_of_another_shape_or_quantity_are_refused(pad):
    small = Image(np.zeros((2, 3)), (1.3, 1.3), (0.0, 0.0), "volt")
    raw = Image(np.zeros((16, 16)), (1.3, 1.3), (0.0, 0.0), "raw")
    steps = AboveNoise(pad=pad), LocateDisc(settings=replace(ANY_PAD, pad=pad))
    for step in (*steps, Locate(settings=replace(ANY_PAD, pad=pad))):
        with pytest.raises(RuleError, match="learned with 16 x 16 elements, got 2 x 3"):
            step(small)
        with pytest.raises(RuleError, match="learned from readings in volt, got raw"):
            step(raw)
    assert taught(load_pad("thesis"), raw) is None


def test_an_image_that_states_another_pitch_is_refused_and_one_that_states_none_is_not(pad):
    known = load_pad(pad)
    finer = Image(np.zeros((16, 16)), (0.5, 0.5), (0.0, 0.0), "volt")
    with pytest.raises(RuleError, match=r"learned at a pitch of 1.3 x 1.3 cm, got 0.5 x 0.5 cm"):
        taught(known, finer)
    assert taught(known, Image(np.zeros((16, 16)), (1.3001, 1.3), (0.0, 0.0), "volt")) is not None
    assert taught(known, Image(np.zeros((16, 16)), quantity="volt")) is not None


def test_a_pad_with_a_learned_curve_knows_its_grams(tmp_path, bench):
    more = {"reading": "raw", "curve": [[0.0, 0.0], [5.0, 900.0]]}
    pad = load_pad(written(tmp_path, bench, **more))
    assert known_quantities(pad) == ("raw", "gram")
    grams = Image(np.zeros((16, 16)), (1.3, 1.3), (0.0, 0.0), "gram")
    assert taught(pad, grams).stuck.sum() == 2


def test_a_pad_may_be_told_for_frames_that_the_pipelines_own_source_does_not_give(tmp_path, bench):
    path = written(tmp_path, bench, reading="raw")
    own = load("locate-circle").with_settings({"circle.pad": path, "footprint.pad": path})
    y, x = np.mgrid[0:16, 0:16] + 0.5
    values = bench.zero_v + 0.5 * (np.hypot(x - 8.0, y - 8.0) < 3.0)
    found = own.run(Frame.of(values, 1.3))["circle"]
    assert found.x_cm == pytest.approx(8.0 * 1.3, abs=0.5)
    told = own.run(Frame.of(values, 1.3, quantity="volt")).outcome("circle")
    assert "learned from readings in raw, got volt" in str(told.reason)


def test_stuck_elements_are_unknown_and_show_no_touch(pad, bench):
    image = next(bench.frames(1)).image
    assert (observed(image, load_pad(pad)).states[bench.stuck] == UNKNOWN).all()
    assert not AboveNoise(pad=pad)(image).mask.values[bench.stuck].any()


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
@pytest.mark.parametrize("step", [LocateDisc, Locate])
def test_a_learned_pad_takes_away_what_offsets_and_stuck_elements_spoil(pad, bench, step):
    frames = list(bench.frames(9))
    named = {"shapes": ["disc"]} if step is Locate else {}
    told = step(settings=replace(ANY_PAD, pad=pad), **named)
    assert centre_off(told, frames) < 0.13
    assert centre_off(told, frames) < 0.6 * centre_off(step(**named), frames)


def placed(folder, bench):
    """Write a correction of half a cell to the right and a quarter up."""
    kind = PatchKind(reach=1)
    n = N_PLACE + kind.size
    weights = np.zeros((n, 2))
    weights[0] = 0.5, -0.25  # of the constant term: so many cells to the right and up
    place = PlaceCorrection(
        kind, (16, 16), np.zeros(kind.size), 1.0, weights, np.zeros((n, n)), np.array([0.1, 0.2])
    )
    write_place(folder / "place.npz", place)


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
def test_a_correction_of_place_moves_the_answer_and_says_how_sure_it_is(tmp_path, bench):
    placed(tmp_path, bench)
    plain = LocateDisc(settings=replace(ANY_PAD, pad=written(tmp_path, bench, reading="raw")))
    more = {"reading": "raw", "place": "place.npz"}
    moved = LocateDisc(settings=replace(ANY_PAD, pad=written(tmp_path, bench, **more)))
    volts = next(bench.frames(1)).image
    image = Image(volts.values, volts.pitch_cm, volts.origin_cm, "raw")
    before, after = plain(image), moved(image)
    assert after.x_cm - before.x_cm == pytest.approx(0.5 * 1.3)
    assert after.y_cm - before.y_cm == pytest.approx(-0.25 * 1.3)
    assert after.radius_cm == before.radius_cm
    assert after.posterior.std(0) == pytest.approx(0.13)
    assert after.posterior.std(1) == pytest.approx(0.26)


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
def test_where_readings_have_a_law_it_places_better_than_a_correction_does(tmp_path, bench):
    placed(tmp_path, bench)
    plain = LocateDisc(settings=replace(ANY_PAD, pad=written(tmp_path, bench)))
    corrected = LocateDisc(
        settings=replace(ANY_PAD, pad=written(tmp_path, bench, place="place.npz"))
    )
    image = next(bench.frames(1)).image
    assert corrected(image).x_cm == plain(image).x_cm


def test_learned_gains_leave_less_unevenness(tmp_path, bench):
    even = load_pad(written(tmp_path, bench))
    assert unevenness_left(even, 0.5) == 0.5
    evened = load_pad(written(tmp_path, bench, gain_of="gram"))
    logs = np.random.default_rng(1).normal(0.0, 0.4, bench.zero_v.shape)
    table = evened.learned.table._replace(gain=np.exp(logs))
    object.__setattr__(evened.learned, "table", table)
    left = math.sqrt(0.25 - np.var(logs[~bench.stuck]))
    assert unevenness_left(evened, 0.5) == pytest.approx(left)
    assert unevenness_left(evened, 0.3) == pytest.approx(0.09)


def with_gains(folder, bench):
    path = Path(written(folder, bench, gain_of="gram"))
    gain = np.exp(bench.kind.sigma * bench.own)
    state = np.full(gain.shape, "good")
    write_elements(
        folder / "elements.csv", Elements(bench.zero_v, np.full(gain.shape, 2e-4), gain, state)
    )
    data = yaml.safe_load(path.read_text())
    data["unevenness"] = {"sigma": bench.kind.sigma, "voids": bench.kind.voids}
    path.write_text(yaml.safe_dump(data))
    return path


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
def test_gains_that_hold_are_kept_where_a_first_attempt_went_astray(tmp_path):
    bench = Bench(replace(BASE, fixed=1.0), np.random.default_rng(4))
    settings = replace(ANY_PAD, pad=str(with_gains(tmp_path, bench)))
    any_pad = AnyPad.of(settings, DISC)
    for frame in bench.frames(14):
        found = first_fit(frame.image, settings.known_pad, None, any_pad)
        assert found.fits.unevened is not None


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
def test_gains_hold_whatever_shape_is_named_first(tmp_path):
    bench = Bench(replace(BASE, fixed=1.0), np.random.default_rng(3))
    settings = replace(ANY_PAD, pad=str(with_gains(tmp_path, bench)))
    one, other = (
        Locate(shapes=shapes, settings=settings)
        for shapes in (["disc", "rectangle"], ["rectangle", "disc"])
    )
    for frame in bench.frames(6):
        a, b = one(frame.image).shape, other(frame.image).shape
        assert (a.x_cm, a.y_cm) == pytest.approx((b.x_cm, b.y_cm), abs=0.01)


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
@pytest.mark.parametrize("step", [LocateDisc, Locate])
def test_gains_that_do_not_hold_under_foam_are_left_out_and_others_are_not(tmp_path, step):
    bench = Bench(replace(BASE, fixed=1.0), np.random.default_rng(3))
    path = with_gains(tmp_path, bench)
    named = {"shapes": ["disc"]} if step is Locate else {}
    told, untold = step(settings=replace(ANY_PAD, pad=str(path)), **named), step(**named)
    hard = list(bench.frames(12))
    assert centre_off(told, hard) < 0.6 * centre_off(untold, hard)
    bench.kind = replace(bench.kind, foam_cells=0.6)
    soft = list(bench.frames(12))
    sizes = [
        np.mean([abs(radius_of(one(f.image)) - f.truth[0].shape.radius_cm) for f in soft])
        for one in (told, untold)
    ]
    assert sizes[0] < 1.5 * sizes[1]


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
def test_a_moved_posterior_keeps_its_region_about_its_centre(bench):
    posterior = LocateDisc().posterior(next(bench.frames(1)).image)
    moved = at(posterior, np.array([3.0, 4.0]), np.array([posterior.std(0), posterior.std(1)]))
    assert moved.reach == pytest.approx(posterior.reach)
    assert moved.points - moved.mean == pytest.approx(posterior.points - posterior.mean)


def test_a_pad_without_a_correction_leaves_posteriors_as_they_are(pad):
    image = Image(np.zeros((16, 16)), (1.3, 1.3), (0.0, 0.0), "volt")
    assert Placing(load_pad(pad))(image, []) == []


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
@pytest.mark.parametrize("quick", [False, True])
def test_neither_an_untold_scale_nor_a_small_pattern_flags_what_learned_gains_even(tmp_path, quick):
    bench = Bench(replace(BASE, fixed=1.0), np.random.default_rng(3))
    path = with_gains(tmp_path, bench)
    data = yaml.safe_load(path.read_text())
    data["learned"] |= {"reading": "raw", "gain_of": "raw"}
    path.write_text(yaml.safe_dump(data))
    step = LocateDisc(settings=replace(ANY_PAD, pad=str(path), quick=quick))
    gain = np.exp(bench.kind.sigma * bench.own)
    rng, fine = np.random.default_rng(5), (np.arange(160) + 0.5) / 10.0
    for _ in range(12):
        x, y = rng.uniform(5.0, 11.0, 2)
        covered = np.hypot(fine - x, fine[:, None] - y) < rng.uniform(3.0, 4.5)
        history = 1.0 + 0.04 * np.sin(np.arange(16) + rng.uniform(0.0, 6.0))
        loads = 60.0 * covered.reshape(16, 10, 16, 10).mean(axis=(1, 3)) * history
        loads *= np.exp(0.04 * rng.standard_normal((16, 16)))
        found = step(Image(bench.zero_v + gain * loads, (1.3, 1.3), (-0.15, -0.15), "raw"))
        assert math.hypot(found.x_cm + 0.15 - 1.3 * x, found.y_cm + 0.15 - 1.3 * y) < 0.2
        assert found.fits, (found.posterior.centre_std_cm, found.posterior.usual_std_cm)


def test_a_pad_of_four_elements_shows_above_the_noise_that_it_has_learned(tmp_path):
    elements = Elements(
        np.zeros((2, 2)), np.full((2, 2), 1e-3), np.ones((2, 2)), np.full((2, 2), "good")
    )
    write_elements(tmp_path / "elements.csv", elements)
    learned = {
        "reading": "volt", "rows": 2, "columns": 2, "pitch_cm": [1.3, 1.3],
        "origin_cm": [0.0, 0.0], "elements": "elements.csv", "noise": 1e-3, "touched_from": 4e-3,
    }  # fmt: skip
    (tmp_path / "pad.yaml").write_text(yaml.safe_dump({"learned": learned}))
    step, rng = AboveNoise(pad=str(tmp_path / "pad.yaml")), np.random.default_rng(0)
    for _ in range(20):
        values = rng.normal(0.0, 5e-4, (2, 2))
        assert step(Image(values.copy(), (1.3, 1.3), quantity="volt")).rise == 0.0
        values[1, 0] += 0.1
        assert step(Image(values, (1.3, 1.3), quantity="volt")).rise > 1.5
