"""What the page says that nobody asked for: what is assumed, what is wrong."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import Double, pulse

pytestmark = pytest.mark.slow  # a browser starts


def test_what_the_source_assumes_is_told(page: Any, double: Double) -> None:
    told = page.locator("#source-text")
    assert not told.is_visible()
    double.say(pulse(counters={
        "recordings whose pitch is assumed to be 1 cm": 81, "frames": 16091, "troubles": 2,
        "recordings with frames assumed to lie along the first axis": 81,
        "damaged records skipped": 3, "sums that differ from the vendor's": 0,
    }))  # fmt: skip
    told.wait_for()
    assert told.inner_text() == (
        "recordings whose pitch is assumed to be 1 cm; "
        "recordings with frames assumed to lie along the first axis; "
        "3 damaged records skipped"
    )


def test_whoever_has_scrolled_down_sees_what_is_wrong(window: Any, double: Double) -> None:
    page = window(viewport={"width": 390, "height": 800}).page
    page.goto(double.address)
    page.wait_for_selector("#result-rows tr")
    page.evaluate("scrollTo(0, 900)")
    double.say(pulse(trouble="a port: stalled"))
    silent = page.locator("#silent")
    silent.wait_for()
    assert 0 <= silent.bounding_box()["y"] < 400
