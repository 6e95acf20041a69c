import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import references_filters as references
from helpers_filters import image_of, same_grid
from tactile_graph import Frame, load, loads
from tactile_graph.errors import DataError, PipelineError, RuleError
from tactile_graph_filters.readings.force import Force, floored


def test_the_thesis_law_passes_through_its_two_points():
    siemens = image_of([[1 / 80e3, 1 / 1e3, 0.0, -1e-9]], "siemens")
    grams = Force()(siemens)
    assert grams.values == pytest.approx(np.array([[100.0, 2000.0, 0.0, 0.0]]))
    assert grams.quantity == "gram"
    assert grams.valid is None
    assert same_grid(siemens, grams)


def test_beyond_saturation_a_cell_is_invalid_and_not_clipped():
    grams = Force()(image_of([[10.0, 1 / 80e3]], "siemens"))
    assert grams.valid.tolist() == [[False, True]]
    assert grams.values == pytest.approx(np.array([[0.0, 100.0]]))


def test_a_curve_joins_its_points_by_lines_from_zero_on():
    force = Force(curve=[(1.0, 100.0), (2.0, 400.0)])
    grams = force(image_of([[-1.0, 0.5, 1.5, 2.0, 2.1]]))
    assert grams.values.tolist() == [[0.0, 50.0, 250.0, 400.0, 0.0]]
    assert grams.valid.tolist() == [[True, True, True, True, False]]


def test_a_polynomial_gives_grams_up_to_where_it_was_fitted():
    force = Force(polynomial=[1.0, 0.0, 10.0], up_to=3.0)
    grams = force(image_of([[-1.0, 0.0, 1.0, 3.0, 3.5]]))
    assert grams.values.tolist() == [[0.0, 0.0, 11.0, 91.0, 0.0]]
    assert grams.valid.tolist() == [[True, True, True, True, False]]
    assert Force(polynomial=[-5.0, 1.0])(image_of([[1.0]])).values.tolist() == [[0.0]]


def test_what_is_not_a_law_has_no_floor_unless_told():
    image = image_of([[0.0, 0.1, 0.2, 1.0]])
    for force in (Force(curve=[(1.0, 1.0)]), Force(polynomial=[0.0, 1.0])):
        assert force(image).values.tolist() == [[0.0, 0.1, 0.2, 1.0]]
    for told in ({"curve": [(1.0, 1.0)]}, {"polynomial": [0.0, 1.0]}):
        assert Force(**told, floor_g=0.2)(image).values.tolist() == [[0.0, 0.0, 0.2, 1.0]]


def test_invalid_cells_stay_invalid():
    image = image_of([[0.0, 1 / 80e3]], "siemens", valid=[[False, True]])
    assert Force()(image).valid.tolist() == [[False, True]]


def test_a_law_reads_nothing_but_siemens():
    with pytest.raises(RuleError, match="a force law reads siemens, got volt; decouple"):
        Force()(image_of([[1.0]]))


def test_nan_is_refused():
    with pytest.raises(DataError, match="row 0, column 0: must be a number, got nan"):
        Force(curve=[(1.0, 1.0)])(image_of([[math.nan]]))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"pad": "thesis", "curve": [(1.0, 1.0)]}, "at most one .* got pad and curve"),
        ({"polynomial": []}, "needs at least one coefficient"),
        ({"up_to": 3.0}, "up_to belongs to polynomial"),
        ({"curve": []}, "needs at least one point"),
        ({"curve": [(1.0, 5.0), (2.0, 4.0)]}, r"must rise .* got \(2, 4\) after \(1, 5\)"),
        ({"curve": [(1.0, 5.0), (1.0, 6.0)]}, r"must rise .* got \(1, 6\) after \(1, 5\)"),
        ({"curve": [(-1.0, 5.0)]}, r"must rise .* got \(-1, 5\) after \(0, 0\)"),
    ],
)
def test_settings_that_do_not_go_together_are_refused(settings, words):
    with pytest.raises(ValueError, match=words):
        Force(**settings)


def test_huge_loads_are_not_taken_for_infinite():
    grams = Force(polynomial=[0.0, 1e200])(image_of([[1.0, 2.0]]))
    assert grams.values.tolist() == [[1e200, 2e200]]
    assert grams.valid is None or grams.valid.all()


CHAIN = """
pipeline: weight
nodes:
  volts: {step: volts, in: frame}
  siemens: {step: decouple, in: volts}
  grams: {step: force, in: siemens}
outputs: [grams]
"""


@pytest.mark.parametrize(
    ("scene", "weight_g"), [("empty", 0.0), ("disc-1", 1860.0), ("disc-2", 6360.0)]
)
def test_a_pads_counts_weigh_what_lies_on_it_and_an_empty_pad_nothing(scene, weight_g):

    source = load("circle-3").with_source("simulate", scene=scene, frames=3, output="counts")
    for frame in source.frames(seed=0):
        assert loads(CHAIN).run(frame)["grams"].total == pytest.approx(weight_g, rel=0.03)


def test_a_law_on_volts_is_refused_when_the_file_is_loaded():
    nodes = "{v: {step: volts, in: frame}, f: {step: force, in: v%s}}"
    text = f"{{pipeline: p, nodes: {nodes}, outputs: [f]}}"
    with pytest.raises(PipelineError, match="'force' takes siemens at port 'image', got volt"):
        loads(text % "")
    assert loads(text % ", with: {curve: [[1, 100]]}").outputs


def test_a_law_on_a_frame_of_volts_is_refused_before_it_is_computed():
    pipeline = loads("{pipeline: p, nodes: {f: {step: force, in: frame}}, outputs: [f]}")
    with pytest.raises(RuleError, match="takes siemens at port 'image', got a frame of volt"):
        pipeline.run(Frame(image_of([[1.0]], "volt")))


def test_loads_below_the_floor_are_none_at_all():
    image = image_of([[0.004, 0.006, 0.02]], "volt")
    step = Force(polynomial=[0.0, 1000.0], floor_g=5.0)
    assert step(image).values == pytest.approx(np.array([[0.0, 6.0, 20.0]]))


@pytest.mark.slow
@given(arrays(np.float64, (4, 5)), st.floats(0, 100))
def test_loads_below_the_floor_are_put_to_0_as_by_the_reference(grams, floor_g):
    pytest.importorskip("numba")
    expected = grams.copy()
    finite = references.floored(expected, floor_g)
    for which in (floored.reference, floored.compiled):
        got = grams.copy()
        with np.errstate(invalid="ignore"):
            assert which(got, floor_g) == finite
        assert np.array_equal(got, expected, equal_nan=True)


def test_cells_beyond_the_calibrated_range_carry_a_notice():
    pipeline = loads(
        "pipeline: p\nabout: x\nnodes:\n"
        "  grams: {step: force, in: frame, with: {polynomial: [0, 100], up_to: 3}}\n"
        "  load: {step: load, in: grams}\noutputs: [load]\n"
    )
    within = Frame.of([[1.0, 2.0], [0.0, 3.0]], quantity="volt")
    beyond = Frame.of([[1.0, 4.0], [0.0, 3.5]], quantity="volt")
    broken = Frame.of([[1.0, np.nan], [0.0, 3.0]], quantity="volt")
    assert pipeline.run(within).notices == {}
    assert pipeline.run(beyond).notices["grams"].startswith("2 cells read more than the law")
    assert pipeline.run(beyond)["load"].n_left_out == 2
    assert pipeline.run(broken).notices == {}


def test_a_pad_whose_learned_law_reads_something_else_says_where_that_law_is():
    learned = {
        "reading": "raw", "rows": 1, "columns": 1, "pitch_cm": [1.0, 1.0], "origin_cm": [0.0, 0.0],
        "elements": "p.elements.csv", "noise": 0.5, "touched_from": 3.0,
        "curve": [[3.0, 0.0], [9.0, 18.0]],
    }  # fmt: skip
    pad = {"geometry": {"rows": 1, "columns": 1}, "learned": learned}
    nodes = f"{{f: {{step: force, in: frame, with: {{pad: {pad}}}}}}}"
    pipeline = loads(f"{{pipeline: p, nodes: {nodes}, outputs: [f]}}")
    with pytest.raises(RuleError, match=r"setting 'pad' .* got a frame of raw; .* learned\.curve"):
        pipeline.run(Frame(image_of([[1.0]], "raw")))
