import math

import numpy as np
import pytest

from helpers_filters import image_of
from tactile_graph import loads
from tactile_graph.errors import DataError, PipelineError
from tactile_graph_filters.nan import all_finite, refuse_nan
from tactile_graph_filters.readings.decouple import Decouple
from tactile_graph_filters.readings.find_bad import FindBad
from tactile_graph_filters.readings.gain import Gain
from tactile_graph_filters.readings.tare import Tare
from tactile_graph_filters.thresholds.threshold_otsu import threshold_otsu
from tactile_graph_filters.thresholds.threshold_valley import threshold_valley
from tactile_graph_filters.thresholds.threshold_variable import threshold_variable


@pytest.mark.parametrize("form", ["loops", "compiled"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, None])
def test_plain_and_compiled_find_what_is_no_number(form, bad):
    if form == "compiled":
        pytest.importorskip("numba")
    values = np.array([[1e308, -1e308, 0.0], [5e-324, 1.0, 2.0]])
    if bad is not None:
        values[1, 2] = bad
    with np.errstate(invalid="ignore"):
        assert getattr(all_finite, form)(values) == (bad is None)


def test_the_first_bad_cell_is_named_and_the_others_counted():
    image = image_of([[1.0, math.inf], [math.nan, math.nan]])
    with pytest.raises(DataError, match=r"row 1, column 0: must be a number, got nan \(and 1 more"):
        refuse_nan(image)
    with pytest.raises(DataError, match=r"row 0, column 1: must be a number, got inf \(and 2 more"):
        refuse_nan(image, infinite=True)


def test_good_and_invalid_cells_are_let_through():
    refuse_nan(image_of([[1.0, math.nan]], valid=[[True, False]]), infinite=True)


FINITE = {
    "decouple": (Decouple, "volt"),
    "find_bad": (FindBad, "volt"),
    "gain": (lambda: Gain(elements=None, rows=[2.0, 1.0]), "counts"),
    "tare": (Tare, "volt"),
    "threshold_otsu": (lambda: threshold_otsu, "volt"),
    "threshold_valley": (lambda: threshold_valley, "volt"),
    "threshold_variable": (lambda: threshold_variable, "volt"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FINITE)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused_by_all_that_sum_or_remember(name, bad):
    made, quantity = FINITE[name]
    with pytest.raises(DataError, match=f"row 1, column 0: must be a number, got {bad}"):
        made()(image_of([[0.01, 0.02], [bad, 0.015]], quantity))


@pytest.mark.parametrize(
    ("step", "setting"),
    [("threshold_variable", "floor"), ("threshold_learned", "times"), ("lean_contacts", "lean")],
)
def test_what_moves_or_scales_an_answer_has_an_end(step, setting):
    node = f"{{step: {step}, in: frame, with: {{{setting}: .inf}}}}"
    with pytest.raises(PipelineError, match=f"{setting}: must be a finite number, got inf"):
        loads(f"pipeline: endless\nnodes: {{one: {node}}}\noutputs: [one]\n")
