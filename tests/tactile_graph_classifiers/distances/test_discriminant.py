"""The discriminant: who is likeliest, who is unknown, and how its manner is chosen."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.linalg import solve_triangular

from helpers_classifiers import export_of, normal_rows, reading, three_objects
from tactile_graph import Frame, load
from tactile_graph.errors import DataError, PipelineError, RuleError
from tactile_graph_classifiers.database.choice import Choice, Manner
from tactile_graph_classifiers.database.opening import load_known
from tactile_graph_classifiers.distances import canonical, choosing
from tactile_graph_classifiers.distances.canonical import Space, WithLogarithms, solved
from tactile_graph_classifiers.distances.choosing import choose, name_left_out
from tactile_graph_classifiers.distances.discriminant import CanonicalDiscriminant
from tactile_graph_classifiers.distances.discriminant_model import Learned
from tactile_graph_classifiers.distances.examples import Examples
from tactile_graph_classifiers.measuring.measurements import Measurements

NAMES = tuple(f"f{i}" for i in range(12))


def many(n_objects: int, seed: int, n: int = 25, apart: float = 6.0) -> dict[str, np.ndarray]:
    """Return objects that differ in three of twelve features, which vary together."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(12, 12)) / 3.0 + np.eye(12)
    objects = {}
    for k in range(n_objects):
        mean = 50.0 + np.concatenate([apart * rng.normal(size=3), np.zeros(9)])
        objects[f"object {k}"] = mean + rng.standard_normal((n, 12)) @ root
    return objects


def split(objects: dict[str, np.ndarray], n: int):
    return {k: v[:n] for k, v in objects.items()}, {k: v[n:] for k, v in objects.items()}


def measured(row) -> Measurements:
    return Measurements(NAMES, np.array(row, dtype=np.float64), "gram")


def examples(objects: dict[str, np.ndarray], names=NAMES) -> Examples:
    return Examples.of(load_known(export_of(objects, names), None))


@pytest.mark.slow
def test_known_objects_are_named_and_a_stranger_is_unknown():
    one = CanonicalDiscriminant(database=export_of(three_objects()))
    for name, at in {"light": (505, 41), "heavy": (1990, 38), "wide": (2010, 147)}.items():
        found = one(reading(*at))
        assert (found.name, found.known, found.shape) == (name, True, "disc")
        assert found.margin > 0.99
        assert found.distance <= found.limit
        assert found.runner_up_distance > found.distance
    found = one(reading(1200.0, 95.0))
    assert (found.name, found.known, found.shape) == ("unknown", False, "")
    assert found.distance > found.limit
    assert found.nearest in {"light", "heavy", "wide"}


@pytest.mark.slow
def test_it_tells_apart_by_directions_what_no_feature_alone_tells():
    objects = many(12, seed=3, n=60)
    learned, tested = split(objects, 25)
    one = CanonicalDiscriminant(database=export_of(learned, NAMES), reject=False)
    right = [one(measured(row)).name == name for name, rows in tested.items() for row in rows]
    assert np.mean(right) > 0.93


@pytest.mark.slow
def test_the_confidence_is_the_share_of_known_readings_that_is_accepted():
    for confidence in (0.95, 0.8):
        accepted = []
        for seed in (7, 8, 9):
            learned, tested = split(many(10, seed=seed, n=65), 25)
            one = CanonicalDiscriminant(database=export_of(learned, NAMES), confidence=confidence)
            accepted += [one(measured(row)).known for rows in tested.values() for row in rows]
        assert np.mean(accepted) == pytest.approx(confidence, abs=0.05)


@pytest.mark.slow
def test_objects_that_were_not_learned_are_unknown():
    objects = many(12, seed=7)
    learned = dict(list(objects.items())[:9])
    one = CanonicalDiscriminant(database=export_of(learned, NAMES))
    strangers = [row for name, rows in objects.items() if name not in learned for row in rows]
    assert np.mean([one(measured(row)).known for row in strangers]) < 0.1


@pytest.mark.slow
def test_with_two_objects_a_stranger_is_known_by_what_lies_beside_what_tells_them_apart():
    objects = many(2, seed=8)
    one = CanonicalDiscriminant(database=export_of(objects, NAMES))
    stranger = next(iter(objects.values())).mean(axis=0) + np.r_[np.zeros(9), 40.0, -40.0, 40.0]
    assert not one(measured(stranger)).known
    single = CanonicalDiscriminant(database=export_of(dict([*objects.items()][:1]), NAMES))
    found = single(measured(stranger))
    assert (found.name, found.runner_up, found.runner_up_distance) == ("unknown", "", None)


@pytest.mark.slow
def test_what_was_left_out_foretells_what_new_readings_get():
    learned, tested = split(many(12, seed=3, n=85, apart=2.5), 25)
    choice = choose(examples(learned))
    one = CanonicalDiscriminant(database=export_of(learned, NAMES), reject=False)
    right = [one(measured(row)).name == name for name, rows in tested.items() for row in rows]
    assert choice.n_left_out == 300
    assert choice.n_right / 300 == pytest.approx(np.mean(right), abs=0.07)
    assert 0 < choice.n_found <= choice.n_strangers == 300


@pytest.mark.slow
def test_margins_are_as_sure_as_names_are_right_where_readings_have_long_tails():
    margins, right = [], []
    for seed in range(4):
        rng = np.random.default_rng(seed)
        objects = {f"{k}": 50.0 + 2.0 * rng.normal(size=12) + rng.standard_t(2.5, (125, 12))
                   for k in range(8)}  # fmt: skip
        learned, tested = split(objects, 25)
        one = CanonicalDiscriminant(database=export_of(learned, NAMES), reject=False)
        found = [(one(measured(row)), name) for name, rows in tested.items() for row in rows]
        margins += [it.margin for it, _ in found]
        right += [it.name == name for it, name in found]
    assert np.mean(1.0 / (2.0 - np.array(margins))) == pytest.approx(np.mean(right), abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(("n_objects", "apart"), [(2, 1.0), (10, 0.7), (10, 0.0)])
def test_probabilities_are_as_sure_as_names_are_right_among_objects_much_alike(n_objects, apart):
    probabilities, right = [], []
    for seed in range(3):
        rng = np.random.default_rng(seed)
        middles = 20.0 + apart * rng.normal(size=(n_objects, 3))
        objects = {f"{k}": at + rng.normal(size=(125, 3)) for k, at in enumerate(middles)}
        learned, tested = split(objects, 25)
        one = CanonicalDiscriminant(database=export_of(learned, NAMES[:3]), reject=False)
        for name, rows in tested.items():
            found = [one(Measurements(NAMES[:3], row, "gram")) for row in rows]
            probabilities += [it.probability for it in found]
            right += [it.name == name for it in found]
    assert np.mean(probabilities) == pytest.approx(np.mean(right), abs=0.05)


def test_the_probability_of_an_only_object_is_1_and_of_two_follows_from_the_margin():
    some = three_objects()
    one = CanonicalDiscriminant(database=export_of({"light": some["light"]}))
    assert one(reading(505, 41)).probability == one(reading(505, 41)).margin == 1.0
    two = CanonicalDiscriminant(database=export_of({n: some[n] for n in ("light", "heavy")}))
    found = two(reading(1250, 40))
    assert found.probability == pytest.approx(1.0 / (2.0 - found.margin))


@pytest.mark.slow
def test_where_all_left_out_are_named_right_margins_stay_as_they_are():
    some = examples(three_objects(), ("weight", "area_cm2"))
    named = name_left_out(some, Manner(0.1, 8, 16.0))
    assert (named.unlikeliness.argmin(axis=1) == named.labels).all()
    assert named.temperature() == 1.0
    none = named._replace(unlikeliness=np.zeros((0, 3)), labels=named.labels[:0])
    assert none.temperature() == 1.0


@pytest.mark.slow
def test_features_that_say_nothing_or_never_vary_do_no_harm():
    rng = np.random.default_rng(0)
    objects = {
        name: np.column_stack([rows, np.zeros(25), np.full(25, 7.0), rng.normal(size=25)])
        for name, rows in three_objects().items()
    }
    names = ("weight", "area_cm2", "holes", "same", "noise")
    one = CanonicalDiscriminant(database=export_of(objects, names))
    assert one(Measurements(names, np.array([505.0, 41.0, 0.0, 7.0, 0.1]), "gram")).name == "light"


@pytest.mark.slow
def test_features_that_never_vary_but_for_rounding_make_nobody_a_stranger():
    names = ("weight", *(f"size_{k}" for k in range(2, 200)))
    rows = np.tile([500.0, *np.sqrt(np.arange(2.0, 200.0))], (7, 1))
    rows[:, 0] += np.arange(7)
    assert (rows.std(axis=0)[1:] > 0.0).any()  # the mean of seven equal numbers may be another
    one = CanonicalDiscriminant(database=export_of({"mug": rows}, names))
    for row in rows:
        assert one(Measurements(names, row.copy(), "gram")).known


def test_fewer_readings_than_features_and_one_of_a_single_reading_are_borne():
    objects = {k: v[:3] for k, v in many(4, seed=2, apart=40.0).items()}
    objects["object 3"] = objects["object 3"][:1]
    one = CanonicalDiscriminant(database=export_of(objects, NAMES))
    assert one(measured(objects["object 3"][0])).name == "object 3"


def test_a_reading_at_or_below_0_is_borne_where_all_learned_ones_are_above():
    one = CanonicalDiscriminant(database=export_of(three_objects()))
    assert not one(reading(-5.0, 0.0)).known


@pytest.mark.slow
def test_several_presses_find_strangers_that_one_does_not():
    learned, tested = split(many(8, seed=4, n=45), 25)
    one = CanonicalDiscriminant(database=export_of(learned, NAMES))
    fives = {name: [[measured(row) for row in rows[at : at + 5]] for at in range(0, 20, 5)]
             for name, rows in tested.items()}  # fmt: skip
    like = Measurements.replaced  # the like of a known object differs in one feature
    strange = [[like(press, "f0", press.values[0] + 1.5) for press in five]
               for some in fives.values() for five in some]  # fmt: skip
    alone = [not one(press).known for five in strange for press in five]
    together = [not one.together(five).known for five in strange]
    assert np.mean(alone) < 0.5
    assert np.mean(together) > 0.85
    own = [(one.together(five), name) for name, some in fives.items() for five in some]
    assert np.mean([found.known for found, _ in own]) > 0.85
    assert all(found.nearest == name for found, name in own)


@pytest.mark.slow
def test_presses_are_named_by_their_mean_whatever_their_order():
    learned, tested = split(many(6, seed=5, n=30), 25)
    one = CanonicalDiscriminant(database=export_of(learned, NAMES))
    presses = [measured(row) for row in tested["object 2"]]
    found, turned = one.together(presses), one.together(presses[::-1])
    assert found.n_presses == turned.n_presses == 5
    assert (found.name, turned.name) == ("object 2", "object 2")
    assert found.distance == pytest.approx(turned.distance)
    assert one.together(presses[:1]) == one(presses[0])
    assert one(presses[0]).n_presses == 1


@pytest.mark.slow
def test_of_more_presses_than_were_learned_from_the_limit_is_that_of_fewer():
    learned, tested = split(many(6, seed=5, n=40), 8)  # 8 readings: 2 may be left out
    one = CanonicalDiscriminant(database=export_of(learned, NAMES))
    presses = [measured(row) for row in tested["object 2"]]
    two, many_more = one.together(presses[:2]), one.together(presses)
    assert two.limit == many_more.limit != one(presses[0]).limit
    assert many_more.name == "object 2"


@pytest.mark.slow
def test_the_order_of_objects_changes_no_answer():
    objects = many(6, seed=9)
    other = dict(reversed(objects.items()))
    one, two = (CanonicalDiscriminant(database=export_of(o, NAMES)) for o in (objects, other))
    for rows in many(6, seed=10).values():
        a, b = one(measured(rows[0])), two(measured(rows[0]))
        assert (a.nearest, a.runner_up) == (b.nearest, b.runner_up)


def test_what_cannot_be_learned_from_is_refused():
    with pytest.raises(DataError, match="no object has two readings"):
        CanonicalDiscriminant(database=export_of({"a": [[1.0, 2.0]], "b": [[3.0, 4.0]]}))
    with pytest.raises(DataError, match="no object was learned yet"):
        CanonicalDiscriminant(database=export_of({}))
    one = CanonicalDiscriminant(database=export_of(three_objects()))
    with pytest.raises(DataError, match="'area_cm2' must be a finite number, got"):
        one(reading(500.0, math.nan))
    small = {name: 1e-9 * rows for name, rows in three_objects().items()}
    one = CanonicalDiscriminant(database=export_of(small))
    with pytest.raises(DataError, match="too far from every known object for a number"):
        one(reading(1e150, -1e150))


PIPELINE = """
pipeline: p
nodes:
  footprint: {step: threshold, in: frame, with: {level: auto}}
  siemens: {step: decouple, in: frame}
  features: {step: features, in: {image: IMAGE, mask: footprint}}
  identity: {step: STEP, in: features}
outputs: [identity]
"""


@pytest.mark.parametrize("step", ["discriminant", "mahalanobis"])
@pytest.mark.slow
def test_another_unit_is_refused_when_the_pipeline_is_loaded_where_it_is_known(step, tmp_path):
    path = tmp_path / "p.yaml"
    path.write_text(PIPELINE.replace("STEP", step).replace("IMAGE", "siemens"))
    with pytest.raises(PipelineError, match=f"'{step}' takes gram at port 'features', got siemens"):
        load(path)
    path.write_text(PIPELINE.replace("STEP", step).replace("IMAGE", "frame"))
    wanted = f"'{step}' takes gram at port 'features', got a frame of volt"
    with pytest.raises(RuleError, match=wanted):  # before any step runs
        load(path).run(Frame.of(np.eye(16), 1.3, quantity="volt"))


# -- its parts -------------------------------------------------------------------------------


@pytest.mark.slow
def test_of_the_same_examples_the_manner_is_chosen_once(monkeypatch):
    calls = []
    monkeypatch.setattr(choosing, "choose", lambda its: calls.append(its) or choose(its))
    choosing._chosen.cache_clear()
    some, others = (examples(many(3, seed)) for seed in (3, 4))
    first = choosing.choose_once(some)
    assert choosing.choose_once(examples(many(3, 3))) is first
    assert first == choose(some)
    choosing.choose_once(others)
    assert len(calls) == 2
    for part, known in zip(calls[0], some, strict=True):
        assert (part == known).all()
    choosing._chosen.cache_clear()


def test_of_the_same_examples_what_is_left_out_is_named_once(monkeypatch):
    calls = []
    left_out = choosing.name_left_out
    monkeypatch.setattr(choosing, "name_left_out", lambda *its: calls.append(its) or left_out(*its))
    choosing._named.cache_clear()
    some, manner = examples(many(3, 3)), Manner(0.1, 2, 5.0)
    first = choosing.name_once(some, manner, 1)
    assert choosing.name_once(examples(many(3, 3)), manner, 1) is first
    for found, wanted in zip(first, left_out(some, manner), strict=True):
        assert (found == wanted).all()
    choosing.name_once(some, manner, 2)
    choosing.name_once(examples(many(3, 4)), manner, 1)
    assert len(calls) == 3
    choosing._named.cache_clear()


def test_in_its_space_readings_of_an_object_vary_alike_in_every_direction():
    some = examples(many(8, seed=1, n=400))
    rows = WithLogarithms.of(some.readings)(some.readings)
    space = Space.of(rows, some.labels, 1e-9)
    at = rows @ space.whitening
    off = at - np.array([at[some.labels == k].mean(axis=0) for k in range(8)])[some.labels]
    np.testing.assert_allclose(off.T @ off / (len(off) - 8), np.eye(24), atol=1e-4)
    np.testing.assert_allclose(space.variates.T @ space.variates, np.eye(7), atol=1e-9)


@pytest.mark.parametrize("shape", [(1, 400, 9000), (70, 1, 8000), (188, 80, 188), (9, 5000, 30)])
def test_products_are_made_in_pieces_that_blas_leaves_to_one_thread(shape):
    m, k, n = shape
    left, right = (np.random.default_rng(2).normal(size=size) for size in ((m, k), (k, n)))
    work = []

    class Watched(np.ndarray):
        def __matmul__(self, other):
            work.append(self.size * other.shape[1])
            return np.asarray(self) @ np.asarray(other)

    found = canonical.product(left.view(Watched), right.view(Watched))
    np.testing.assert_allclose(found, left @ right, rtol=1e-9, atol=1e-9)
    assert sum(work) == m * k * n
    assert max(work) <= canonical.SMALL


@pytest.mark.parametrize("n", [0, 1, 24, 25, 97, 188])
def test_an_inverse_root_is_that_of_cholesky(n):
    rows = np.random.default_rng(n).normal(size=(40, n))
    matrix = rows.T @ rows / 40.0 + 0.01 * np.eye(n)
    wanted = solved(np.linalg.cholesky(matrix), np.eye(n))
    np.testing.assert_allclose(canonical.inverse_root(matrix), wanted, rtol=1e-9, atol=1e-11)


def test_a_nearly_singular_root_is_solved_as_exactly_as_by_scipy():
    rng = np.random.default_rng(1)
    for least in (1e-2, 1e-6, 1e-10):
        turned = np.linalg.svd(rng.normal(size=(12, 12)))[0]
        spread = turned * np.logspace(0, -12, 12) @ turned.T
        scale = np.sqrt(np.diag(spread))
        root = np.linalg.cholesky(spread / np.outer(scale, scale) + least * np.eye(12))
        exact = exactly_solved(root)
        off = [
            np.abs(found - exact).max() / np.abs(exact).max()
            for found in (
                solved(root, np.eye(12)),
                solve_triangular(root, np.eye(12), lower=True),
            )
        ]
        assert off[0] <= max(2.0 * off[1], 1e-15)


def exactly_solved(root: np.ndarray) -> np.ndarray:
    """Return the inverse of a lower triangular matrix, in fractions until the end."""
    rows = [[Fraction(float(value)) for value in row] for row in root]
    found: list[list[Fraction]] = []
    for k, row in enumerate(rows):
        found.append(
            [
                (Fraction(int(k == n)) - sum(row[m] * found[m][n] for m in range(k))) / row[k]
                for n in range(len(rows))
            ]
        )
    return np.array([[float(value) for value in row] for row in found])


def test_scores_are_those_of_the_gaussian_densities():
    some = examples(three_objects(), ("weight", "area_cm2"))
    learned = Learned.of(some.readings, some.labels, 0.01)
    it = learned.discriminant(Manner(0.01, 2, 5.0))
    row = learned.located(np.array([[700.0, 50.0]]))
    scores, at = it(row), (row - it.means)[:, :]
    for k in range(3):
        own = (learned.coordinates[some.labels == k] - it.means[k]) @ it.space.variates
        covariance = (own.T @ own + 5.0 * np.eye(2)) / 29.0 * (1.0 + 1.0 / 25.0)
        off = at[k] @ it.space.variates
        square = off @ np.linalg.solve(covariance, off)
        assert scores.squares[0, k] == pytest.approx(square)
        wanted = square + np.linalg.slogdet(covariance)[1]
        assert scores.unlikeliness[0, k] == pytest.approx(wanted)
        beside = (at[k] @ at[k] - off @ off) / (1.0 + 1.0 / 25.0)
        assert scores.beside[0, k] == pytest.approx(beside, abs=1e-6)
        less = (1.0 / 4.0 + 1.0 / 25.0) / (1.0 + 1.0 / 25.0)  # a mean of four varies so much less
        assert it(row, 4).squares[0, k] == pytest.approx(square / less)
        assert it(row, 4).unlikeliness[0, k] == pytest.approx(
            square / less + np.linalg.slogdet(less * covariance)[1]
        )


def test_runs_of_successive_readings_are_left_out_together():
    some = examples({"a": normal_rows(np.random.default_rng(0), (9.0, 5.0), (1, 1), 20),
                     "b": [[1.0, 2.0]]}, ("weight", "area_cm2"))  # fmt: skip
    assert some.runs.tolist() == [*np.repeat(np.arange(10), 2), -1]
    assert len(name_left_out(some, Manner(0.1, 8, 16.0)).squares) == 20
    # 20 readings make 6 runs of 3 or 4, and each run one mean of three
    assert len(name_left_out(some, Manner(0.1, 8, 16.0), 3).labels) == 6


def test_a_choice_says_how_well_it_did():
    choice = Choice(Manner(0.1, 8, 16.0), 200, 190, 200, 180)
    assert str(choice) == (
        "95.0 % of 200 readings are named right when left out; 90 % are unknown when their object"
        " is left out whole"
    )
    assert str(choice._replace(n_left_out=0, n_strangers=0)) == "too few readings to leave any out"
