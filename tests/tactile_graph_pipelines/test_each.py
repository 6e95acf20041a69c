"""Steps and whole pipelines run for each contact of a frame, in pad coordinates."""

from __future__ import annotations

import numpy as np

from tactile_graph import Circle, Frame, Mask, loads

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
