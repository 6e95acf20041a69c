"""A comparison and an audit by workers: all but the times is what one process finds."""

from __future__ import annotations

import json
from itertools import islice
from typing import Any

import pytest

from helpers_many import place
from tactile_graph import Frame, load
from tactile_graph.many import Sharing
from tactile_graph.plugins.registry import installed
from tactile_graph_compare.output.export import as_json
from tactile_graph_compare.run.audit import Audit, Auditor, AuditWorker
from tactile_graph_compare.run.frame_choice import FrameChooser
from tactile_graph_compare.run.session import Session
from tactile_graph_compare.run.shared import N_BEFORE, Given, SessionWorker
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
