"""The page by keyboard alone: documented keys, nothing out of reach, focus in sight, no traps."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import Double, frame

pytestmark = pytest.mark.slow  # a browser starts

WHO = """() => {
    const e = document.activeElement;
    return e === document.body ? "" : e.id || e.dataset.name || e.getAttribute("aria-label")
        || e.textContent.trim() || e.tagName;
}"""


def walked(page: Any, key: str = "Tab") -> list[str]:
    """Return what has the focus as it goes round once."""
    seen: list[str] = []
    for _ in range(150):
        page.keyboard.press(key)
        who = page.evaluate(WHO)
        if seen and who in ("", seen[0]):
            return seen
        seen.append(who)
    raise AssertionError(f"the focus does not come round: {seen}")


def test_tab_reaches_every_control_and_comes_round_both_ways(page: Any) -> None:
    there = walked(page)
    wanted = ["theme", "keys", "smooth", "numbers", "pad-canvas", "pause", "step", "live", "tare",
              "time", "label", "record", "save-name", "save", "frame", "footprint, level v",
              "footprint, factor"]  # fmt: skip
    assert [w for w in wanted if w not in there] == []
    assert len(walked(page, "Shift+Tab")) == len(there)
    within = page.locator("button:visible:enabled, input:visible:enabled, select:visible").count()
    assert len(there) >= within


def test_what_has_the_focus_is_seen(page: Any) -> None:
    for _ in range(60):
        page.keyboard.press("Tab")
        look = page.evaluate("""() => {
            const e = document.activeElement, style = getComputedStyle(e), box = e.getBoundingClientRect();
            return [e.id || e.tagName, style.outlineStyle, parseFloat(style.outlineWidth),
                    box.bottom > 0 && box.top < innerHeight];
        }""")
        if look[0] == "BODY":
            break
        assert look[1] != "none", look
        assert look[2] >= 2, look
        assert look[3], look


@pytest.mark.parametrize(
    ("key", "asked"),
    [(" ", "pause"), (".", "step"), ("l", "live"), ("t", "tare"), ("r", "record"), (",", "scrub")],
)
def test_keys_of_one_letter(page: Any, double: Double, key: str, asked: str) -> None:
    page.keyboard.press(key if key != " " else "Space")
    double.heard(asked)


def test_keys_are_letters_where_one_types_and_can_be_switched_off(
    page: Any, double: Double
) -> None:
    page.get_by_label("Label").focus()
    page.keyboard.type("tlr .")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("?")
    page.get_by_label("Keys of one letter do something").uncheck()
    page.keyboard.press("Escape")
    page.keyboard.press("t")
    page.wait_for_timeout(200)
    assert {a["type"] for a in double.asked} == {"show"}
    assert page.get_by_label("Label").input_value() == "tlr ."


def test_space_on_a_button_presses_that_button_only(page: Any, double: Double) -> None:
    page.get_by_role("button", name="Tare").focus()
    page.keyboard.press("Space")
    double.heard("tare")
    page.wait_for_timeout(100)
    assert not any(a["type"] == "pause" for a in double.asked)


def test_help_opens_keeps_the_focus_and_gives_it_back(page: Any) -> None:
    page.get_by_role("button", name="Keys").focus()
    page.keyboard.press("Enter")
    assert page.locator("#help").is_visible()
    documented = page.locator("#help kbd").all_inner_texts()
    assert {"Space", ".", ",", "L", "T", "R", "G", "P", "Esc", "D", "?"} <= set(documented)
    page.keyboard.press("Escape")
    assert page.locator("#help").is_hidden()
    assert page.evaluate(WHO) == "keys"


def test_the_graph_by_arrows_and_a_node_large(page: Any, double: Double) -> None:
    page.keyboard.press("g")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    assert page.evaluate(WHO) == "boundary"
    page.keyboard.press("End")
    page.keyboard.press("ArrowDown")
    assert page.evaluate(WHO) == "circle"
    page.keyboard.press("Home")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    assert page.locator("#node-title").inner_text() == "footprint"
    assert page.evaluate(WHO) == "node"
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    assert page.evaluate(WHO) == "footprint, level v"
    page.keyboard.press("ArrowRight")
    assert double.heard("set")["value"] == 0.021
    page.keyboard.press("Escape")
    assert page.locator("#node").is_hidden()
    assert page.evaluate(WHO) == "footprint"


def test_arrows_read_out_the_cells_of_the_pad(page: Any, double: Double) -> None:
    double.say(frame(0))
    page.keyboard.press("p")
    page.keyboard.press("ArrowDown")
    assert page.locator("#readout").inner_text().startswith("Row 4, column 5: ")
    page.keyboard.press("ArrowRight")
    told = page.locator("#readout").inner_text()
    assert told.startswith("Row 4, column 6: ")
    assert " V, at 8.5, 5.9 cm" in told
    assert page.locator("#pad-canvas").get_attribute("aria-valuetext") == told


def test_a_link_skips_to_the_graph(page: Any) -> None:
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert page.evaluate(WHO) == "graph"
