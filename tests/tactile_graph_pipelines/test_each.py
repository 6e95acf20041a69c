"""Steps and whole pipelines run for each contact of a frame, in pad coordinates."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from helpers_cli import call
from helpers_objects import frames
from tactile_graph import Circle, Frame, Mask, Polygon, load, loads
from tactile_graph.draw.strip import save_strip

TEXT = """
pipeline: each-contact
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.5}}
  parts: {step: contacts, in: [frame, footprint]}
  fine: {step: subdivide, in: parts.contacts, each: true}
  circles: {use: circle-1, in: parts.contacts, each: true}
outputs: [fine, circles]
"""


def two_blocks() -> Frame:
    values = np.zeros((16, 16))
    values[1:6, 1:6] = 1.0
    values[9:14, 8:13] = 2.0
    return Frame.of(values, 1.0, quantity="volt")


def test_a_step_that_takes_a_mask_runs_for_each_contact_that_provides_one() -> None:
    fine = loads(TEXT).run(two_blocks())["fine"]
    assert [type(m) for m in fine] == [Mask, Mask]
    assert [m.count for m in fine] == [100, 100]
    assert [m.origin_cm for m in fine] == [(1.0, 1.0), (8.0, 9.0)]


def test_a_pipeline_runs_for_each_contact_and_answers_where_it_lies_on_the_pad() -> None:
    # The contacts' own images are full of contact, which circle-1 would skip: give them a margin.
    text = TEXT.replace("[frame, footprint]}", "[frame, footprint], with: {margin: 1}}")
    circles = loads(text).run(two_blocks())["circles"]
    assert all(isinstance(c, Circle) for c in circles)
    assert [(round(c.x_cm, 6), round(c.y_cm, 6)) for c in circles] == [(3.5, 3.5), (10.5, 11.5)]


def test_with_no_contact_at_all_both_are_skipped() -> None:
    empty = Frame.of(np.zeros((16, 16)), 1.0, quantity="volt")
    result = loads(TEXT).run(empty)
    assert not result.failures
    assert len(result) == 0


LOCALISERS = {
    "circle-1": "disc",
    "circle-2": "disc",
    "circle-3": "disc",
    "circle-likelihood": "disc",
    "bayes-circle": "disc",
    "ellipse-direct": "disc",
    "rectangle-1": "rectangle",
    "rectangle-2": "rectangle",
    "rectangle-3": "rectangle",
    "rectangle-likelihood": "rectangle",
    "bayes-rectangle": "rectangle",
}
PER_CONTACT = """
pipeline: per-contact
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  parts: {step: split_contacts, in: [frame, footprint], with: {margin: 1}}
  found: {use: %s, in: parts.contacts, each: true}
outputs: [found]
"""
TWO = {
    "disc": {"shape": "disc", "weight_g": 2200, "radius_cm": 3.6},
    "rectangle": {"shape": "rectangle", "weight_g": 2200, "length_cm": 9.0, "breadth_cm": 5.5},
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "kind"),
    [
        pytest.param(*it, marks=[pytest.mark.slow] if "likelihood" in it[0] else [])
        for it in LOCALISERS.items()
    ],
)
def test_every_localiser_places_each_of_two_contacts(name: str, kind: str) -> None:
    turn = {} if kind == "disc" else {"angle_deg": 20.0}
    objects = [{**TWO[kind], **turn, "place": place} for place in ([5.5, 5.0], [14.5, 15.0])]
    (frame,) = frames({"objects": objects}, 1, 3, sigma=0.0, voids=0.0)
    result = loads(PER_CONTACT % name).run(frame)
    assert not result.failures
    found = result["found"]
    if hasattr(found, "_fields"):  # of a pipeline with several outputs: a list for each
        found = found[0]
    places = sorted((s.x_cm, s.y_cm) for s in found)
    assert np.array(places) == pytest.approx(np.array([[5.5, 5.0], [14.5, 15.0]]), abs=0.5)


FOLLOWED = """
pipeline: followed
source: {step: simulate, with: {scene: mixed}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  objects: {step: split_contacts, in: [frame, footprint], with: {margin: 1}}
  outlines: {step: boundary_scan, in: objects.contacts, each: true}
  hulls: {step: hull, in: outlines, each: true}
  circles: {step: fit_circle, in: hulls, each: true}
  tracks: {step: track, in: circles}
outputs: [hulls, circles, tracks]
"""


@pytest.mark.slow
def test_shapes_fitted_to_each_contact_are_followed_drawn_and_reported(tmp_path: Path) -> None:
    Path(tmp_path / "followed.yaml").write_text(FOLLOWED)
    pipeline = load(tmp_path / "followed.yaml")
    results = [pipeline.run(frame) for frame in islice(pipeline.frames(), 3)]
    assert all(r["tracks"].count == len(r["circles"]) == len(r["hulls"]) for r in results)
    assert {type(h) for r in results for h in r["hulls"]} == {Polygon}
    assert all(track.mask is None for r in results for track in r["tracks"].tracks)
    save_strip(results, tmp_path / "strip.png")
    assert (tmp_path / "strip.png").stat().st_size > 10_000
    report = str(tmp_path / "report.html")
    done = call("compare", str(tmp_path / "followed.yaml"), "objects", "--frames", 2,
                "--report", report)  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "<svg" in Path(report).read_text()
