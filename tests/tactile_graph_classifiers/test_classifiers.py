"""The three classifier steps: who is nearest, who is unknown, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from helpers_classifiers import export_of, normal_rows, reading, three_objects
from tactile_graph.errors import DataError
from tactile_graph_classifiers.distances.left_out import largest_accepted
from tactile_graph_classifiers.distances.mahalanobis import Mahalanobis
from tactile_graph_classifiers.distances.minimum_distance import MinimumDistance
from tactile_graph_classifiers.distances.minimum_distance_normalised import (
    MinimumDistanceNormalised,
)
from tactile_graph_classifiers.measuring.measurements import Measurements

EACH = pytest.mark.parametrize("kind", [MinimumDistance, MinimumDistanceNormalised, Mahalanobis])

OVERLAPPING = {"a": (10.0, 10.0), "b": (14.0, 10.0), "c": (12.0, 13.0)}
"""Where objects lie whose readings vary by 1."""


@EACH
def test_each_known_object_is_found_and_the_runner_up_is_another(kind):
    one = kind(database=export_of(three_objects()))
    for name, at in {"light": (505, 41), "heavy": (1990, 38), "wide": (2010, 147)}.items():
        found = one(reading(*at))
        assert (found.name, found.known, found.shape) == (name, True, "disc")
        assert found.runner_up in {"light", "heavy", "wide"} - {name}
        assert found.margin == pytest.approx(1 - found.distance / found.runner_up_distance)
        assert found.distance <= found.limit


@EACH
def test_an_object_that_was_never_learned_is_unknown(kind):
    one = kind(database=export_of(three_objects()))
    found = one(reading(1200.0, 95.0))
    assert (found.name, found.known, found.shape) == ("unknown", False, "")
    assert found.nearest in {"light", "heavy", "wide"}
    assert found.distance > found.limit


@EACH
def test_without_rejecting_the_nearest_is_the_answer_however_far(kind):
    found = kind(database=export_of(three_objects()), reject=False)(reading(9e3, 500.0))
    assert found.known
    assert found.name == found.nearest
    assert found.limit is None


@EACH
def test_the_confidence_is_the_share_of_a_known_objects_readings_that_is_accepted(kind):
    rng = np.random.default_rng(5)
    one = kind(database=export_of(three_objects(1, n=100)), confidence=0.9)
    fresh = normal_rows(rng, (2000.0, 150.0), (30.0, 9.0), 400)
    accepted = np.mean([one(reading(*row)).known for row in fresh])
    assert 0.84 < accepted < 0.96


@EACH
def test_the_order_of_readings_and_of_objects_changes_nothing(kind):
    rng = np.random.default_rng(2)
    objects = three_objects()
    shuffled = {n: rng.permutation(objects[n]) for n in rng.permutation(list(objects))}
    one, other = kind(database=export_of(objects)), kind(database=export_of(shuffled))
    for row in rng.uniform((300, 20), (2500, 180), (20, 2)):
        a, b = one(reading(*row)), other(reading(*row))
        assert (a.name, a.runner_up) == (b.name, b.runner_up)
        assert (a.distance, a.limit, a.margin) == pytest.approx((b.distance, b.limit, b.margin))


@EACH
def test_features_are_chosen_by_name_in_any_order_of_the_reading(kind):
    one = kind(database=export_of(three_objects()), features=["area_cm2"])
    other = Measurements(("area_cm2", "x", "weight"), np.array([150.0, 7.0, -1.0]), "gram")
    assert one(other).name == "wide"
    assert one(reading(-1.0, 150.0)).name == "wide"


@EACH
def test_a_reading_in_another_unit_is_refused(kind):
    one = kind(database=export_of(three_objects()))
    with pytest.raises(
        DataError, match="this reading is in volt; the objects were learned in gram; learn"
    ):
        one(reading(500.0, 40.0, "volt"))
    assert one(reading(500.0, 40.0, "")).name == "light"


@EACH
@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_reading_that_is_no_number_is_refused(kind, bad):
    with pytest.raises(DataError, match="'area_cm2' must be a finite number, got"):
        kind(database=export_of(three_objects()))(reading(500.0, bad))


@EACH
def test_a_feature_that_was_never_learned_is_refused_when_the_step_is_made(kind):
    with pytest.raises(DataError, match="no feature named 'area' was learned; did you mean 'area_"):
        kind(database=export_of(three_objects()), features=["weight", "area"])
    with pytest.raises(ValueError, match="each once, got"):
        kind(database=export_of(three_objects()), features=["weight", "weight"])


@EACH
def test_a_database_without_objects_is_refused(kind):
    with pytest.raises(DataError, match="no object was learned yet"):
        kind(database=export_of({}))


@EACH
def test_the_sample_knows_the_objects_of_the_thesis(kind):
    one = kind()
    found = one(reading(6350.0, 82.0))
    assert (found.name, found.shape) == ("Disc III", "disc")


@EACH
def test_two_objects_with_the_same_mean_have_no_margin(kind):
    rows = three_objects()["light"]
    one = kind(database=export_of({"a": rows, "b": rows, "c": rows + 1000.0}), reject=False)
    found = one(Measurements(("weight", "area_cm2"), rows.mean(axis=0)))
    assert (found.nearest, found.runner_up) == ("a", "b")
    assert found.margin == pytest.approx(0.0, abs=1e-6)


# -- equation 4.8 ----------------------------------------------------------------------------


def test_the_distance_is_that_of_equation_4_8():
    rows = np.array([[100.0, 10.0], [104.0, 12.0], [96.0, 11.0]])  # variances 16 and 1
    one = MinimumDistance(database=export_of({"a": rows}), reject=False)
    assert one(reading(132.0, 14.0)).distance == pytest.approx(math.hypot(32 / 16, 3 / 1))
    by_deviation = MinimumDistance(database=export_of({"a": rows}), over="deviation", reject=False)
    assert by_deviation(reading(132.0, 14.0)).distance == pytest.approx(math.hypot(32 / 4, 3 / 1))
    weighed = MinimumDistance(database=export_of({"a": rows}), weights=[4.0, 0.0], reject=False)
    assert weighed(reading(132.0, 14.0)).distance == pytest.approx(2 * 32 / 16)


def test_an_only_object_has_no_runner_up_and_full_margin():
    one = MinimumDistance(database=export_of({"light": three_objects()["light"]}))
    found = one(reading(500.0, 40.0))
    assert (found.runner_up, found.runner_up_distance, found.margin) == ("", None, 1.0)
    assert found.known


@pytest.mark.parametrize("weights", [[1.0], [1.0, -1.0], [0.0, 0.0]])
def test_weights_must_fit_the_features(weights):
    with pytest.raises(ValueError, match="weights: needs one number >= 0 for each of the 2"):
        MinimumDistance(database=export_of(three_objects()), weights=weights)


def test_what_has_no_variance_cannot_be_divided_by():
    with pytest.raises(DataError, match="'x' has 1 reading: a variance needs at least 2"):
        MinimumDistance(database=export_of({"x": [[1.0, 2.0]]}))
    with pytest.raises(DataError, match="'weight' is the same in all 2 readings of 'x'"):
        MinimumDistance(database=export_of({"x": [[1.0, 2.0], [1.0, 3.0]]}))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("over", ["variance", "deviation"])
def test_features_of_huge_numbers_are_compared_without_a_warning(over):
    objects = {n: rows * (1.0, 1e151) for n, rows in three_objects().items()}
    one = MinimumDistance(database=export_of(objects), over=over)
    found = one(reading(505.0, 41e151))
    assert (found.name, found.known) == ("light", True)
    assert 0.0 < found.limit < math.inf


@pytest.mark.filterwarnings("error")
def test_a_variance_too_small_to_divide_by_is_refused():
    objects = {n: rows * (1.0, 1e-120) for n, rows in three_objects().items()}
    with pytest.raises(DataError, match=r"'area_cm2' of 'light' has a variance of \S+e-23., too"):
        MinimumDistance(database=export_of(objects))
    found = MinimumDistance(database=export_of(objects), over="deviation")(reading(505.0, 41e-120))
    assert found.name == "light"


# -- as the thesis modified it -----------------------------------------------------------------


def test_the_variance_is_left_out_unless_it_is_kept():
    rows = {"a": [[100.0, 10.0], [104.0, 12.0], [96.0, 11.0]],
            "b": [[200.0, 30.0], [201.0, 32.0], [199.0, 31.0]]}  # fmt: skip
    plain = MinimumDistanceNormalised(database=export_of(rows), reject=False)
    assert plain(reading(125.0, 11.0)).distance == pytest.approx(25 / 75)
    kept = MinimumDistanceNormalised(database=export_of(rows), keep_variance=True, reject=False)
    # to a: 25 / 16 and 0; to b: 75 / 1 and 20 / 1
    assert kept(reading(125.0, 11.0)).distance == pytest.approx(25 / 16 / 75)


def test_a_single_object_cannot_be_rejected_after_normalising():
    data = export_of({"light": three_objects()["light"]})
    with pytest.raises(ValueError, match="with 'light' alone every distance is the same"):
        MinimumDistanceNormalised(database=data)
    assert MinimumDistanceNormalised(database=data, reject=False)(reading(1.0, 1.0)).name == "light"


def test_a_stranger_far_off_in_every_feature_is_unknown_however_much_objects_vary():
    for seed in range(20):
        rng = np.random.default_rng(seed)
        objects = {n: rng.normal(at, 1.0, (20, 2)) for n, at in OVERLAPPING.items()}
        one = MinimumDistanceNormalised(database=export_of(objects))
        for angle in np.linspace(0.2, 1.3, 5) + np.array([[0.0], [0.5], [1.0], [1.5]]) * np.pi:
            for a in angle:
                assert one(reading(12 + 1e3 * np.cos(a), 11 + 1e3 * np.sin(a))).name == "unknown"


def test_where_distances_cannot_be_too_far_known_objects_are_accepted_all_the_same():
    rng = np.random.default_rng(0)
    objects = {n: rng.normal(at, 1.0, (20, 2)) for n, at in OVERLAPPING.items()}
    one = MinimumDistanceNormalised(database=export_of(objects))
    found = [one(reading(*rng.normal(OVERLAPPING[n]))) for n in OVERLAPPING for _ in range(100)]
    assert np.mean([it.known for it in found]) > 0.98


def test_an_object_of_one_reading_is_recognised_by_how_the_others_vary():
    rng = np.random.default_rng(0)
    objects = {**three_objects(), "new": np.array([[1000.0, 100.0]])}
    one = MinimumDistanceNormalised(database=export_of(objects))
    fresh = normal_rows(rng, (1000.0, 100.0), (15.0, 6.0), 100)
    assert np.mean([one(reading(*row)).name == "new" for row in fresh]) > 0.9
    assert one(reading(1500.0, 104.0)).name == "unknown"
    with pytest.raises(DataError, match="no object has two readings, so nothing says how much"):
        MinimumDistanceNormalised(database=export_of({"a": [[1.0, 2.0]], "b": [[3.0, 4.0]]}))


# -- Mahalanobis -------------------------------------------------------------------------------


def test_with_many_readings_it_is_the_mahalanobis_distance_of_the_sample():
    rng = np.random.default_rng(0)
    root = np.array([[30.0, 0.0], [4.0, 2.0]])
    rows = (1000.0, 60.0) + rng.standard_normal((4000, 2)) @ root.T
    one = Mahalanobis(database=export_of({"a": rows}), prior_readings=0.0, reject=False)
    off = np.array([1050.0, 61.0]) - rows.mean(axis=0)
    wanted = math.sqrt(off @ np.linalg.inv(np.cov(rows.T)) @ off)
    assert one(reading(1050.0, 61.0)).distance == pytest.approx(wanted, rel=1e-2)


def test_an_object_of_one_reading_borrows_the_spread_of_the_others():
    objects = {**three_objects(), "new": np.array([[1000.0, 100.0]])}
    one = Mahalanobis(database=export_of(objects))
    assert one(reading(1010.0, 104.0)).name == "new"
    assert one(reading(1500.0, 104.0)).name == "unknown"


def test_more_features_than_readings_do_no_harm():
    rng = np.random.default_rng(0)
    names = tuple(f"f{i}" for i in range(6))
    objects = {n: rng.normal(m, 1.0, (3, 6)) for n, m in (("a", 0.0), ("b", 30.0))}
    one = Mahalanobis(database=export_of(objects, names), features=list(names))
    assert one(Measurements(names, np.full(6, 29.5), "gram")).nearest == "b"


def test_a_feature_that_never_varies_within_objects_decides_between_them():
    rows = three_objects()["light"]
    data = export_of(
        {"disc": np.column_stack([rows, np.zeros(25)]),
         "washer": np.column_stack([rows, np.ones(25)])},
        ("weight", "area_cm2", "holes"),
    )  # fmt: skip
    one = Mahalanobis(database=data, features=["weight", "area_cm2", "holes"])
    found = one(Measurements(("weight", "area_cm2", "holes"), np.array([500.0, 40.0, 1.0]), "gram"))
    assert (found.name, found.runner_up) == ("washer", "disc")
    assert found.margin > 0.99


def test_no_object_with_two_readings_says_nothing_of_spread():
    with pytest.raises(DataError, match="no object has two readings"):
        Mahalanobis(database=export_of({"a": [[1.0, 2.0]], "b": [[3.0, 4.0]]}))


def test_the_largest_accepted_ratio_is_an_order_statistic_or_a_bound():
    ratios = np.arange(1.0, 100.0)
    assert largest_accepted(ratios, 0.9) == 90.0
    assert largest_accepted(ratios, 0.99) == 99.0
    assert largest_accepted(ratios, 0.999) == 99.0  # too few readings: the largest
    assert largest_accepted(np.zeros(0), 0.99) == pytest.approx(-math.log(0.01))
