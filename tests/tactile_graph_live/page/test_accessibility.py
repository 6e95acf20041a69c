"""The page by its accessibility tree: what a screen reader finds, in which order, and hears."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import Double, frame, graph, pulse, served, wait_for

pytestmark = pytest.mark.slow  # a browser starts

CONTROLS = {"button", "checkbox", "combobox", "slider", "spinbutton", "textbox", "option", "link"}
ORDER = """() => [...document.querySelectorAll("main a, main button, main input, main select, main [tabindex]")]
    .filter((e) => e.checkVisibility() && !e.disabled && e.tabIndex >= 0)
    .map((e) => { const box = e.closest(".card")?.getBoundingClientRect() ?? e.getBoundingClientRect();
                  return [Math.round(box.left), Math.round(box.top), e.closest(".card")?.id ?? ""]; })"""
HEAR = """() => {
    window.heard = [];
    const live = "[aria-live=polite], [aria-live=assertive], [role=status], [role=alert], [role=log], output:not([aria-live])";
    for (const region of document.querySelectorAll(live)) {
        new MutationObserver(() => heard.push(region.id || region.textContent))
            .observe(region, { childList: true, characterData: true, subtree: true });
    }
}"""
CANVASES = "() => [...document.querySelectorAll('canvas[role=img]')].filter((e) => e.checkVisibility()).map((e) => e.getAttribute('aria-label'))"


CONTRAST = """() => {
    const paint = (text) => {
        const canvas = document.createElement("canvas").getContext("2d");
        canvas.fillStyle = text;
        canvas.fillRect(0, 0, 1, 1);
        return [...canvas.getImageData(0, 0, 1, 1).data];
    };
    const bright = (rgb) => {
        const [r, g, b] = rgb.map((c) => (c /= 255) <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const behind = (e) => {
        for (; e; e = e.parentElement) {
            const found = paint(getComputedStyle(e).backgroundColor);
            if (found[3] === 255) return found;
        }
        return paint(getComputedStyle(document.documentElement).backgroundColor);
    };
    const faint = (e) => Boolean(e.closest(":disabled, .gone, .unseen, .skip")) || (() => {
        for (; e; e = e.parentElement) if (Number(getComputedStyle(e).opacity) < 1) return true;
    })();
    const found = [];
    const take = (e, style, text) => {
        const [one, two] = [bright(paint(style.color).slice(0, 3)), bright(behind(e).slice(0, 3))];
        const ratio = (Math.max(one, two) + 0.05) / (Math.min(one, two) + 0.05);
        const large = parseFloat(style.fontSize) >= 24;
        found.push([Number(ratio.toFixed(2)), large ? 3 : 4.5, text]);
    };
    for (const e of document.querySelectorAll("body *")) {
        if (!e.checkVisibility() || faint(e)) continue;
        const own = [...e.childNodes].filter((n) => n.nodeType === 3).map((n) => n.nodeValue.trim()).join(" ").trim();
        if (own) take(e, getComputedStyle(e), `${e.tagName} ${e.className}: ${own.slice(0, 40)}`);
        for (const pseudo of ["::before", "::after"]) {
            const style = getComputedStyle(e, pseudo);
            if (/^"[^"]*\\w/.test(style.content)) take(e, style, `${e.tagName} ${e.className}${pseudo}: ${style.content}`);
        }
    }
    return found;
}"""


def tree(page: Any) -> list[dict[str, Any]]:
    """Return the nodes of the accessibility tree: role, name, and whether it takes the focus."""
    session = page.context.new_cdp_session(page)
    nodes = session.send("Accessibility.getFullAXTree")["nodes"]
    session.detach()
    told = []
    for node in nodes:
        if node.get("ignored"):
            continue
        properties = {p["name"]: p["value"].get("value") for p in node.get("properties", [])}
        told.append(
            {"role": node["role"]["value"], "name": node.get("name", {}).get("value", "").strip(),
             **properties}
        )  # fmt: skip
    return told


def test_whatever_takes_the_focus_has_a_role_and_a_name(page: Any) -> None:
    page.locator("#nodes [data-name=footprint]").click()
    page.locator("#setting-groups summary").first.wait_for()
    found = tree(page)
    takes = [n for n in found if n.get("focusable") and n["role"] != "RootWebArea"]
    assert len(takes) > 30
    assert [n for n in takes if not n["name"] or n["role"] in ("generic", "none")] == []
    controls = [n for n in found if n["role"] in CONTROLS]
    assert len({n["role"] for n in controls}) >= 7
    assert [n for n in controls if not n["name"]] == []


def test_the_help_is_a_dialog_with_a_name_and_the_rest_is_out_of_reach(page: Any) -> None:
    page.keyboard.press("?")
    found = tree(page)
    assert [n["name"] for n in found if n["role"] == "dialog"] == ["Keys"]
    assert not any(n["role"] == "slider" for n in found)


def test_pictures_and_charts_are_told_in_words(page: Any, double: Double) -> None:
    double.say(pulse(lost=3), frame(1))
    wait_for(lambda: any("answered 500" in t for t in page.evaluate(CANVASES)), "charts are told")
    told = page.evaluate(CANVASES)
    assert all(told)
    (latency,) = [t for t in told if t.startswith("Latency")]
    assert latency.startswith("Latency over the last minute: 99 % of results 1.90 ms to 1.90 ms")
    (rate,) = [t for t in told if t.startswith("Frames a second")]
    assert "answered 500 to 500, lost 0 to " in rate


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_stands_out_from_what_is_behind_it(window: Any, double: Double, scheme: str) -> None:
    """As WCAG has it for level AA: 4.5 to 1, and 3 to 1 for large letters."""
    page = window(color_scheme=scheme).page
    page.goto(double.address)
    page.wait_for_selector("#result-rows tr")
    message = graph(2)
    message["yaml"] = message["yaml"].replace("0.02", "0.03") + "# more\n"
    message["nodes"][0]["settings"][0]["changed"] = True
    message["nodes"][1]["apart"] = {"process": "hull", "time_limit_s": None}
    fares = {"restarts": 1, "starting": True, "why": "took long"}
    errors = [{"line": 3, "column": 9, "text": "must be > 0"}]
    fates = {"footprint": ("skipped", "touched is false"), "boundary": ("failed", "too little"),
             "circle": ("skipped", "deadline")}  # fmt: skip
    nodes = {n: {"outcome": o, "reason": r, "us": 1.0} for n, (o, r) in fates.items()}
    double.say(
        message, pulse(lost=3, missed=2, processes={"boundary": fares}),
        {"type": "trouble", "version": 2, "errors": errors},
        *({"type": "told", "level": level, "text": "told"} for level in ("note", "warning", "error")),
        frame(1, version=2, nodes=nodes),
    )  # fmt: skip
    page.locator("#yaml li.added").first.wait_for()
    page.locator(".apart.starting").wait_for()
    page.locator("#nodes [data-name=circle]").click()
    page.wait_for_timeout(500)  # what appears is there
    found = page.evaluate(CONTRAST)
    assert len(found) > 80
    assert [one for one in found if one[0] < one[1]] == []


@pytest.mark.parametrize("width", [1440, 1000, 390])
def test_the_focus_goes_down_each_column_in_turn(window: Any, double: Double, width: int) -> None:
    page = window(viewport={"width": width, "height": 800}).page
    page.goto(double.address)
    page.wait_for_selector("#result-rows tr")
    stops = [tuple(stop) for stop in page.evaluate(ORDER) if stop[2]]
    assert len({card for _, _, card in stops}) == 5
    # Cards that stand side by side in one row (the last ones, at middle widths) go left to right.
    ranks = [(left, top) for left, top, _ in stops]
    seen = list(dict.fromkeys(ranks))
    assert len(seen) == len({card for _, _, card in stops}), "a card is left and entered again"
    if width != 1000:
        assert seen == sorted(seen)


def test_frames_that_go_on_are_not_announced(page: Any, double: Double) -> None:
    page.keyboard.press("?")
    page.get_by_label("Tell results to screen readers").uncheck()
    page.keyboard.press("Escape")
    page.evaluate(HEAR)
    for index in range(1, 60):
        double.say(frame(index), pulse(frames=index, rate_hz=30.0 + index % 3))
        page.wait_for_timeout(20)
    assert page.evaluate("heard") == []


def test_dragging_through_time_is_told_by_the_slider_alone(page: Any, double: Double) -> None:
    page.evaluate(HEAR)
    time = page.get_by_label("Time", exact=True)
    for back in (1, 2, 3):
        time.fill(f"-{back}")
        double.say(frame(back, back_s=float(back)))
    assert time.get_attribute("aria-valuetext") == "3.00 s ago"
    assert [h for h in page.evaluate("heard") if h != "speech"] == []


def test_a_loss_is_announced_once_however_long_it_lasts(window: Any) -> None:
    page = window().page
    with served(Double()) as double:
        page.goto(double.address)
        page.wait_for_selector("#result-rows tr")
        page.evaluate(HEAR)
    page.wait_for_selector("#lost:visible")
    page.wait_for_timeout(2500)
    assert [h for h in page.evaluate("heard") if h != "speech"] == []
    assert page.get_by_role("alert").inner_text() == "Connection lost."


def test_what_began_anew_is_seen_and_said(page: Any, double: Double) -> None:
    assert page.locator("#change").is_hidden()
    double.say(graph(2, anew=["circle"], took_ms=41.0), frame(1, version=2))
    change = page.locator("#change")
    change.wait_for()
    told = "The last change ran after 41.0 ms. What circle kept of earlier frames began anew."
    assert change.inner_text() == told
    assert page.locator("#speech").inner_text() == told
    page.locator("#nodes [data-name=circle]").click()
    assert "Keeps a state from frame to frame." in page.locator("#node-about").inner_text()
    double.say(graph(3))
    wait_for(lambda: change.inner_text().count(". ") == 0, "nothing is lost any more")


def test_many_errors_leave_the_pad_in_sight(page: Any, double: Double) -> None:
    errors = [
        {"line": n, "column": 3, "text": f"node 'n{n}': " + "wrong " * 40} for n in range(1, 51)
    ]
    rows = [{"output": "circle", "item": n, "outcome": "ok", "x_cm": 1.0, "y_cm": 2.0,
             "centre_error_cm": 0.1 * n, "radius_error_cm": 0.2} for n in range(1, 60)]  # fmt: skip
    double.say({"type": "trouble", "version": 2, "errors": errors}, frame(1, rows=rows))
    page.locator("#trouble li").nth(49).wait_for(state="attached")
    page.locator("#contact-rows tr").nth(49).wait_for(state="attached")
    assert page.locator("#pad").bounding_box()["y"] < 600
    assert "50 errors" in page.locator("#trouble-title").inner_text()
    assert "59, the first 50 shown" in page.locator("#contacts-count").inner_text()
    assert page.evaluate("document.documentElement.scrollWidth") == 1440
    assert page.locator("#trouble-list").evaluate("e => e.scrollHeight > e.clientHeight")
