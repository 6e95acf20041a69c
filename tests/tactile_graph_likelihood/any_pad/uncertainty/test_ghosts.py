"""Outlines on a matrix without isolation: flagged, and the user is told what it may be."""

import re

import numpy as np
import pytest

from helpers_ghosts import DIAGONAL, alone, read, share
from helpers_recordings import frames_of, shared
from tactile_graph import load
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.any_pad.observation.rising import risen
from tactile_graph_likelihood.any_pad.uncertainty.ghosts import as_ghostly, tells_of_ghosts
from tactile_graph_pads.circuits.ghosts import EVERY, GHOSTS, ghosts
from tactile_graph_pads.pad import load_pad

PAD = load_pad("thesis")
LYING = share(DIAGONAL)


def is_told(image):
    """Return whether readings above the noise look so, on cells of any shape."""
    try:
        rise = risen(image, PAD)
    except Degenerate:
        return False
    known = EVERY if image.valid is None else image.valid
    return ghosts(rise.above, rise.shows, known) == GHOSTS


def test_readings_along_rows_and_columns_of_two_objects_are_seen():
    for seed in range(5):
        assert observed(read(LYING, seed=seed), PAD).ghosts
        assert not observed(read(LYING, seed=seed, circuit=alone), PAD).ghosts


@pytest.mark.slow  # kernels of three shapes and of several objects
@pytest.mark.parametrize(
    ("pipeline", "node", "shapes_of"),
    [
        ("locate", "object", lambda its: [its.shape]),
        ("locate-circle", "circle", lambda its: [its]),
        ("locate-contacts", "located", lambda its: its.shapes),
        ("locate-objects", "objects", lambda its: its.shapes),
    ],
)
def test_located_outlines_do_not_fit_and_a_notice_says_why(pipeline, node, shapes_of):
    result = load(pipeline).run(read(LYING))
    assert not any(its.fits for its in shapes_of(result[node]))
    assert not getattr(result[node], "fits", False)
    words = r"matrix without isolation.*circuit: \{kind: floating, "
    assert re.search(words, result.notices[node])
    isolated = load(pipeline).run(read(LYING, circuit=alone))
    assert isolated.notices == {}
    if pipeline in ("locate-contacts", "locate-objects"):
        assert all(its.fits for its in shapes_of(isolated[node]))


@pytest.mark.slow  # a kernel of one shape
def test_nothing_is_said_of_outlines_of_no_contact():
    found = load("locate-contacts").run(read(LYING, circuit=alone))["located"]
    none = found._replace(shapes=(), names=(), count=0)
    assert tells_of_ghosts(none) == tells_of_ghosts(found) == ""
    posterior = as_ghostly(found.shapes[0].posterior)
    assert posterior.ghosts
    assert not posterior.fits


@pytest.mark.slow  # hundreds of frames
@pytest.mark.parametrize(
    "name",
    [
        *("vendor_exports/xsensor_data.csv", "vendor_exports/pliance_test.asc"),
        *("vendor_exports/emed_test.lst", "vendor_exports/iscan_test.csv"),
        *("vendor_exports/FrasP01L.asf", "popu_bed/supine2_2.json", "popu_bed/left7_1.json"),
        "capfingerid/P15_thumb_left_600.txt",
    ],
)
def test_no_frame_of_a_real_pad_seems_to_hold_ghosts(name):
    frames, _ = frames_of(shared(name))
    assert not any(is_told(frame.image) for frame in frames)


@pytest.mark.slow  # hundreds of frames
def test_no_frame_of_fingers_on_a_panel_seems_to_hold_ghosts():
    for path in sorted(shared("capcontact").glob("*.npz")):
        values = np.load(path)["cap"].astype(float)
        assert not is_told(Image(values, (0.479, 0.476)))
