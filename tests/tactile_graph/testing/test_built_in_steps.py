"""Every built-in step keeps the promises of steps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_modes import answered_by
from helpers_reliefs import learned_with_reliefs
from tactile_graph import Frame, Image
from tactile_graph.plugins.registry import installed
from tactile_graph.steps.signature import Kind
from tactile_graph.testing import examine_step, isolated
from tactile_graph.testing.cases import PITCH_CM, SHAPE
from tactile_graph_classifiers.reliefs.choosing_law import BEGIN
from tactile_graph_classifiers.reliefs.of_database import FEWEST
from tactile_graph_pads.learned import Elements, write_elements
from tactile_graph_pads.learning.patch import N_PLACE, PatchKind
from tactile_graph_pads.learning.place import PlaceCorrection, write_place

FAMILIES = sorted({p.name for p in installed().plugins if p.offers.get("steps")})
FEW_LEVELS = {"model": {"n_levels": 6}}
ROUGH = {"precision": 1.0, "pressure": "even"}
COARSE = {"precision": 1.0}
ONE_DISC = {"kinds": ["disc"], "most": 1}
SETTINGS: dict[str, dict[str, Any]] = {
    # What has no default.
    "gain": {"rows": [1.0] * SHAPE[0]},
    "hit_or_miss": {"hit": [[0, 1, 0], [1, 1, 1], [0, 1, 0]]},
    "simplify_polygon": {"corners": 4},
    "threshold": {"level": 0.3},
    # What would take many seconds in plain loops.
    **dict.fromkeys(("gnc", "graph_cuts", "icm", "restore"), FEW_LEVELS),
    "gibbs": {**FEW_LEVELS, "n_sweeps": 20},
    "mean_field": {**FEW_LEVELS, "cooling": 0.2, "n_sweeps": 1},
    "trw": {"model": {"n_levels": 6, "lines": "marginal"}, "n_sweeps": 3},
    "posterior": {**FEW_LEVELS, "n_burn": 5, "n_samples": 8},
    **dict.fromkeys(
        (
            "choose_shape",
            "fit_footprint",
            "follow_footprint",
            "footprint_disc",
            "footprint_ellipse",
            "footprint_rectangle",
            "identify_footprint",
        ),
        ROUGH,
    ),
    "footprint_by_order": COARSE,
    **dict.fromkeys(("fit_footprints", "locate_objects"), ONE_DISC),
    **dict.fromkeys(("locate", "locate_disc", "locate_ellipse", "locate_rectangle"), COARSE),
    "locate_contacts": {**COARSE, "shapes": ["disc", "ellipse"]},
}
QUICK = ("erode", "fit_circle", "hull", "contacts", "force", "tare")
LOOPS_OF_OTHERS = (
    *("choose_shape", "fit_footprint", "follow_footprint", "identify_footprint"),
    *("locate", "locate_contacts", "locate_objects"),
)
"""Steps answered by machine code: plain loops are tried by those that look for one kind of outline,
which these ask one after the other."""
NEEDS_RELIEFS = ("nearest_relief",)
"""Known of one pad only; a test of their own learns objects on it."""
NEEDS_A_PAD = ("correct_place", "correct_readings", "threshold_learned")


@pytest.fixture
def pad(tmp_path: Path) -> str:
    """A pad of the ordinary case's shape, learned in volts."""
    kind = PatchKind(3)
    n = N_PLACE + kind.size
    correction = PlaceCorrection(
        kind, SHAPE, np.zeros(kind.size), 1.0, np.zeros((n, 2)), np.zeros((n, n)), np.ones(2)
    )
    write_place(tmp_path / "place.npz", correction)
    state = np.full(SHAPE, "good", dtype="U8")
    state[1, 2] = "dead"
    table = Elements(np.full(SHAPE, 0.01), np.full(SHAPE, 0.01), np.ones(SHAPE), state)
    write_elements(tmp_path / "table.csv", table)
    path = tmp_path / "pad.yaml"
    path.write_text(
        f"learned: {{reading: volt, rows: {SHAPE[0]}, columns: {SHAPE[1]}, "
        f"pitch_cm: [{PITCH_CM[0]}, {PITCH_CM[1]}], origin_cm: [0, 0], elements: table.csv, "
        "noise: 0.01, touched_from: 0.1, gain_of: volt, place: place.npz}\n"
    )
    return str(path)


@pytest.mark.slow
@pytest.mark.parametrize("name", QUICK)
def test_a_sample_of_them_does(name: str) -> None:
    report = examine_step(name, settings=SETTINGS.get(name))
    assert (report.untried, report.lines()) == ("", [])


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_every_step_of_a_family_does(family: str, pad: str) -> None:
    registry = isolated()
    (plugin,) = (p for p in registry.plugins if p.name == family)
    settings = {**SETTINGS, **{name: {"pad": pad} for name in NEEDS_A_PAD}}
    broken, untried = [], []
    for name in {*plugin.offers["steps"]}.difference(NEEDS_RELIEFS):
        with answered_by("auto" if name in LOOPS_OF_OTHERS else "plain"):
            report = examine_step(name, settings=settings.get(name), registry=registry)
        broken += report.lines()
        if registry.step(name).kind is not Kind.SOURCE:
            untried += [name] * bool(report.untried or not report.n_values)
    assert (broken, untried) == ([], [])


@pytest.mark.slow
@pytest.mark.parametrize("name", NEEDS_RELIEFS)
def test_a_step_of_reliefs_does(name: str, tmp_path: Path) -> None:
    rng = np.random.default_rng(5)

    def frames(radius_cells: float) -> list[Frame]:
        places = rng.uniform((2.6, 2.6), (5.4, 6.4), (FEWEST, 2))
        return [soft_disc(row, column, radius_cells, rng) for row, column in places]

    path = tmp_path / "objects.sqlite"
    learned_with_reliefs(path, {"small": frames(1.5), "large": frames(2.4)}, BEGIN)
    report = examine_step(name, settings={"database": str(path)})
    assert (report.untried, report.lines()) == ("", [])
    assert report.n_values


def soft_disc(row: float, column: float, radius_cells: float, rng: np.random.Generator) -> Frame:
    """Return a frame of the ordinary case's pad, in volts."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]] + 0.5
    volts = np.clip(radius_cells + 0.5 - np.hypot(x - column, y - row), 0.0, 1.0)
    volts *= 1.0 + 0.03 * rng.standard_normal(SHAPE)
    return Frame(Image(volts, PITCH_CM, (0.0, 0.0), "volt"), 0, 0.0)


def test_what_is_told_here_exists() -> None:
    names = {*SETTINGS, *LOOPS_OF_OTHERS, *NEEDS_A_PAD, *NEEDS_RELIEFS, *QUICK}
    assert names <= set(installed().names("steps"))
