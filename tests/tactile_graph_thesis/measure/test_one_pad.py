"""Averages of five tables, and which of them are near to the thesis'."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import load
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.scene import load_scene
from tactile_graph_thesis.items.chapter_4.section_4_3_9_one_pad import (
    ENOUGH,
    PAD,
    SCENES,
    best_disc,
    explains,
)
from tactile_graph_thesis.measure.one_pad import averages, cells, near, pad_errors

THESIS = np.array([cell.thesis for cell in cells()])


def test_the_tables_have_39_averages() -> None:
    assert len(cells()) == 39
    assert cells()[2].words == "table 4.3, DISC I, radius"
    assert (cells()[2].thesis, cells()[-1].thesis) == (1.2, 1.3)
    assert {c.unit for c in cells() if c.quantity == "angle"} == {"degree"}


@pytest.mark.slow
def test_averages_come_in_the_order_of_the_cells() -> None:
    frames = [
        list(load("circle-1").with_source("simulate", scene=s, frames=12).frames(3))
        for s in ("discs", "rectangles")
    ]
    errors = pad_errors(*frames)
    assert list(errors) == list(dict.fromkeys((c.table, c.object) for c in cells()))
    found = averages(errors)
    assert found.shape == (39,)
    assert found[2] == pytest.approx(errors["table-4.3", "DISC I"][:, 2].mean())
    assert found[-1] == pytest.approx(np.nanmean(errors["table-4.8", "RECTANGLE II"][:, 2]))


def test_readings_without_an_answer_are_left_out_and_none_at_all_is_not_near() -> None:
    errors = {(c.table, c.object): np.full((2, 3), np.nan) for c in cells()}
    errors["table-4.3", "DISC I"] = np.array([[0.3, 1.3, 1.2], [np.nan] * 3])
    found = averages(errors)
    assert found[:3].tolist() == [0.3, 1.3, 1.2]
    assert np.isnan(found[3:]).all()
    assert near(found).sum() == 3


def test_an_average_a_third_off_is_not_near() -> None:
    assert near(1.29 * THESIS).all()
    assert near(0.71 * THESIS).all()
    assert not near(1.32 * THESIS).any()
    assert not near(0.68 * THESIS).any()


def test_fewer_than_24_near_ones_explain_nothing() -> None:
    found = THESIS.copy()
    found[ENOUGH:] *= 2.0
    assert explains(found).holds
    found[0] *= 2.0
    assert not explains(found).holds


def test_a_disc_that_errs_less_than_the_first_refutes_the_order() -> None:
    assert best_disc(THESIS).holds
    for k, cell in enumerate(cells()):
        if cell.quantity == "radius" and cell.object != "DISC I":
            found = THESIS.copy()
            found[k] = 0.1
            assert not best_disc(found).holds, cell


def test_the_pad_is_the_thesis_one_but_for_what_was_fitted() -> None:
    pad, thesis = load_pad(PAD), load_pad("thesis")
    assert (pad.geometry, pad.circuit, pad.converter, pad.scan) == (
        thesis.geometry, thesis.circuit, thesis.converter, thesis.scan)  # fmt: skip
    assert (thesis.contact.lean_cm, thesis.unevenness.strays) == (0.0, 0.0)
    for ours, theirs in zip(SCENES, ("discs", "rectangles"), strict=True):
        for one, other in zip(load_scene(ours).in_turn, load_scene(theirs).in_turn, strict=True):
            assert one[0].touches <= 1.0 == other[0].touches
            assert str(one[0]).replace(f"touches={one[0].touches}", "touches=1.0") == str(other[0])
