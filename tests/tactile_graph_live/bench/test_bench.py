"""What a bench says of a source from which no frame comes."""

from __future__ import annotations

import pickle
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import tactile_graph as tg
from tactile_graph import Frame, Image
from tactile_graph.steps import Report
from tactile_graph_live.bench import bench as module
from tactile_graph_live.bench.bench import Bench
from tactile_graph_live.bench.outbox import Outbox
from tactile_graph_live.bench.playing import Pace, Player
from tactile_graph_live.bench.wire import End, Order, Summary

PIPELINE = """\
pipeline: bare
source: {step: sample, with: {name: discs}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
outputs: [footprint]
"""


def test_what_a_recording_says_is_not_why_a_frame_that_waits_here_does_not_come(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    told, go_on = threading.Event(), threading.Event()
    players: list[Player] = []

    def player(pipeline: tg.Pipeline, seed: int, report: Report, **_: Any) -> Player:
        def frames(round_: int) -> Iterator[Frame]:
            yield Frame(Image(np.zeros((2, 2)), quantity="volt"), 0)
            report.trouble("a.csv: frame 1", "its time goes back")
            yield Frame(Image(np.zeros((2, 2)), quantity="volt"), 1)
            report.trouble("a port", "stalled")
            told.set()
            go_on.wait(30)

        players.append(Player(frames, pace=Pace(1e6), once=True))
        return players[-1]

    monkeypatch.setattr(module, "player", player)
    monkeypatch.setattr(module, "SILENT_S", 0.0)
    monkeypatch.setattr(module, "SUMMARY_NS", 0)
    sent: list[Any] = []
    bench = Bench(Order(pickle.dumps(tg.loads(PIPELINE)), held=True), Outbox(sent.append))

    def trouble() -> str:
        del sent[:]
        end = time.monotonic() + 30
        while time.monotonic() < end:
            bench.tick()
            time.sleep(0.01)
            for one in [*sent]:
                if isinstance(one, Summary) and one.state == "waiting":
                    return one.trouble
        raise AssertionError(f"nothing was told but {sent}")

    thread = threading.Thread(target=bench.run)
    thread.start()
    try:
        players[0].one_more()
        while not bench._trouble:
            time.sleep(0.01)
        time.sleep(0.1)
        assert trouble() == ""  # the frame is there, and held
        players[0].one_more()
        assert told.wait(30)
        assert trouble() == "a port: stalled"
    finally:
        bench.told(End())
        go_on.set()
        thread.join(30)
