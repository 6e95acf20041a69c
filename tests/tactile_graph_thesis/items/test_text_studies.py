"""Studies that only the text asks for: each finding holds, and fails where it must."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tactile_graph import Mask
from tactile_graph_pads.circuits import Floating
from tactile_graph_pads.pad import load_pad
from tactile_graph_thesis.items.chapter_2.section_2_3_2_coupling_directions import (
    couples_in_columns,
    taken,
)
from tactile_graph_thesis.items.chapter_3.section_3_1_3_morphology import (
    saturates,
    shaped,
    shrinks,
    takes_noise_away,
    thick_cells,
)
from tactile_graph_thesis.items.chapter_4.section_4_3_4_broken_image import (
    KINDS,
    LOST,
    broken,
    gives_across,
)
from tactile_graph_thesis.items.chapter_5.section_5_3_2_line_patterns import (
    lone_cost_more,
    pattern_costs,
)
from tactile_graph_thesis.items.chapter_6.section_6_1_2_finer_pad import (
    FinerPads,
    better,
    finer,
)


def test_only_a_column_couples_and_floating_rows_refute_it() -> None:
    pad = load_pad("thesis")
    found = taken(pad)
    assert couples_in_columns(found).holds
    assert found.largest_v["in the same column"] > 0.04
    assert found.loss_v[found.row, found.column] == 0.0
    leaky = replace(pad, circuit=Floating())
    assert not couples_in_columns(taken(leaky)).holds
    assert not couples_in_columns(found._replace(loss_v=0.0 * found.loss_v)).holds


def test_morphology_shrinks_cleans_and_soon_stands_still() -> None:
    found = shaped()
    assert shrinks(found).holds
    assert takes_noise_away(found).holds
    assert saturates(found).holds


def test_what_morphology_is_said_to_do_is_refuted_where_it_does_not() -> None:
    found = shaped()
    assert not shrinks(found._replace(eroded=found.dilated)).holds
    assert not shrinks(found._replace(dilated=found.eroded)).holds
    assert not shrinks(found._replace(stick=found.noisy)).holds
    assert not takes_noise_away(found._replace(opened=(found.noisy,))).holds
    assert not takes_noise_away(found._replace(opened=(found.eroded,))).holds
    assert not takes_noise_away(found._replace(eroded=found.clean)).holds
    assert not saturates(found._replace(opened=(found.noisy, found.eroded))).holds


def test_squares_of_four_are_counted() -> None:
    on = np.zeros((4, 5), np.bool_)
    on[1:3, 1:4] = True
    assert thick_cells(Mask(on.copy())) == 2
    ring = on.copy()
    ring[2, 2] = False
    assert thick_cells(Mask(ring)) == 0


@pytest.mark.slow
def test_a_broken_image_keeps_its_axis_unless_an_end_is_lost() -> None:
    found = broken()
    assert found.error_degree.shape[1:3] == (len(KINDS), len(LOST))
    assert not gives_across(found).holds
    assert found.across[:, 0].max() == 0.0
    assert found.across[0, 1, 2] == 1.0
    assert np.nanmedian(found.error_degree[:, :, 0]) < 3.0
    swapped = found._replace(error_degree=found.error_degree[:, ::-1])
    assert gives_across(swapped).holds


@pytest.mark.slow
def test_lone_lines_cost_more_and_a_price_without_lines_meeting_refutes_it() -> None:
    found = pattern_costs()
    assert lone_cost_more(found).holds
    assert np.allclose(found.each["lone"], 2 * 2.7 + 0.3)
    n = np.array(found.counts)
    assert np.allclose(found.each["straight"], (2 * 2.7 + (n - 1) * 0.9) / n + 0.3)
    even = dict.fromkeys(found.each, found.each["lone"])
    assert not lone_cost_more(found._replace(each=even)).holds
    rising = found.each | {"straight": found.each["straight"][::-1]}
    assert not lone_cost_more(found._replace(each=rising)).holds


def test_a_finer_pad_has_the_same_area_and_the_law_of_a_smaller_element() -> None:
    pad = load_pad("thesis")
    twice = finer(pad, 2)
    assert twice.geometry.shape == (32, 32)
    assert twice.geometry.pitch_cm == 0.65
    assert twice.geometry.columns * twice.geometry.pitch_cm == 16 * 1.3
    at = np.array([[25.0]])
    np.testing.assert_allclose(twice.law.conductance_s(at), pad.law.conductance_s(4 * at))


def test_finer_pads_must_be_better_in_centre_and_radius() -> None:
    pitch = (1.3, 0.65)
    good, same = np.array([0.4, 0.1]), np.array([0.4, 0.4])
    assert better(FinerPads(pitch, good, good)).holds
    assert not better(FinerPads(pitch, good, same)).holds
    assert not better(FinerPads(pitch, same, good)).holds
