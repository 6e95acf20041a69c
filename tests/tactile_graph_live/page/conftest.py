"""A browser for the tests of the page, and what it complains of."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from helpers_browser import BROWSER, OPTIONS

COMPLAINTS = """
    window.complaints = [];
    addEventListener("securitypolicyviolation",
        (e) => complaints.push(`policy: ${e.violatedDirective} ${e.blockedURI}`));
    addEventListener("error", (e) => complaints.push(`error: ${e.message}`));
    addEventListener("unhandledrejection", (e) => complaints.push(`rejected: ${e.reason}`));
"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """The system's Chromium; of each module its own, as an event loop runs as long as it does."""
    playwright = pytest.importorskip("playwright.sync_api", reason="no playwright")
    pytest.importorskip("uvicorn", reason="the extra `live` is not there")
    if BROWSER is None:
        pytest.skip("no Chromium on the PATH")
    with playwright.sync_playwright() as started:
        chromium = started.chromium.launch(executable_path=BROWSER, args=OPTIONS)
        yield chromium
        chromium.close()


class Window:
    """A page in a window of its own, and all that the browser complained of."""

    def __init__(self, browser: Any, **options: Any) -> None:
        self.context = browser.new_context(**{"viewport": {"width": 1440, "height": 900}} | options)
        self.context.add_init_script(COMPLAINTS)
        self.page = self.context.new_page()
        self.printed: list[str] = []
        self.asked_for: list[str] = []
        self.page.on("console", lambda m: self.printed.append(f"{m.type}: {m.text}"))
        self.page.on("pageerror", lambda e: self.printed.append(f"error: {e}"))
        self.page.on("request", lambda r: self.asked_for.append(r.url))
        self.page.on("dialog", lambda d: self.printed.append(f"dialog: {d.message}"))

    def complaints(self) -> list[str]:
        """Return what the browser printed and what the page broke."""
        return [*self.printed, *self.page.evaluate("window.complaints ?? []")]

    def leave(self) -> None:
        """Go where there is nothing, and forget what was heard; the page forgets too."""
        self.page.evaluate("try { localStorage.clear(); sessionStorage.clear() } catch {}")
        self.page.goto("about:blank")
        self.printed.clear()
        self.asked_for.clear()


@pytest.fixture(scope="module")
def kept(browser: Any) -> Iterator[list[Window]]:
    """The windows that tests of a module use in turn: to open one takes longer than its page."""
    windows: list[Window] = []
    yield windows
    for one in windows:
        one.context.close()


@pytest.fixture
def window(browser: Any, kept: list[Window]) -> Iterator[Any]:
    """Makes windows; all are left in the end.

    One without options may have shown pages of other tests, which leave nothing stored. What stays
    with a window is for one of its own: ``own``.
    """
    made: list[Window] = []
    free = [*kept]

    def make(*, own: bool = False, **options: Any) -> Window:
        if own or options:
            made.append(Window(browser, **options))
            return made[-1]
        if not free:
            kept.append(Window(browser))
            return kept[-1]
        return free.pop()

    yield make
    for one in made:
        one.context.close()
    for one in kept:
        one.leave()


@pytest.fixture(scope="module")
def server() -> Iterator[Any]:
    """A server that tests of a module use in turn: to start and end it takes half of their time."""
    from helpers_live_page import Double, served

    with served(Double()) as double:
        yield double


@pytest.fixture
def double(server: Any) -> Any:
    """A server that says what the test has it say."""
    server.renew()
    return server


@pytest.fixture
def page(window: Any, double: Any) -> Iterator[Any]:
    """The page of that server with a graph and a result in it; it may complain of nothing."""
    opened = window()
    opened.page.goto(double.address)
    opened.page.wait_for_selector("#nodes [role=option]")
    opened.page.wait_for_selector("#result-rows tr")
    yield opened.page
    assert opened.complaints() == []
    opened.leave()  # the next test waits until it has gone
