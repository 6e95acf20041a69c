"""Hostile names and messages: they stay text, load nothing, run nothing, and break nothing."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import Double, drawn, frame, graph, hello, pulse, served, setting, wait_for

pytestmark = pytest.mark.slow  # a browser starts

HOSTILE = (
    '<img src=x onerror="alert(1)">',
    "</script><script>alert(2)</script>",
    '"><svg onload=alert(3)>',
    "javascript:alert(4)",
    "${alert(5)}",
    "__proto__",
    "constructor",
    "\u202egnihton\u202c",
    "' ] [data-x=\"",
    "a" * 5000,
)


def hostile_messages() -> list[dict[str, Any]]:
    names = HOSTILE
    told = graph(1, names, name=HOSTILE[0], about=HOSTILE[1], yaml="\n".join(HOSTILE))
    told["nodes"][0]["settings"] += [
        setting(HOSTILE[0], "choice", HOSTILE[1], choices=list(HOSTILE), help=HOSTILE[2], unit=HOSTILE[0]),
        setting(HOSTILE[2], "text", HOSTILE[1], help=HOSTILE[0]),
    ]  # fmt: skip
    told["columns"] = [{"key": n, "name": n, "unit": n} for n in HOSTILE]
    words = [
        {"shape": "text", "role": "found", "node": n, "x": 2.0, "y": 2.0, "text": n}
        for n in HOSTILE
    ]
    notes = [{"shape": "note", "node": names[0], "name": n, "value": n} for n in HOSTILE]
    rows = [
        {"output": n, "item": 1, "outcome": n, "type": n} | {m: m for m in HOSTILE} for n in HOSTILE
    ]
    rows += [{"output": HOSTILE[0], "item": i, "outcome": "ok", "x_cm": 1.0, HOSTILE[3]: HOSTILE[0]}
             for i in (2, 3)]  # fmt: skip
    nodes = {n: {"outcome": n, "reason": n, "us": 1.0} for n in names}
    pad = frame(1)["pad"] | {"quantity": HOSTILE[0], "unit": HOSTILE[1]}
    recording = {"on": True, "file": HOSTILE[0], "frames": 1, "label": HOSTILE[1], "lost": 0}
    return [
        hello(pipeline=HOSTILE[0], about=HOSTILE[1], source=HOSTILE[2], file=HOSTILE[0]),
        told,
        pulse(recording=recording, beside={"variant": HOSTILE[0], "frames": 1, "passed": 0, "same_outcomes": 1, "trouble": HOSTILE[1],
                     "differences": {HOSTILE[2]: {"mean": 1.0, "most": 1.0}}, "median_us": None, "beside_median_us": None}),
        frame(1, names, nodes=nodes, rows=rows, drawing=words, label=HOSTILE[1], pad=pad,
              pictures=dict.fromkeys(names, notes)),
        {"type": "trouble", "version": 2,
         "errors": [{"line": 1, "column": 1, "text": n} for n in HOSTILE]},
        {"type": "told", "text": HOSTILE[0], "level": HOSTILE[1]},
    ]  # fmt: skip


def test_hostile_names_stay_text(window: Any) -> None:
    with served(Double(*hostile_messages())) as double:
        opened = window()
        page = opened.page
        page.goto(double.address)
        page.wait_for_selector("#nodes [role=option]:nth-child(2)")
        for option in page.locator("#nodes [role=option]").all():
            option.click()
            page.wait_for_timeout(60)
            double.say(hostile_messages()[3])
        page.wait_for_timeout(400)
        assert (
            page.locator(
                "main img, main script, main iframe, main [onerror], main [onload]"
            ).count()
            == 0
        )
        assert page.locator("script").count() == 1
        shown = page.locator("#nodes").text_content()
        assert all(name in shown for name in HOSTILE)
        assert HOSTILE[1] in page.locator("#trouble").text_content()
        assert HOSTILE[0] in page.locator("h1").text_content()
        assert opened.complaints() == []
        assert all(asked.startswith(double.address) for asked in opened.asked_for)
        assert (
            page.evaluate("""[...document.querySelectorAll("body *")].filter((e) =>
            !e.closest(".scroll") && e.getBoundingClientRect().right > 1440).map((e) => e.parentElement.outerHTML.slice(0, 90))
        """)
            == []
        )  # not even a name without end hangs over
        assert page.evaluate("({}).us") is None  # nothing went into the prototype of all things


def test_texts_without_end_leave_the_pad_in_sight(window: Any) -> None:
    long = "a text without end " * 600
    with served(Double(hello(pipeline=long, about=long), graph(1, name=long, about=long),
                       frame(1, label=long))) as double:  # fmt: skip
        opened = window(viewport={"width": 390, "height": 844})
        page = opened.page
        page.goto(double.address)
        page.wait_for_selector("#result-rows tr")
        drawn(page, "frame 1")
        assert page.locator("#pad-canvas").bounding_box()["y"] < 700
        double.say({"type": "told", "text": long, "level": "error"})
        page.locator(".say.error").wait_for()
        assert page.locator("#told").bounding_box()["height"] < 844 / 2
        assert long.strip() in page.locator("#about").text_content()
        assert opened.complaints() == []


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", "null", "3", '"frame"', '{"type": "nothing"}', '{"type": "constructor"}', "{}"],
)
def test_what_is_no_message_changes_nothing(window: Any, text: str) -> None:
    with served(Double()) as double:
        opened = window()
        opened.page.goto(double.address)
        opened.page.wait_for_selector("#result-rows tr")
        double.say(text, frame(77))
        drawn(opened.page, "frame 77")
        assert opened.complaints() == []


def test_shapes_far_off_and_without_sense_do_no_harm(window: Any) -> None:
    shapes = [
        {"shape": "circle", "role": "found", "node": "", "x": 1e300, "y": -1e300, "radius": 1e300},
        {"shape": "polygon", "role": "true", "node": "", "xy": []},
        {
            "shape": "polygon",
            "role": "found",
            "node": "",
            "xy": [[1e9, 1], [2, -1e12]],
            "fill": True,
        },
        {"shape": "of-no-kind", "role": "found", "node": ""},
        {"shape": "toString", "role": "found", "node": ""},
    ]
    pad = frame(1)["pad"] | {"values": "", "low": 0.0, "high": 0.0}
    with served(Double()) as double:
        opened = window()
        opened.page.goto(double.address)
        opened.page.wait_for_selector("#result-rows tr")
        double.say(frame(1, drawing=shapes, pad=pad), frame(2))
        drawn(opened.page, "frame 2")
        assert opened.complaints() == []


def test_the_policy_keeps_out_what_were_smuggled_in(window: Any) -> None:
    """The check of complaints sees them where there are any."""
    with served(Double()) as double:
        opened = window()
        opened.page.goto(double.address)
        opened.page.wait_for_selector("#result-rows tr")
        opened.page.evaluate("""() => {
            const script = document.createElement("script");
            script.textContent = "window.ran = true";
            const image = document.createElement("img");
            image.src = "http://example.invalid/x.png";
            document.body.append(script, image);
        }""")
        refused = lambda: sum("policy: " in c for c in opened.complaints())  # noqa: E731
        wait_for(lambda: refused() >= 2, "both are refused")
        assert opened.page.evaluate("window.ran") is None
        assert refused() == 2
