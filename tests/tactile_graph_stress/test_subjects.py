"""Which steps are stressed, and how they are fed."""

import pytest

from helpers_stress import FAKES, subject_of
from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph_stress.subject import chosen, subjects

KINDS = {
    "circle": {"fit_circle", "fit_circle_kasa", "fit_circle_taubin", "fit_circle_hyper",
               "fit_circle_thesis"},
    "ellipse": {"fit_ellipse", "fit_ellipse_direct", "fit_ellipse_origin", "ellipse_sweep"},
    "rectangle": {"fit_rectangle", "min_area_rectangle", "rectangle_from_ellipse"},
    "hull": {"hull", "hull_graham", "hull_qhull", "hull_beneath_beyond"},
    "orientation": {"orientation"},
    "decouple": {"decouple"},
    "restore": {"gibbs", "icm", "mean_field", "gnc", "restore", "graph_cuts", "trw", "posterior"},
    "mask": {"orientation", "orientation_robust", "boundary_scan", "fit_rectangle_load"},
}  # fmt: skip


def test_every_fitter_hull_orientation_decoupler_and_restorer_is_stressed():
    found, _ = subjects(installed())
    for kind, names in KINDS.items():
        assert names <= {s.name for s in found if s.kind == kind}


def test_what_cannot_be_fed_is_told_why():
    left = {one.name: one.why for one in subjects(installed())[1]}
    assert left["track"] == "nothing here makes its port 'contacts'"
    assert left["simulate"] == "a source"
    assert left["hit_or_miss"] == "needs its setting 'hit'"


def test_a_third_partys_steps_are_among_them():
    assert subject_of("centred", registry=FAKES).kind == "circle"


def test_steps_kinds_and_plugins_can_be_named():
    found, _ = subjects(installed())
    assert {s.name for s in chosen(found, ("icm", "decouple"))[0]} == {"icm", "decouple"}
    assert {s.kind for s in chosen(found, ("circle",))[0]} == {"circle"}
    assert "restore" in {s.name for s in chosen(found, ("mrf",))[0]}
    with pytest.raises(UsageError, match=r"named 'fit_cirle' can be stressed; did you mean 'fit_c"):
        chosen(found, ("fit_cirle",))


def test_what_is_left_of_what_is_named_comes_with_the_why():
    found, left = subjects(installed())
    wanted, of_named = chosen(found, ("icm", "simulate"), left)
    assert {s.name for s in wanted} == {"icm"}
    assert [str(one) for one in of_named] == ["step 'simulate' cannot be stressed: a source"]
    assert "track" in {one.name for one in chosen(found, ("tracking", "icm"), left)[1]}
    assert chosen(found, (), left)[1] == left
    assert chosen(found, ("circle",), left)[1] == []


def test_an_ellipse_about_an_axis_gets_its_points_turned_along_it():
    wires = subject_of("fit_ellipse_origin").wires
    assert wires == {"points": "rotate_points", "axis": "orientation"}
