"""What is said of processes that were started anew."""

from __future__ import annotations

import pytest

from tactile_graph.live import ProcessState
from tactile_graph_live.server import restarts as module
from tactile_graph_live.server.restarts import QUIET_S, Restarts

CRASHED = "ended its process by SIGKILL"


@pytest.fixture
def now(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    found = [1000.0]
    monkeypatch.setattr(module.time, "perf_counter", lambda: found[0])
    return found


def own(n_restarts: int) -> dict[str, ProcessState]:
    return {"risky": ProcessState("", n_restarts, n_restarts > 0, CRASHED if n_restarts else "")}


def test_a_process_that_never_ended_is_not_spoken_of(now: list[float]) -> None:
    assert list(Restarts().news(own(0))) == []


def test_one_is_spoken_of_at_once_and_then_now_and_then(now: list[float]) -> None:
    restarts = Restarts()
    told = f"node 'risky' {CRASHED}: its process is started anew"
    assert list(restarts.news(own(1))) == [told]
    now[0] += 1.0
    assert list(restarts.news(own(1))) == list(restarts.news(own(2))) == []
    now[0] += QUIET_S
    assert list(restarts.news(own(23))) == [f"{told}, for the 23rd time"]
    assert list(restarts.news(own(23))) == []


def test_one_that_several_nodes_share_is_spoken_of_once_and_by_its_name(now: list[float]) -> None:
    why = "took longer than its 0.5 s at node 'hull'"
    state = ProcessState("hull", 1, True, why)
    told = list(Restarts().news({"boundary": state, "hull": state}))
    assert told == [f"a step {why}: the process of hull is started anew"]


def test_after_a_change_of_the_file_counting_begins_anew(now: list[float]) -> None:
    restarts = Restarts()
    assert list(restarts.news(own(12)))
    now[0] += 2 * QUIET_S
    assert list(restarts.news(own(0))) == []
    assert list(restarts.news(own(1)))
    now[0] += 2 * QUIET_S
    assert list(restarts.news({})) == []
    assert list(restarts.news(own(1)))


@pytest.mark.parametrize(("n", "word"), [(2, "2nd"), (3, "3rd"), (11, "11th"), (21, "21st")])
def test_how_often_stands_there_in_words(now: list[float], n: int, word: str) -> None:
    (told,) = Restarts().news(own(n))
    assert told.endswith(f"for the {word} time")
