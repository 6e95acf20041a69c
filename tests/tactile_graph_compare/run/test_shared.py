"""A comparison and an audit by workers: all but the times is what one process finds."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_many import place
from tactile_graph import Frame, load
from tactile_graph.inspect import as_data
from tactile_graph.many import Feed, Reading, Sharing
from tactile_graph.many.division import division_of
from tactile_graph.many.feed import ranges_of
from tactile_graph.plugins.registry import installed
from tactile_graph.steps.injected import Report
from tactile_graph_compare.output.export import as_json
from tactile_graph_compare.records.frames import NodeStory
from tactile_graph_compare.run.audit import Audit, Auditor, AuditWorker
from tactile_graph_compare.run.chosen_frames import chosen_frames
from tactile_graph_compare.run.frame_choice import FrameChooser
from tactile_graph_compare.run.session import Session
from tactile_graph_compare.run.shared import N_BEFORE, Given, SessionWorker
from tactile_graph_compare.run.stories import as_sent
from tactile_graph_compare.run.summarise import summarise
from tactile_graph_compare.variants.prepare import prepare
from tactile_graph_compare.variants.request import VariantRequest

TIMES = ("_us", "seconds", "total_s", "alone_s", "merged_s", "share", "ratio", "time", "pareto")


def without_times(data: Any) -> Any:
    """Return plain data without what hangs on the clock."""
    if isinstance(data, dict):
        kept = {k: v for k, v in data.items() if not any(word in k for word in TIMES)}
        return {k: without_times(v) for k, v in kept.items()}
    return [without_times(v) for v in data] if isinstance(data, list) else data


def frames(n: int) -> list[Frame]:
    """Return frames of which every third is the one before again."""
    source = load("circle-1").with_source("simulate", scene="discs", frames=n)
    found = list(islice(source.frames(0), n))
    for k in range(2, n, 3):
        found[k] = Frame(found[k - 1].image, k, truth=found[k - 1].truth)
    return found


def session() -> Session:
    pipelines = [load(name) for name in ("circle-1", "circle-3")]
    return Session(prepare([VariantRequest(p) for p in pipelines], installed()))


@pytest.mark.slow
@pytest.mark.parametrize("deadly", [set(), {37}])
def test_a_comparison_by_workers_finds_what_one_process_does(deadly: set[int]) -> None:
    given = frames(150)
    one, joined = session(), session()
    for k, frame in enumerate(given):
        if k not in deadly:
            one.add(frame)
    what = Given(joined.prepared, joined.seed, joined.reference)
    with Sharing(place(deadly, chance=[60]), SessionWorker, what) as workers:
        for part, error in workers.over_frames(iter(given), N_BEFORE):
            assert error is None
            joined.join(part)
        assert workers.left_out == sorted(deadly)
    told = [without_times(json.loads(as_json(summarise(s)))) for s in (one, joined)]
    if deadly:  # frames that are shown at even distances hang on where others were left out
        told = [{k: v for k, v in t.items() if k != "chosen"} for t in told]
    assert told[0] == told[1]
    assert one.merged_log.frames().reused.sum() == 50 - bool(deadly & {38, 37})


@pytest.mark.slow
def test_an_audit_by_workers_finds_what_one_process_does() -> None:
    given = frames(120)
    auditors = [Auditor(load("circle-3"), sample=0.7, seed=3) for _ in range(2)]
    one, joined = auditors
    for frame in given:
        one.add(frame)
    with Sharing(place(), AuditWorker, joined.for_workers()) as workers:
        for part in workers.over_frames((f for f in given if joined.drawn()), N_BEFORE):
            joined.join(part)

    def told(audit: Audit) -> list[Any]:
        rows = [without_times(vars(g) | {"differences": None}) for g in audit.guards]
        return [audit.n_frames, audit.n_seen, rows, [g.differences for g in audit.guards]]

    assert told(one.summarise()) == told(joined.summarise())


# -- steps that keep state ---------------------------------------------------------------------


def recordings(folder: Path) -> list[Path]:
    """Write two recordings of objects that pass."""
    paths = [folder / "a.npz", folder / "b.npz"]
    for seed, path in enumerate(paths):
        source = load("contacts").with_source("simulate", scene="passing", frames=20)
        given = [*source.frames(seed)]
        grid = {k: getattr(given[0].image, k) for k in ("pitch_cm", "origin_cm", "quantity")}
        np.savez(path, values=np.stack([f.image.values for f in given]), **grid)
    return paths


def tracking(paths: list[Path]) -> Session:
    pipelines = [load(name).with_source("recording", path=paths) for name in ("tracks", "contacts")]
    return Session(prepare([VariantRequest(p) for p in pipelines], installed()))


@pytest.mark.slow
def test_frames_shown_of_recordings_are_as_they_were_behind_those_before(tmp_path: Path) -> None:
    paths = recordings(tmp_path)
    one, joined = tracking(paths), tracking(paths)
    pipeline = one.prepared[0].pipeline
    for k, frame in enumerate(one.warmed(iter(pipeline.frames(0)))):
        if k == 20:
            one.without_state()
        one.add(frame)
    ranges = ranges_of(pipeline.source)
    division = division_of(one.plan, ranges)
    assert division.by_recording
    assert pipeline.source is not None
    reading = Reading.of(pipeline.source, division)
    feed = Feed(pipeline, 0, Report(), (0, None), division, ranges)
    given = Given(joined.prepared, joined.seed, joined.reference, reading)
    with Sharing(place(), SessionWorker, given) as workers:
        for part, error in workers.over_feed(feed):
            assert error is None
            joined.join(pickle.loads(pickle.dumps(part)))
    shown = [
        [
            (c.position, label, name, s.state, s.reason, as_data(s.value))
            for c in chosen_frames(s_)
            for label, of in c.stories.items()
            for name, s in of.items()
        ]
        for s_ in (one, joined)
    ]
    assert shown[0] == shown[1]
    assert len({row[0] for row in shown[0]}) >= 4
    told = [summarise(s) for s in (one, joined)]
    assert without_times(json.loads(as_json(told[0]))) == without_times(
        json.loads(as_json(told[1]))
    )


def test_a_value_that_cannot_be_sent_is_left_out() -> None:
    story = NodeStory("a", "a", "ran", "", "", 1.0, lambda: 0)
    kept = replace(story, value=2.0)
    sent = as_sent({"v": {"a": story, "b": kept}})["v"]
    assert (sent["a"].value, sent["a"].state) == (None, "ran")
    assert sent["b"] is kept


class Fake:
    """Stands for a result."""

    def __init__(self, position: int) -> None:
        self.position, self.frame, self.reused = position, position, False


@pytest.mark.parametrize("n", [7, 40, 333])
def test_frames_chosen_in_portions_are_those_chosen_at_once(n: int) -> None:
    errors = [((k * 7919) % 101) / 100.0 for k in range(n)]

    def chosen(portions: list[range]) -> list[Any]:
        whole = FrameChooser(n_regular=3, most=9)
        for portion in portions:
            part = whole.anew()
            for k in portion:
                worst = {"a": {"radius": errors[k]}, "b": {"radius": errors[-k]}}
                part.add(k, Fake(k), worst)  # type: ignore[arg-type]
            whole.join(part.as_sent())
        return [(p, held.frame, repr(why)) for p, held, why in whole.chosen()]

    parted = [range(low, min(low + 16, n)) for low in range(0, n, 16)]
    assert chosen(parted) == chosen([range(n)])
