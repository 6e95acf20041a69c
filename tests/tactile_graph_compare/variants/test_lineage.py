"""What of a node is another than in its parent."""

from __future__ import annotations

from tactile_graph import Pipeline, loads
from tactile_graph_compare.variants.lineage import nodes_between


def restored(model: str) -> Pipeline:
    node = f"  restored: {{step: restore, in: frame, with: {{model: {model}}}}}\n"
    return loads(f"pipeline: p\nnodes:\n{node}outputs: [restored]")


def test_of_a_setting_that_is_a_record_only_the_fields_that_differ_are_told() -> None:
    (change,) = nodes_between(restored("{lambda_d: 1}"), restored("{lambda_d: 2, order: 2}"))[2]
    told = [str(c) for c in change.changes]
    assert told == ["model.order: 1 -> 2", "model.lambda_d: 1.0 -> 2.0"]


def test_a_record_that_says_the_same_in_other_words_is_no_change() -> None:
    assert nodes_between(restored("{lambda_d: 4}"), restored("{}"))[2] == ()
