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


@pytest.fixture
def window(browser: Any) -> Iterator[Any]:
    """Makes windows; all are closed in the end."""
    made: list[Window] = []

    def make(**options: Any) -> Window:
        made.append(Window(browser, **options))
        return made[-1]

    yield make
    for one in made:
        one.context.close()


@pytest.fixture
def double() -> Iterator[Any]:
    """A server that says what the test has it say."""
    from helpers_live_page import Double, served

    with served(Double()) as double:
        yield double


@pytest.fixture
def page(window: Any, double: Any) -> Iterator[Any]:
    """The page of that server with a graph and a result in it; it may complain of nothing."""
    opened = window()
    opened.page.goto(double.address)
    opened.page.wait_for_selector("#nodes [role=option]")
    opened.page.wait_for_selector("#result-rows tr")
    yield opened.page
    assert opened.complaints() == []
