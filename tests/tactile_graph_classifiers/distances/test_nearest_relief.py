"""The object whose relief reads most like a press, on the sample and on a strip of one's own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_reliefs import STRIP, THINGS, Pad, Thing, disc, learned_with_reliefs
from tactile_graph import Frame, Image, load
from tactile_graph.errors import DataError
from tactile_graph_classifiers.commands.learn import image_of
from tactile_graph_classifiers.distances.identity import UNKNOWN
from tactile_graph_classifiers.distances.nearest_relief import NearestRelief
from tactile_graph_classifiers.measuring.reader import Given, Reader
from tactile_graph_classifiers.measuring.shapes import true_name


def pressed(pad: Pad, thing: Thing, n: int) -> list[Frame]:
    return [pad.press(thing, k) for k in range(n)]


def readings(frames: list[Frame]):
    pipeline = load("describe")
    image = image_of(pipeline, "features", ())
    return Reader(Given(pipeline, "features", 0, image)).readings(frames)


@pytest.fixture(scope="module")
def pad() -> Pad:
    return Pad(STRIP, np.random.default_rng(3))


@pytest.fixture(scope="module")
def database(pad: Pad, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("reliefs") / "objects.sqlite"
    return learned_with_reliefs(path, {thing.name: pressed(pad, thing, 15) for thing in THINGS})


@pytest.mark.slow  # reliefs are learned
def test_known_objects_are_named_and_a_stranger_is_not(pad, database):
    step = NearestRelief(database=database)
    for thing in THINGS:
        found = readings(pressed(pad, thing, 4))
        names = [step(_image(press), row).name
                 for press, row in zip(found.presses, found.rows, strict=True)]  # fmt: skip
        assert names.count(thing.name) >= 3
    stranger = readings(pressed(pad, Thing("coin", disc(0.6), 0.4), 3))
    for press, row in zip(stranger.presses, stranger.rows, strict=True):
        identity = step(_image(press), row)
        assert identity.name == UNKNOWN
        assert identity.distance > identity.limit


@pytest.mark.slow  # reliefs are learned
def test_the_less_is_to_be_accepted_the_nearer_the_limit(pad, database):
    found = readings(pressed(pad, THINGS[0], 1))
    image, row = _image(found.presses[0]), found.rows[0]
    steps = [NearestRelief(database=database, confidence=share) for share in (0.6, 0.8, 0.95)]
    limits = [step(image, row).limit for step in steps]
    assert limits == sorted(limits)
    assert limits[0] < limits[-1]
    assert NearestRelief(database=database, reject=False)(image, row).limit is None


@pytest.mark.slow  # reliefs are learned
def test_an_image_of_another_pad_is_refused(pad, database):
    found = readings(pressed(pad, THINGS[0], 1))
    step = NearestRelief(database=database)
    values = found.presses[0].values
    for wrong in (Image(values[:, :30].copy(), (0.5, 0.5)), Image(values.copy(), (0.4, 0.4))):
        with pytest.raises(DataError, match=r"reliefs in .* were learned on 12 x 40 of 0.5 cm"):
            step(wrong, found.rows[0])
    with pytest.raises(DataError, match="nothing reads more than"):
        step(Image(np.zeros(values.shape), (0.5, 0.5)), found.rows[0])


@pytest.mark.slow  # reliefs are learned
def test_what_lies_partly_off_the_pad_is_known_only_if_nothing_else_may_be_it(pad, database):
    step = NearestRelief(database=database, confidence=0.99)
    found = readings([_pushed_off(frame) for frame in pressed(pad, THINGS[1], 12)])
    names = [step(_image(press), row)
             for press, row in zip(found.presses, found.rows, strict=True)]  # fmt: skip
    for it in names:
        assert it.known == (it.distance <= it.limit < it.runner_up_distance)
        assert bool(it.note) == (it.runner_up_distance <= it.limit)
    assert any(it.known for it in names)
    assert any(it.note == "reaches the pad's edge, and may be disc too" for it in names)


def _pushed_off(frame: Frame) -> Frame:
    """Return a frame whose upper part lies beyond the pad, down to the middle of what touches."""
    values = frame.image.values
    rows = np.flatnonzero((values > 0.2 * values.max()).any(axis=1))
    middle = int(rows.mean())
    moved = np.full(values.shape, np.median(values), values.dtype)
    moved[: len(values) - middle] = values[middle:]
    return Frame.of(moved, frame.image.pitch_cm, quantity="raw")


def _image(press) -> Image:
    return Image(press.values.copy(), (press.pitch_cm, press.pitch_cm))


@pytest.mark.slow  # machine code is made for it
def test_the_pipeline_names_the_objects_of_the_thesis():
    pipeline = load("identify-reliefs").with_source("simulate", scene="identify", frames=15)
    results = list(pipeline.stream(seed=7))
    nearest = [r["identity"].nearest == true_name(r.frame) for r in results]
    assert sum(nearest) >= 14
    assert sum(r["identity"].known for r in results) >= 12
