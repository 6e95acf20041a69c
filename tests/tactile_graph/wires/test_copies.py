"""Frames, images and pipelines are copied and pickled: other processes and notebooks need them."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_graphs import registry
from tactile_graph import Circle, Frame, Image, Mask, Points, load, loads
from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.outcomes.outcome import Failed
from tactile_graph.errors import Degenerate, UsageError
from tactile_graph.wires.frame import TrueObject

WAYS: list[Callable[[Any], Any]] = [
    copy.copy, copy.deepcopy, lambda thing: pickle.loads(pickle.dumps(thing)),
]  # fmt: skip
VALUES = np.arange(6.0).reshape(2, 3)


@pytest.mark.parametrize("way", WAYS)
def test_an_image_is_the_same_and_frozen(way: Callable[[Any], Any]) -> None:
    image = Image(VALUES.copy(), (1.3, 1.2), (-0.1, 0.2), "volt", VALUES > 1.0)
    again = way(image)
    assert (again.values == image.values).all()
    assert (again.valid == image.valid).all()
    assert (again.pitch_cm, again.origin_cm, again.quantity) == ((1.3, 1.2), (-0.1, 0.2), "volt")
    assert not again.values.flags.writeable
    assert not again.valid.flags.writeable
    with pytest.raises(AttributeError, match="frozen"):
        again.quantity = "gram"


@pytest.mark.parametrize("way", WAYS)
def test_a_mask_is_the_same_and_frozen(way: Callable[[Any], Any]) -> None:
    mask = Mask(VALUES > 2.0, (1.3, 1.3))
    again = way(mask)
    assert (again.values == mask.values).all()
    assert (again.count, again.pitch_cm) == (3, (1.3, 1.3))
    assert not again.values.flags.writeable


@pytest.mark.parametrize("way", WAYS)
def test_points_are_the_same_and_frozen(way: Callable[[Any], Any]) -> None:
    again = way(Points(np.array([[1.0, 2.0], [3.0, 4.0]])))
    assert again.xy_cm.tolist() == [[1.0, 2.0], [3.0, 4.0]]
    assert not again.xy_cm.flags.writeable


@pytest.mark.parametrize("way", WAYS)
def test_a_frame_keeps_its_truth_and_time(way: Callable[[Any], Any]) -> None:
    frame = Frame(Image(VALUES.copy()), 7, 0.5, (TrueObject(Circle(1.0, 2.0, 3.0), 500.0),))
    again = way(frame)
    assert (again.index, again.time_s, again.truth) == (7, 0.5, frame.truth)
    assert (again.image.values == VALUES).all()


@pytest.mark.parametrize("way", WAYS)
def test_a_pipeline_answers_as_before(way: Callable[[Any], Any]) -> None:
    pipeline = load("circle-3").with_settings({"footprint.level_v": 0.02})
    pipeline = pipeline.with_source("simulate", scene="disc-1", frames=3)
    again = way(pipeline)
    assert again.key == pipeline.key
    assert (again.name, again.file) == (pipeline.name, pipeline.file)
    rows = [[r.row() for r in p.stream()] for p in (pipeline, again)]
    assert rows[0] == rows[1]


def test_a_pipeline_of_a_file_that_is_gone_is_pickled_by_its_text(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(Path(load("circle-1").file).read_text())
    pickled = pickle.dumps(load(file))
    file.unlink()
    assert pickle.loads(pickled).key == load("circle-1").key


INNER = (
    "pipeline: inner\nnodes: {m: {step: threshold, in: frame, with: {level: %s}}}\noutputs: [m]\n"
)
OUTER = """pipeline: outer
evolves: before.yaml
nodes:
  n: {use: folder/inner.yaml}
  lower: {use: folder/inner.yaml, with: {m.level: 1.5}}
  each: {use: folder/inner.yaml, in: parts.contacts, each: true}
  parts: {step: split_contacts, in: [frame, n]}
outputs: [n, lower, each]
"""


@pytest.mark.parametrize("change", ["edited", "gone", "elsewhere", "another"])
def test_a_pipeline_stays_what_it_is_whatever_becomes_of_the_files_it_uses(
    change: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home, elsewhere = tmp_path / "home", tmp_path / "elsewhere"
    for folder, level in ((home, 3.5), (elsewhere, 0.5)):
        (folder / "folder").mkdir(parents=True)
        (folder / "folder" / "inner.yaml").write_text(INNER % level)
    (home / "before.yaml").write_text(INNER % 1.0)
    (home / "outer.yaml").write_text(OUTER)
    monkeypatch.chdir(home)
    pipeline = load("outer.yaml")
    pickled = pickle.dumps(pipeline)
    if change == "edited":
        (home / "folder" / "inner.yaml").write_text(INNER % 0.5)
    elif change == "gone":
        for file in (home / "folder" / "inner.yaml", home / "before.yaml", home / "outer.yaml"):
            file.unlink()
    else:
        monkeypatch.chdir(elsewhere if change == "another" else tmp_path)
    again = pickle.loads(pickled)
    for same in (
        pipeline.with_settings({}),
        pipeline.with_source("simulate", scene="disc-1"),
        again,
        again.with_settings({"lower/m.level": 1.5}),
        pickle.loads(pickle.dumps(again)),
    ):
        assert (same.key, same.evolves) == (pipeline.key, "before.yaml")
    assert again.with_settings({"n/m.level": 4.5}).run(VALUES)["n"].count == 1


def test_a_pipeline_with_a_registry_of_its_own_says_why_not() -> None:
    own = loads("pipeline: p\nnodes: {a: {step: constant}}\noutputs: [a]\n", registry=registry())
    with pytest.raises(UsageError, match="registry of its own"):
        pickle.dumps(own)
    assert copy.copy(own) is own


@pytest.mark.parametrize("way", WAYS)
def test_a_runner_whose_steps_keep_state_is_not_copied(way: Callable[[Any], Any]) -> None:
    with pytest.raises(UsageError, match=r"a runner is not to be copied .* runner\(\) makes a new"):
        way(load("tracks").runner())


class TwoWordsError(Exception):
    """Does not come back from a pickle: its one argument is not what it takes."""

    def __init__(self, one: str, two: str) -> None:
        super().__init__(f"{one} {two}")


class TwoWordsDegenerate(TwoWordsError, Degenerate):  # noqa: N818
    """The same, but expected."""


@pytest.mark.parametrize("way", WAYS)
def test_results_are_as_before_whatever_was_skipped_or_failed(way: Callable[[Any], Any]) -> None:
    pipeline = load("circle-1").with_source("simulate", scene="discs", frames=4)
    frames = [*pipeline.frames(), Frame.of(np.zeros((16, 16)), 1.3, quantity="volt")]
    whole = [r for b in pipeline.blocks(frames) for r in (b if isinstance(b, Block) else [b])]
    for result in [*pipeline.stream(frames), *whole]:
        again = way(result)
        assert again.row() == result.row()
        assert [(e.state, e.reason) for e in again.explain()] == [
            (e.state, e.reason) for e in result.explain()
        ]
    assert "skipped" in {e.state for e in whole[-1].explain()}


@pytest.mark.parametrize("way", WAYS)
def test_a_failure_keeps_its_words_though_its_error_is_not_to_be_pickled(
    way: Callable[[Any], Any],
) -> None:
    own = TwoWordsError("too", "dark"), TwoWordsDegenerate("too", "few")
    for error in (*own, Degenerate("no points")):
        failed = Failed("a", error, "a.py:3", "an image", "step 'a'", (2,))
        again = way(failed)
        assert (again.reason, again.kind, repr(again)) == (
            failed.reason, failed.kind, repr(failed),
        )  # fmt: skip
        assert (again.where, again.inputs, again.item) == ("a.py:3", "an image", (2,))
        assert way(again).reason == failed.reason
