"""Parts of a footprint, and what is said where several are taken as one object."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from scipy import ndimage

from tactile_graph import Frame, load
from tactile_graph.wires import Mask
from tactile_graph_hull.parts import n_parts, several_parts


@pytest.mark.slow
@given(
    on=arrays(
        np.bool_,
        array_shapes(min_dims=2, max_dims=2, min_side=0, max_side=9),
        elements=st.booleans(),
    )
)
def test_parts_are_those_that_scipy_counts(on: np.ndarray) -> None:
    expected = ndimage.label(on, np.ones((3, 3)))[1] if on.size else 0
    assert n_parts(on) == expected


def test_the_end_of_a_row_does_not_touch_the_beginning_of_the_next() -> None:
    assert n_parts(np.array([[False, True], [False, False], [True, False]])) == 2
    assert n_parts(np.array([[False, False, True], [True, False, False]])) == 2


@pytest.mark.parametrize(("columns", "text"), [([1, 2], ""), ([1, 5, 8], "3 separate parts are ")])
def test_only_several_parts_are_worth_a_word(columns: list[int], text: str) -> None:
    on = np.zeros((4, 10), np.bool_)
    on[1:3, columns] = True
    told = several_parts(Mask(on, (1.0, 1.0)))
    assert told.startswith(text)
    assert bool(told) == bool(text)


def discs(*centres: tuple[int, int]) -> Frame:
    y, x = np.mgrid[:24, :24]
    volts = sum(np.exp(-((((x - a) ** 2 + (y - b) ** 2) / 9.0) ** 4)) for a, b in centres)
    return Frame.of(np.asarray(volts), 1.3, quantity="volt")


ONE, TWO = discs((11, 12)), discs((5, 6), (17, 16))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "node"),
    [("circle-1", "boundary"), ("circle-2", "boundary"), ("circle-3", "boundary"),
     ("ellipse-direct", "boundary"), ("rectangle-1", "boundary"), ("rectangle-2", "boundary"),
     ("rectangle-3", "rectangle")],
)  # fmt: skip
def test_one_answer_for_two_contacts_carries_a_notice(name: str, node: str) -> None:
    pipeline = load(name)
    assert list(pipeline.run(TWO).notices) == [node]
    assert pipeline.run(TWO).notices[node].startswith("2 separate parts are taken together")
    assert pipeline.run(ONE).notices == {}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["objects", "contacts", "tracks"])
def test_pipelines_that_tell_objects_apart_need_no_notice(name: str) -> None:
    assert load(name).run(TWO).notices == {}
