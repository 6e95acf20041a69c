"""The connection: lost, told, tried again at longer and longer intervals, there again."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import Double, drawn, frame, free_port, graph, pulse, served, wait_for

pytestmark = pytest.mark.slow  # a browser starts

NETWORK = ("WebSocket connection to", "net::ERR_CONNECTION_REFUSED", "403 (Forbidden)")


def test_it_says_that_the_server_is_gone_and_comes_back_with_it(window: Any) -> None:
    port = free_port()
    opened = window()
    page = opened.page
    with served(Double(), port) as first:
        page.goto(first.address)
        page.wait_for_selector("#result-rows tr")
        page.locator("#nodes [data-name=circle]").click()
    page.wait_for_selector("#lost:visible")
    assert "Connection lost." in page.locator("#lost").inner_text()
    assert page.locator("#link-text").inner_text() in ("connection lost", "connecting")
    page.keyboard.press("t")
    assert "There is no connection" in page.locator("#told").inner_text()
    told = page.locator("#lost-text")
    wait_for(lambda: "tries so far" in told.inner_text(), "it tries again and again", 20)
    with served(Double(), port) as second:
        page.locator("#link:is([data-state=connected], [data-state=running])").wait_for(
            timeout=20_000
        )
        assert page.locator("#lost").is_hidden()
        assert second.heard("show")["nodes"] == ["boundary", "circle", "footprint", "frame"]
        second.say(frame(500), graph(2, ("footprint", "circle")))
        drawn(page, "frame 500")
        assert page.locator("#node-title").inner_text() == "circle"
        page.keyboard.press("t")
        second.heard("tare")
    assert [c for c in opened.complaints() if not any(n in c for n in NETWORK)] == []


def test_a_server_with_another_token_is_told_from_one_that_is_gone(window: Any) -> None:
    port = free_port()
    opened = window(own=True)
    page = opened.page
    with served(Double(), port, "first") as first:
        page.goto(first.address)
        page.wait_for_selector("#result-rows tr")
    page.wait_for_selector("#lost:visible")
    told = page.locator("#lost-text")
    with served(Double(), port, "second") as second:
        wait_for(lambda: "The server refuses this page." in told.inner_text(), "it says why", 20)
        assert "the token is missing or wrong; open the address that" in told.inner_text()
        opened.context.new_page().goto(second.address)
        page.locator("#lost").wait_for(state="hidden", timeout=20_000)
    wait_for(lambda: "What you see" in told.inner_text(), "it is lost again", 20)
    assert "refuses" not in told.inner_text()
    assert [c for c in opened.complaints() if not any(n in c for n in NETWORK)] == []


def test_trying_now_needs_no_wait(window: Any) -> None:
    port = free_port()
    page = window().page
    with served(Double(), port) as first:
        page.goto(first.address)
        page.wait_for_selector("#result-rows tr")
    page.wait_for_selector("#lost:visible")
    page.wait_for_timeout(5000)  # by now it waits for seconds
    with served(Double(), port):
        page.get_by_role("button", name="Try now").click()
        page.locator("#link:is([data-state=connected], [data-state=running])").wait_for(
            timeout=4000
        )


def test_tries_come_at_longer_and_longer_intervals(window: Any) -> None:
    page = window(own=True).page
    with served(Double()) as double:
        page.add_init_script("""
            window.tries = [];
            const Real = WebSocket;
            window.WebSocket = class extends Real {
                constructor(...all) { super(...all); tries.push(performance.now()); }
            };
        """)
        page.goto(double.address)
        page.wait_for_selector("#result-rows tr")
    page.wait_for_timeout(9000)
    tries = page.evaluate("tries")
    gaps = [b - a for a, b in pairwise(tries[1:])]
    assert 3 <= len(gaps) <= 6
    assert gaps[-1] > 2 * gaps[0]


def test_a_server_that_hangs_is_given_up(window: Any) -> None:
    with served(Double(hangs=True)) as double:
        page = window().page
        page.goto(double.address)
        page.wait_for_selector("#result-rows tr")
        double.heard("show")
        double.heard("show", 10)  # of another connection: there was no word for six seconds
        page.locator("#link:is([data-state=connected], [data-state=running])").wait_for()


def test_a_slow_page_draws_the_newest_frame_only(window: Any) -> None:
    with served(Double()) as double:
        page = window().page
        page.goto(double.address)
        page.wait_for_selector("#result-rows tr")
        page.evaluate("""() => {
            window.seen = [];
            new MutationObserver(() => seen.push(document.getElementById("when").textContent))
                .observe(document.getElementById("when"), { childList: true, characterData: true, subtree: true });
            setTimeout(() => { const end = performance.now() + 400; while (performance.now() < end); }, 0);
        }""")
        double.say(*(frame(i) for i in range(1, 200)), pulse())
        wait_for(lambda: 199 in double.answered, "the newest is answered")
        # An answer goes out before the words change: nothing may have been seen by now.
        wait_for(
            lambda: page.evaluate("seen.at(-1) ?? ''").startswith("frame 199"), "the newest is told"
        )
        seen = page.evaluate("seen")
        assert len(seen) < 100
        assert len(double.answered) == 200  # what was never drawn is answered too
