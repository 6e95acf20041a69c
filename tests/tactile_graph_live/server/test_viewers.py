"""Each viewer gets the newest it can take, and holds up nobody."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Coroutine
from typing import Any

import pytest

pytest.importorskip("starlette", reason="the live extra is not installed")

from tactile_graph_live.server import messages
from tactile_graph_live.server.viewers import MOST_TOLD, Picture, Viewer


class Page:
    """What a viewer is sent through: reads when it may."""

    def __init__(self) -> None:
        self.got: list[dict[str, Any]] = []
        self.reads = asyncio.Event()
        self.reads.set()

    async def send_text(self, data: str) -> None:
        await self.reads.wait()
        self.got.append(json.loads(data))


def picture(index: int, arrived_ns: int = 0) -> Picture:
    looks = {"a": [{"shape": "cross"}], 'b"<': [{"shape": "note"}]}
    return Picture(
        messages.Frame(
            index, None, 1, {}, [], {}, looks, [], {}, [], None
        ),
        arrived_ns,
    )  # fmt: skip


def run(play: Callable[[Viewer, Page], Coroutine[Any, Any, None]]) -> Page:
    """Play with a viewer that sends as long as there is something to send."""

    async def played() -> Page:
        page = Page()
        viewer = Viewer(page)
        sending = asyncio.create_task(viewer.sending())
        await play(viewer, page)
        await turns()
        sending.cancel()
        return page

    return asyncio.run(played())


async def turns() -> None:
    for _ in range(20):
        await asyncio.sleep(0)


def indices(page: Page) -> list[int]:
    return [m["index"] for m in page.got if m["type"] == "frame"]


def test_no_more_than_three_pictures_are_on_their_way() -> None:
    async def play(viewer: Viewer, page: Page) -> None:
        for i in range(10):
            viewer.show(picture(i))
            await turns()

    assert indices(run(play)) == [0, 1, 2]


def test_an_answer_lets_the_newest_through_and_no_older_one() -> None:
    async def play(viewer: Viewer, page: Page) -> None:
        for i in range(10):
            viewer.show(picture(i, arrived_ns=100 + i))
            await turns()
        assert viewer.answered(1) == 101
        assert viewer.answered(1) == 0
        assert viewer.answered(77) == 0

    assert indices(run(play)) == [0, 1, 2, 9]


def test_what_is_not_read_does_not_pile_up() -> None:
    async def play(viewer: Viewer, page: Page) -> None:
        page.reads.clear()
        for i in range(1000):
            viewer.show(picture(i))
            viewer.tell("pulse", json.dumps({"type": "pulse", "n": i}))
            viewer.tell("told", json.dumps({"type": "told", "n": i}))
            await asyncio.sleep(0)
        page.reads.set()

    got = run(play).got
    assert [m["n"] for m in got if m["type"] == "pulse"][-1] == 999
    assert len(got) <= MOST_TOLD + 6
    assert [m["n"] for m in got if m["type"] == "told"][-1] == 999


def test_one_that_takes_nothing_is_known_by_how_long() -> None:
    async def play(viewer: Viewer, page: Page) -> None:
        loop = asyncio.get_running_loop()
        assert viewer.stuck_s(loop.time()) == 0.0
        page.reads.clear()
        viewer.tell("pulse", "{}")
        await turns()
        assert viewer.stuck_s(loop.time() + 9.0) == pytest.approx(9.0, abs=1.0)
        page.reads.set()
        await turns()
        viewer.show(picture(0))
        await turns()
        assert viewer.stuck_s(loop.time() + 9.0) == pytest.approx(9.0, abs=1.0)
        viewer.answered(0)
        assert viewer.stuck_s(loop.time() + 9.0) == 0.0

    run(play)


def test_each_viewer_is_sent_the_pictures_it_is_shown() -> None:
    one = picture(3)
    assert json.loads(one.text(()))["pictures"] == {}
    assert json.loads(one.text(("a", "c")))["pictures"] == {"a": [{"shape": "cross"}]}
    both = json.loads(one.text(("a", 'b"<')))
    assert set(both["pictures"]) == {"a", 'b"<'}
    assert both["index"] == 3


def test_a_text_that_looks_like_the_place_of_the_pictures_is_left_alone() -> None:
    tricky = messages.Frame(
        0, None, 1, {"values": '"pictures":{},'}, [], {}, {"a": []}, [], {}, [], None
    )  # fmt: skip
    told = json.loads(Picture(tricky).text(("a",)))
    assert told["pad"]["values"] == '"pictures":{},'
    assert told["pictures"] == {"a": []}
