"""Erode, dilate, open and close against the definition, scipy.ndimage and their own algebra."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from helpers_filters import ELEMENTS, drawn, elements, mask_of, masks, random_mask, same_grid
from helpers_modes import held
from tactile_graph_filters.morphology.close import Close
from tactile_graph_filters.morphology.dilate import Dilate
from tactile_graph_filters.morphology.elements import parse_element
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_filters.morphology.erosion import make_plan, sweep
from tactile_graph_filters.morphology.open import Open

SHAPES = [(16, 16), (32, 32), (1, 1), (1, 9), (7, 1), (5, 40)]


def eroded_by_definition(values, cells, border):
    """Equation 3.3, cell by cell: x such that B_x lies in X."""
    return hits(values, cells, border).all(axis=0)


def dilated_by_definition(values, cells, border):
    """Equation 3.4, cell by cell: x such that B_x hits X."""
    return hits(values, cells, border).any(axis=0)


def hits(values, cells, border):
    down, right = cells.shape[0] // 2, cells.shape[1] // 2
    padded = np.pad(values, ((down, down), (right, right)), constant_values=border)
    rows, columns = values.shape
    return np.array([padded[i : i + rows, j : j + columns] for i, j in np.argwhere(cells)])


@pytest.mark.parametrize("border", [False, True])
@pytest.mark.parametrize("element", ELEMENTS, ids=str)
@pytest.mark.parametrize("twin", ["reference", "compiled"])
def test_both_twins_do_what_the_definition_says(element, border, twin):
    parsed = parse_element(element)
    kernel = getattr(sweep, twin)
    if twin == "compiled":
        pytest.importorskip("numba")
    for seed, shape in enumerate(SHAPES):
        values = random_mask(seed, shape, share=0.85).values
        out = np.empty(shape, bool)
        kernel(values, make_plan(parsed, border=border), out)
        assert np.array_equal(out, eroded_by_definition(values, parsed.cells, border))
        kernel(held(~values), make_plan(parsed, dilate=True, border=border), out)
        assert np.array_equal(out, dilated_by_definition(~values, parsed.cells, border))
        for dilate in (False, True):
            pair = (parsed.reflected, parsed) if dilate else (parsed, parsed.reflected)
            plan = make_plan(*pair, dilate=dilate, border=border)
            kernel(values, plan, out)
            assert np.array_equal(out, both_by_definition(values, parsed, dilate, border))


def both_by_definition(values, element, dilate, border):
    """Opening or closing with the mask on a plane wide enough that no edge is felt."""
    wide = 2 * max(element.cells.shape)
    turned = element.reflected.cells
    plane = np.pad(values, wide, constant_values=border)
    if dilate:
        plane = dilated_by_definition(plane, turned, border)
        plane = eroded_by_definition(plane, element.cells, border)
    else:
        plane = eroded_by_definition(plane, element.cells, border)
        plane = dilated_by_definition(plane, turned, border)
    return plane[wide:-wide, wide:-wide]


@pytest.mark.parametrize("border", [False, True])
@pytest.mark.parametrize("element", ELEMENTS, ids=str)
def test_steps_agree_with_scipy(element, border):
    cells = parse_element(element).cells
    given = {"structure": cells, "border_value": border}
    turned = {"structure": cells[::-1, ::-1], "border_value": border}  # scipy turns it, we do not
    for seed in range(4):
        mask = random_mask(seed, (19, 23), share=0.8)
        v = mask.values
        step = {"element": element, "border": border}
        assert np.array_equal(Erode(**step)(mask).values, ndimage.binary_erosion(v, **given))
        assert np.array_equal(Dilate(**step)(mask).values, ndimage.binary_dilation(v, **turned))
        inner = mask_of(np.pad(v, 30))  # scipy cuts off at the edge between the two
        if not border:
            assert np.array_equal(
                Open(**step)(inner).values, ndimage.binary_opening(inner.values, cells)
            )
            assert np.array_equal(
                Close(**step)(inner).values, ndimage.binary_closing(inner.values, cells)
            )


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(masks(), elements(), st.booleans())
def test_opening_shrinks_closing_grows_and_both_are_done_once(mask, element, border):
    opened = Open(element=element, border=border)(mask)
    closed = Close(element=element, border=border)(mask)
    assert not (opened.values & ~mask.values).any()
    assert not (mask.values & ~closed.values).any()
    if not border:
        assert np.array_equal(Open(element=element)(opened).values, opened.values)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(masks(), elements(), st.booleans())
def test_dilation_is_the_erosion_of_the_complement(mask, element, border):
    other = mask_of(~mask.values)
    dilated = Dilate(element=element, border=border)(mask).values
    assert np.array_equal(dilated, ~Erode(element=element, border=not border)(other).values)


def test_erosion_and_dilation_remove_noise_and_keep_the_object():
    noisy = drawn("""
        #.......
        ..####..
        ..####.#
        ..####..
        ..####..
        .......#
    """)
    cleaned = Dilate(element="square3")(Erode(element="square3")(noisy))
    assert cleaned.count == 16
    assert cleaned.values[1:5, 2:6].all()
    assert np.array_equal(Open(element="square3")(noisy).values, cleaned.values)


def test_closing_does_not_eat_a_footprint_at_the_edge_of_the_pad():
    mask = drawn("""
        ###.
        #.#.
        ###.
    """)
    closed = Close(element="cross3")(mask)
    assert closed.values[:, :3].all()
    assert not closed.values[:, 3].any()


def test_cells_outside_count_as_the_border_setting_says():
    full = mask_of(np.ones((5, 5)))
    assert Erode(element="square3")(full).count == 9
    assert Erode(element="square3", border=True)(full).count == 25
    empty = mask_of(np.zeros((5, 5)))
    assert Dilate(element="square3")(empty).count == 0
    assert Dilate(element="square3", border=True)(empty).count == 16


@pytest.mark.parametrize("step", [Erode, Dilate, Open, Close])
def test_the_grid_is_kept_and_the_result_frozen(step):
    mask = random_mask(3)
    result = step(element="disc5")(mask)
    assert same_grid(mask, result)
    assert not result.values.flags.writeable


@pytest.mark.parametrize("step", [Erode, Dilate, Open, Close])
def test_a_wrong_element_is_refused_when_the_step_is_made(step):
    with pytest.raises(ValueError, match="did you mean 'cross3'"):
        step(element="kross3")


def test_big_elements_take_few_sweeps():
    """The cost per cell must not grow with the number of cells of an element."""
    assert len(make_plan(parse_element("square21"))) - 1 <= 10
    assert len(make_plan(parse_element("square:255"))) - 1 <= 16
    assert len(make_plan(parse_element("disc5"))) - 1 <= 7


@pytest.mark.parametrize("times", [1, 2, 5])
@pytest.mark.parametrize(
    "element", ["cross3", "square3", [[1, 1, 0], [0, 1, 0], [0, 0, 0]]], ids=str
)
def test_closing_several_times_dilates_as_often_and_then_erodes_as_often(element, times):
    mask = mask_of(np.pad(random_mask(times, (17, 20), share=0.3).values, 20))
    turned = parse_element(element).reflected.cells.astype(int).tolist()
    expected = mask
    for _ in range(times):
        expected = Dilate(element=turned)(expected)
    for _ in range(times):
        expected = Erode(element=element)(expected)
    assert np.array_equal(Close(element=element, times=times)(mask).values, expected.values)
