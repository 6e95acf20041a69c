"""Index tables: every site once, colour classes without neighbours."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_mrf import picture
from tactile_graph.wires import Mask
from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare


def colour_runs(cells, near):
    """The fewest stretches of the visits within which no two cells are neighbours."""
    runs, current = 1, set()
    for cell, others in zip(cells.tolist(), near.tolist(), strict=True):
        if current & set(others):
            runs, current = runs + 1, set()
        current.add(cell)
    return runs


@pytest.mark.parametrize(("order", "classes"), [(1, 2), (2, 4), (3, 5)])
def test_visits_go_class_by_class(order, classes):
    problem = prepare(Model(order=order), picture(9, 8))
    tables = layout(problem)
    assert sorted(tables.cells.tolist()) == list(range(72))
    assert colour_runs(tables.cells, tables.near) == classes
    assert len(tables.sites) == 8 * 8 + 9 * 7


@pytest.mark.parametrize("order", [1, 2, 3])
def test_neighbours_are_mutual_and_within_the_field(order):
    on = np.random.default_rng(0).random((7, 8)) > 0.3
    problem = prepare(Model(order=order), picture(7, 8), Mask(on))
    tables = layout(problem)
    inside = set(np.flatnonzero(on).tolist())
    of = dict(zip(tables.cells.tolist(), tables.near.tolist(), strict=True))
    assert set(of) == inside
    for cell, others in of.items():
        for other in set(others) - {-1}:
            assert other in inside
            assert cell in of[other]
    sites_h, sites_v = problem.sites
    assert len(tables.sites) == sites_h.sum() + sites_v.sum()


def test_whole_fields_share_one_table_and_lines_summed_out_have_no_sites():
    one, two = (layout(prepare(Model(), picture(seed=s))) for s in (1, 2))
    assert one is two
    assert len(layout(prepare(Model(lines="marginal"), picture())).sites) == 0
