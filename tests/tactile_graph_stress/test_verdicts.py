"""What is broken is found out: each way of breaking by a step that does just that."""

import math

import numpy as np
import pytest

from helpers_stress import FAKES, subject_of
from tactile_graph import Image, Points
from tactile_graph_stress.case import Case
from tactile_graph_stress.judge import Judge, _alike
from tactile_graph_stress.scenes import arc, noisy
from tactile_graph_stress.similarity import Similarity
from tactile_graph_stress.study import stressed
from tactile_graph_stress.trial import Trial
from tactile_graph_stress.verdict import Outcome, graded

XY = noisy(arc(300.0), np.random.default_rng(3))


def judge(name):
    trial = Trial(subject_of(name, registry=FAKES), registry=FAKES)
    return Judge(trial, np.random.default_rng(1))


def verdict(name, xy=XY, base=XY, law=None, **rest):
    law = law or Similarity()
    return judge(name).of(Case("truth", "", Points(xy.copy()), Points(base.copy()), law, **rest))


@pytest.mark.parametrize(
    ("name", "note"),
    [
        ("nan_out", "output.x_cm is nan"),
        ("no_circle", "promises Circle, but gave a tuple of float"),
        ("warns", "warning escaped: divide by zero"),
        ("crashes", "untyped IndexError"),
        ("numpys_error", "untyped LinAlgError: Singular matrix"),
    ],
)
def test_what_must_not_come_out_is_broken(name, note):
    found = verdict(name)
    assert found.outcome is Outcome.BROKEN
    assert note in found.note


@pytest.mark.parametrize(
    ("name", "note"),
    [
        ("drawing", "gives another answer the second time; what is kept, or random?"),
        ("halving", "writes into its input; change a copy"),
        ("seeded", ""),
    ],
)
def test_what_hangs_on_other_runs_is_broken_and_a_seeded_draw_is_not(name, note):
    found = judge(name).of(Case("truth", "", Image(np.ones((3, 3)))))
    assert (found.outcome is Outcome.BROKEN, found.note) == (bool(note), note)


def test_rounding_is_no_other_answer():
    values = np.ones((3, 3))
    moved = np.nextafter(values, 2.0)
    assert _alike((Image(values), 1.0), (Image(moved), 1.0))
    assert not _alike((Image(values), 1.0), (Image(moved), 1.1))
    assert not _alike((1.0,), (1.0, 1.0))
    assert not _alike("disc", "ring")


def test_an_error_raised_for_people_is_a_typed_outcome():
    found = verdict("refuses")
    assert found.outcome is Outcome.GAVE_UP
    assert found.note == "ValueError: radius_cm: must be > 0"


@pytest.mark.slow
def test_a_step_that_ends_the_process_it_runs_in_is_broken_and_tried_on():
    trial = Trial(subject_of("aborts", registry=FAKES), registry=FAKES)
    for _ in range(2):
        assert trial.run(Points(XY)).broke == "ended its process by SIGABRT"
        assert trial.run(Points(XY[:5])).value is not None


@pytest.mark.slow
def test_a_step_that_is_ended_at_its_time_limit_gives_up():
    trial = Trial(subject_of("hangs", registry=FAKES), registry=FAKES)
    for _ in range(2):
        assert trial.run(Points(XY)).gave_up == "took longer than its 0.2 s"


def test_a_step_that_warms_up_is_judged_by_its_first_answer():
    tare = Trial(subject_of("tare"))
    came = tare.run(Image(np.full((3, 3), 2.0)), {"n_frames": 5})
    assert came.value.values.tolist() == np.zeros((3, 3)).tolist()


def test_an_answer_from_nan_is_broken():
    xy = XY.copy()
    xy[0, 0] = np.nan
    assert verdict("centred", xy, must_refuse=True).outcome is Outcome.GAVE_UP
    broken = judge("hull").of(Case("NaN", "", Points(xy), must_refuse=True))
    assert broken.outcome is Outcome.BROKEN


@pytest.mark.parametrize("offset", [1e6, 1e8])
def test_a_fit_that_does_not_centre_is_found_out_far_away(offset):
    law = Similarity(1.0, 0.0, offset, -offset)
    centred, uncentred = (verdict(name, law.of(XY), law=law) for name in ("centred", "uncentred"))
    assert centred.outcome is Outcome.EXACT
    assert uncentred.outcome in (Outcome.DEGRADED, Outcome.BROKEN)
    assert uncentred.units > 1e3 * max(centred.units, 1.0)


def test_a_fit_that_minds_the_order_is_found_out():
    assert verdict("centred", XY[::-1]).outcome is Outcome.EXACT
    found = verdict("ordered", XY[::-1])
    assert found.outcome is Outcome.BROKEN
    assert found.note.startswith("wrong by")


def test_a_hull_that_is_none_is_found_out():
    assert judge("hull").of(Case("truth", "", Points(XY.copy()))).note == (
        "not strictly convex, or clockwise"
    )


def test_a_third_partys_step_is_stressed_as_ours_are():
    rows = list(stressed(subject_of("centred", registry=FAKES), registry=FAKES))
    assert {"scale", "offset", "turn", "arc", "line", "size", "NaN", "empty"} <= {
        r.group for r in rows
    }
    assert {r.kind for r in rows} == {"circle"}


@pytest.mark.parametrize(
    ("units", "condition", "relative", "outcome"),
    [
        (9.9, 10.0, 1e-14, Outcome.EXACT),
        (900.0, 10.0, 1e-12, Outcome.GOOD),
        (1e6, 10.0, 1e-9, Outcome.DEGRADED),
        (1e13, 10.0, 0.02, Outcome.BROKEN),
        (1e13, 1e14, 0.02, Outcome.NO_DIGITS),
        (0.1, 1e11, 0.01, Outcome.EXACT),
    ],
)
def test_the_classes(units, condition, relative, outcome):
    assert graded(units, condition, relative).outcome is outcome


def test_the_unit_is_rounding_times_conditioning():
    """An answer off by what rounding of far away points alone may do counts about 1, not 1e8."""
    law = Similarity(1.0, 0.0, 1e8, 0.0)
    found = verdict("centred", law.of(XY), law=law)
    assert found.units < 1.0
    assert found.condition == pytest.approx(1e8 / 4.5, rel=0.9)
    assert math.isfinite(found.units)
