"""How the page looks: by day and night, on a phone, without motion, and to a screen reader."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import Double, frame, graph, hello, pulse, served, wait_for

pytestmark = pytest.mark.slow  # a browser starts

FAILED = {"outcome": "failed", "reason": "all points lie in a line", "us": 5.0}
SKIPPED = {"outcome": "skipped", "reason": "touched does not hold", "us": None}


def opened(window: Any, double: Double, **options: Any) -> Any:
    page = window(**options)
    page.page.goto(double.address)
    page.page.wait_for_selector("#result-rows tr")
    return page


def ground(page: Any) -> str:
    return str(page.evaluate("getComputedStyle(document.body).backgroundColor"))


def test_the_switch_goes_round_and_is_remembered(window: Any, double: Double) -> None:
    page = opened(window, double, color_scheme="dark").page
    dark = ground(page)
    page.get_by_role("button", name="Theme: system").click()
    light = ground(page)
    assert light != dark
    page.reload()
    page.wait_for_selector("#result-rows tr")
    assert ground(page) == light
    page.get_by_role("button", name="Theme: light").click()
    assert ground(page) == dark
    page.get_by_role("button", name="Theme: dark").click()
    page.emulate_media(color_scheme="light")
    assert ground(page) == light


def test_canvases_take_on_the_colours(window: Any, double: Double) -> None:
    page = opened(window, double, color_scheme="light").page
    axis = """() => {
        const c = document.getElementById("pad-canvas");
        const data = c.getContext("2d").getImageData(0, c.height - 20, c.width, 20).data;
        let sum = 0, n = 0;
        for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200) { sum += data[i]; n += 1; }
        return n ? sum / n : null;
    }"""
    by_day = page.evaluate(axis)
    page.emulate_media(color_scheme="dark")
    wait_for(lambda: page.evaluate(axis) > by_day + 40, "the axis is drawn for the night")


def test_a_phone_shows_one_column_and_nothing_hangs_over(window: Any, double: Double) -> None:
    page = opened(window, double, viewport={"width": 360, "height": 740}, has_touch=True).page
    long = "an-output-with-a-name-that-goes-on-and-on-and-on-and-on"
    double.say(graph(2, ("footprint", "boundary", long), name=long * 3, yaml="x: " + "y" * 300),
               frame(1, ("footprint", "boundary", long)))  # fmt: skip
    page.wait_for_selector(f"#nodes [data-name={long}]")
    page.locator("#nodes [data-name=footprint]").click()
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    boxes = {n: page.locator(f"#{n}").bounding_box()
             for n in ("pad", "graph", "node", "results", "settings", "file")}  # fmt: skip
    tops = [b["y"] for b in boxes.values()]
    assert tops == sorted(tops)
    assert {round(b["x"]) for b in boxes.values()} == {10}
    for control in page.locator(
        "main button:visible, main input:visible:not([type=checkbox])"
    ).all():
        box = control.bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 360
        assert box["height"] >= 36


@pytest.mark.parametrize("width", [780, 781, 1000, 1240, 1920])
def test_no_width_makes_the_page_scroll_sideways(window: Any, double: Double, width: int) -> None:
    page = opened(window, double, viewport={"width": width, "height": 800}).page
    assert page.evaluate("document.documentElement.scrollWidth") == width


def test_long_names_leave_room_for_what_marks_their_nodes(window: Any) -> None:
    long = "a_rather_long_name_of_a_node_that_fits_nowhere"
    message = graph(1, ("footprint", long))
    message["nodes"][1]["apart"] = {"process": "", "time_limit_s": None}
    rows = [{"output": long, "item": 1, "outcome": "ok", "type": "Circle", "x_cm": 1.0}]
    first = frame(0, ("footprint", long), rows=rows)
    with served(Double(hello(), message, pulse(), first)) as double:
        page = opened(window, double, viewport={"width": 390, "height": 800}).page
        row = page.locator(f"#nodes [data-name={long}]")
        for line in (row.locator("b"), row.locator(".line").last):
            assert line.evaluate("e => e.scrollWidth <= e.clientWidth")
        assert row.locator(".apart").evaluate("e => e.scrollWidth <= e.clientWidth + 1")
        table = page.locator("#results .scroll")
        assert table.evaluate("e => e.scrollWidth <= e.clientWidth")


def test_large_letters_still_fit(window: Any, double: Double) -> None:
    page = opened(window, double, viewport={"width": 720, "height": 800}).page
    page.evaluate("document.documentElement.style.fontSize = '200%'")
    page.wait_for_timeout(100)
    assert page.evaluate("document.documentElement.scrollWidth") == 720
    page.set_viewport_size({"width": 412, "height": 800})
    assert page.evaluate("getComputedStyle(document.body).fontSize") == "30px"
    clipped = page.evaluate("""() => [...document.querySelectorAll(".transport button, .stats > div")]
        .filter((e) => e.scrollWidth > e.clientWidth).map((e) => e.textContent)""")
    assert clipped == []


def test_nothing_moves_where_that_is_not_wanted(window: Any, double: Double) -> None:
    recording = {"on": True, "file": "a.zarr", "frames": 1, "label": "", "lost": 0}
    moving = "document.getAnimations().length"
    for motion, some in (("no-preference", True), ("reduce", False)):
        page = opened(window, double, reduced_motion=motion).page
        double.say(pulse(recording=recording))
        page.wait_for_selector("#record[aria-pressed=true]")
        assert (page.evaluate(moving) > 0) is some


def test_landmarks_labels_and_headings(window: Any, double: Double) -> None:
    page = opened(window, double).page
    assert page.get_by_role("banner").count() == page.get_by_role("main").count() == 1
    regions = ["Pad", "Graph", "Settings", "File", "Results", "Latency", "Rate"]
    for name in regions:
        assert page.get_by_role("region", name=name, exact=True).count() == 1, name
    assert page.get_by_role("heading", level=1).inner_text() == "rings"
    unnamed = page.evaluate("""() => [...document.querySelectorAll("button, input, select, canvas[role=img]")]
        .filter((e) => e.checkVisibility() && !(e.labels?.length || e.getAttribute("aria-label")
                       || e.textContent.trim())).map((e) => e.outerHTML)""")
    assert unnamed == []
    assert page.evaluate("document.documentElement.lang") == "en"
    ids = page.evaluate("[...document.querySelectorAll('[id]')].map((e) => e.id)")
    assert len(ids) == len(set(ids))


def test_tables_have_heads(window: Any, double: Double) -> None:
    page = opened(window, double).page
    rows = [{"output": "circle", "item": i, "outcome": "ok", "x_cm": 1.0 * i} for i in (1, 2)]
    assert page.locator("#results table").get_by_role("columnheader").count() == 3
    assert page.locator("#result-rows").get_by_role("rowheader").count() >= 4
    double.say(frame(1, rows=rows))
    page.wait_for_selector("#contact-rows tr")
    heads = page.locator("#contacts table").get_by_role("columnheader")
    wait_for(lambda: heads.count() == 2, "the things have a table")
    assert page.locator("#contact-rows").get_by_role("rowheader").count() == 2
    assert page.locator("table:not(:has(caption))").count() == 0


def test_the_pad_is_told_in_words(window: Any, double: Double) -> None:
    page = opened(window, double).page
    pad = page.locator("#pad-canvas")
    wait_for(lambda: "highest" in pad.get_attribute("aria-label"), "the pad is told in words")
    told = pad.get_attribute("aria-label")
    assert told.startswith("The pad, 8 rows of 10 cells, volt, V; highest 2.")
    assert (
        page.locator("#result-rows .spark")
        .first.get_attribute("aria-label")
        .startswith("x, last ten seconds")
    )


def test_results_are_spoken_at_a_bearable_pace(window: Any, double: Double) -> None:
    page = opened(window, double).page
    page.evaluate("""() => {
        window.spoken = [];
        new MutationObserver(() => spoken.push([performance.now(), document.getElementById("speech").textContent]))
            .observe(document.getElementById("speech"), { childList: true, characterData: true, subtree: true });
    }""")
    index = 0
    while len(spoken := page.evaluate("spoken")) < 3:
        double.say(frame(index := index + 1))
        page.wait_for_timeout(40)
        assert index < 1000
    assert all(b[0] - a[0] > 1900 for a, b in pairwise(spoken))
    assert spoken[0][1].startswith("circle, x ")
    assert page.locator("#speech").get_attribute("aria-live") == "polite"
    page.keyboard.press("?")
    page.get_by_label("Tell results to screen readers").uncheck()
    page.keyboard.press("Escape")
    page.evaluate("spoken.length = 0")
    double.say(frame(150))
    page.wait_for_timeout(2500)
    assert page.evaluate("spoken") == []
