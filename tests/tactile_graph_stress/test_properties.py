"""What every fitter, hull, orientation, decoupler and restorer promises, on drawn input.

Few examples by default; ``--hypothesis-profile=full`` or ``HYPOTHESIS_PROFILE=full`` draws many.
"""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from helpers_stress import profile, seeds, subject_of
from tactile_graph import Image, Mask, Points
from tactile_graph_stress import scenes
from tactile_graph_stress.affine import Affine
from tactile_graph_stress.case import Case
from tactile_graph_stress.judge import Judge
from tactile_graph_stress.similarity import Similarity
from tactile_graph_stress.trial import Trial
from tactile_graph_stress.verdict import Outcome

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

BOUNDS = {
    "fit_circle": 100.0,
    "fit_circle_kasa": 100.0,
    "fit_circle_taubin": 100.0,
    "fit_circle_hyper": 100.0,
    "fit_circle_thesis": 1e10,  # stops at 1e-8 of the radius a round
    "fit_ellipse": 1e3,
    "fit_ellipse_direct": 100.0,
    "fit_ellipse_origin": 1e11,  # a simplex of its tolerance, in an axis' frame
    "ellipse_sweep": 1e13,  # golden sections down to its narrowest angle
    "fit_rectangle": 1e9,  # tacks along kinks
    "min_area_rectangle": 100.0,
    "rectangle_from_ellipse": 1e3,
    "hull": 20.0,
    "hull_graham": 20.0,
    "hull_beneath_beyond": 20.0,
    "hull_qhull": 20.0,
    "orientation": 100.0,
}
"""Errors of equivariance that are allowed, in units of eps times conditioning."""

RESTORERS = ("gibbs", "gnc", "graph_cuts", "icm", "mean_field", "posterior", "restore", "trw")
MASKS = ("boundary_scan", "mask_points", "orientation", "orientation_robust", "fit_rectangle_load")
QUICK_MODEL = {"n_levels": 8, "lines": "marginal"}
JUDGES: dict[str, Judge] = {}
TRIALS: dict[tuple[str, str], Trial] = {}


def judge(name):
    if name not in JUDGES:
        JUDGES[name] = Judge(Trial(subject_of(name)), np.random.default_rng(0))
    return JUDGES[name]


def scene(kind, seed):
    rng = np.random.default_rng(seed)
    if kind == "circle":
        return scenes.noisy(scenes.arc(float(rng.uniform(200.0, 360.0))), rng)
    if kind == "ellipse":
        return scenes.noisy(scenes.ellipse(float(rng.uniform(1.4, 3.0))), rng)
    if kind == "rectangle":
        return scenes.noisy(scenes.rectangle(float(rng.uniform(1.4, 3.0))), rng)
    return scenes.cloud(rng, float(rng.uniform(1.4, 3.0)))


def within_bound(name, case):
    came = judge(name).trial.run(case.given, case.settings)
    assert came.broke == ""
    if came.value is not None:
        found = judge(name).by_law(case, came.value)
        assert found.outcome is not Outcome.BROKEN or found.units <= BOUNDS[name]
        assert (found.units or 0.0) <= BOUNDS[name]


@pytest.mark.parametrize("name", BOUNDS)
@profile()
@given(
    seed=seeds,
    power=st.floats(-9.0, 9.0),
    turn=st.floats(-math.pi, math.pi),
    away=st.floats(-1e8, 1e8),
)
def test_scaled_turned_and_moved_points_scale_turn_and_move_the_answer(
    name, seed, power, turn, away
):
    subject = subject_of(name)
    base = scene(subject.kind, seed)
    scale = 10.0**power
    law = Similarity(scale, turn, away * scale, -0.3 * away * scale)
    lengths = {k: v * scale for k, v in subject.lengths.items()}
    within_bound(name, Case("scale", "", Points(law.of(base)), Points(base), law, lengths))


@pytest.mark.parametrize("name", BOUNDS)
@profile()
@given(seed=seeds)
def test_order_of_the_points_and_points_given_twice_do_not_matter(name, seed):
    rng = np.random.default_rng(seed)
    base = scene(subject_of(name).kind, seed)
    within_bound(name, Case("order", "", Points(rng.permutation(base)), Points(base), Similarity()))
    if name != "fit_rectangle":  # it leaves a share of the points out, which ties may change
        twice = np.repeat(base, 2, axis=0)
        within_bound(name, Case("twice", "", Points(twice), Points(base), Similarity()))


up_to_nine = st.tuples(st.integers(0, 9), st.just(2))
any_float = st.floats(allow_nan=True, allow_infinity=True, allow_subnormal=True)
few_places = st.sampled_from([0.0, -0.0, 1.0, 1.3, 2.6, 1e-300, 1e308, 5e-324, math.nan, math.inf])


@pytest.mark.parametrize("name", BOUNDS)
@profile()
@given(xy=arrays(np.float64, up_to_nine, elements=any_float)
       | arrays(np.float64, up_to_nine, elements=few_places))  # fmt: skip
def test_whatever_the_points_a_typed_outcome_comes(name, xy):
    came = judge(name).trial.run(Points(xy))
    assert came.broke == ""
    if not np.isfinite(xy).all():
        assert came.gave_up


@pytest.mark.parametrize("name", MASKS)
@profile()
@given(on=arrays(np.bool_, st.tuples(st.integers(1, 9), st.integers(1, 9))),
       power=st.floats(-150.0, 150.0), away=st.floats(-1e9, 1e9))  # fmt: skip
def test_whatever_the_mask_a_typed_outcome_comes(name, on, power, away):
    # Fourth powers of the pitch are no numbers beyond 1e77: the likelihood fit takes them.
    pitch = 10.0 ** (power / 5.0 if name == "fit_rectangle_load" else power)
    if (name, "mask") not in TRIALS:
        TRIALS[name, "mask"] = Trial(subject_of(name, "mask"))
    assert TRIALS[name, "mask"].run(Mask(on, (pitch, 1.3 * pitch), (away, -away))).broke == ""


@pytest.mark.parametrize("name", RESTORERS)
@profile()
@given(values=arrays(np.float64, (3, 4), elements=any_float)
       | arrays(np.float64, (3, 4), elements=few_places))  # fmt: skip
def test_whatever_the_image_restorers_come_to_a_typed_outcome(name, values):
    came = judge(name).trial.run(Image(values, quantity="volt"), {"model": QUICK_MODEL})
    assert came.broke == ""


@pytest.mark.parametrize("name", RESTORERS)
@profile()
@given(seed=seeds, power=st.integers(-60, 60))
def test_restorers_follow_the_unit_of_the_image(name, seed, power):
    """By a power of two, which rounds nothing: then not a bit may differ."""
    base = Image(scenes.load(np.random.default_rng(seed), 4, 4), quantity="volt")
    law = Affine(2.0**power)
    given_ = Image(law.of(base.values), quantity="volt")
    plain, scaled = (judge(name).trial.run(i, {"model": QUICK_MODEL}).value for i in (base, given_))
    got, want = (v.image if hasattr(v, "image") else v.mean for v in (scaled, plain))
    assert np.array_equal(got.values, law.of(want.values))


@pytest.mark.parametrize("kind", ["divider", "floating", "feedback"])
@profile()
@given(volts=arrays(np.float64, (3, 3), elements=any_float)
       | arrays(np.float64, (3, 3), elements=st.floats(-1.0, 6.0)))  # fmt: skip
def test_whatever_the_voltages_the_decoupler_comes_to_a_typed_outcome(kind, volts):
    settings = {"pad": {"circuit": {"kind": kind, "bias_ohm": 1e3}}}
    came = judge("decouple").trial.run(Image(volts, quantity="volt"), settings)
    assert came.broke == ""
    if not np.isfinite(volts).all():
        assert "must be a number" in came.gave_up
