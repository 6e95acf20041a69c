"""Every control of the page asks the server for what it says."""

from __future__ import annotations

import re
from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import Double, frame, graph, hello, pulse, served, setting, wait_for

pytestmark = pytest.mark.slow  # a browser starts

RECORDING = {"on": True, "file": "/recordings/one.zarr", "frames": 1234, "label": "cup", "lost": 0}


def test_it_asks_for_the_pictures_in_sight(page: Any, double: Double) -> None:
    assert double.heard("show")["nodes"] == ["boundary", "circle", "footprint", "frame"]


def test_pause_and_run(page: Any, double: Double) -> None:
    page.get_by_role("button", name="Pause").click()
    double.heard("pause")
    double.say(pulse(paused=True))
    page.get_by_role("button", name="Run", exact=True).click()
    double.heard("resume")
    assert page.locator("#live").get_attribute("aria-pressed") == "false"


def test_step_live_and_tare(page: Any, double: Double) -> None:
    page.get_by_role("button", name="Step").click()
    double.heard("step")
    page.get_by_role("button", name="Live").click()
    double.heard("live")
    page.get_by_role("button", name="Tare").click()
    double.heard("tare")
    double.say(pulse(tared=True))
    page.locator("#tare[aria-pressed=true]").click()
    double.heard("untare")


def test_recording_takes_the_label_and_tells_the_file(page: Any, double: Double) -> None:
    page.get_by_label("Label").fill(" cup ")
    page.get_by_role("button", name="Record").click()
    asked = double.heard("record")
    assert (asked["on"], asked["label"]) == (True, "cup")
    double.say(pulse(recording=RECORDING))
    page.get_by_role("button", name="Stop").click()
    assert double.heard("record")["on"] is False
    assert "1\u202f234 frames into /recordings/one.zarr" in page.locator("#recording").inner_text()


def test_the_time_bar_scrubs_and_follows(page: Any, double: Double) -> None:
    bar = page.get_by_label("Time", exact=True)
    bar.fill("-12.5")
    assert double.heard("scrub")["back_s"] == 12.5
    assert page.locator("#time-text").inner_text() == "12.5 s ago"
    page.wait_for_timeout(500)
    double.say(frame(3, back_s=7.25))
    wait_for(lambda: page.locator("#time-text").inner_text() == "7.25 s ago", "the bar follows")
    assert bar.input_value() == "-7.26" or bar.input_value() == "-7.24"


def test_live_wins_over_a_scrub_not_sent_yet(page: Any, double: Double) -> None:
    page.evaluate("""() => {
        const bar = document.getElementById("time");
        bar.value = "-5";
        bar.dispatchEvent(new Event("input"));
        document.getElementById("live").click();
    }""")
    double.heard("live")
    page.wait_for_timeout(150)
    assert not any(a["type"] == "scrub" for a in double.asked)


@pytest.mark.parametrize(
    ("control", "value", "asked"),
    [
        ("footprint, level v", "0.05", 0.05),
        ("footprint, factor", "5", 5),
    ],
)
def test_a_slider_sets(page: Any, double: Double, control: str, value: str, asked: float) -> None:
    page.locator("#settings").get_by_role("slider", name=control).fill(value)
    found = double.heard("set")
    name = control.removeprefix("footprint, ").replace(" ", "_")
    assert (found["node"], found["setting"], found["value"]) == ("footprint", name, asked)


def test_other_settings_set(page: Any, double: Double) -> None:
    settings = page.locator("#settings")
    box = settings.get_by_label("level V", exact=True)
    box.fill("0.07")
    box.press("Enter")
    assert double.heard("set")["value"] == 0.07
    settings.get_by_label("above", exact=True).check()
    assert double.heard("set")["value"] is True
    settings.get_by_label("element", exact=True).select_option("square3")
    assert double.heard("set")["value"] == "square3"
    settings.get_by_label("noise of", exact=True).fill("idle.npz")
    settings.get_by_label("noise of", exact=True).press("Tab")
    assert double.heard("set")["value"] == "idle.npz"


def test_whole_numbers_are_shown_whole_and_infinite_ones_not_at_all(
    page: Any, double: Double
) -> None:
    told = graph(2)
    level, factor = told["nodes"][0]["settings"][:2]
    factor["value"], level["value"] = 12_345_678, 10**400
    double.say(told)
    box = page.locator("#settings").get_by_label("factor", exact=True)
    wait_for(lambda: box.input_value() == "12345678", "it is shown as it is")
    assert page.locator("#settings").get_by_label("level V", exact=True).input_value() == ""


def test_what_is_no_number_is_not_sent(page: Any, double: Double) -> None:
    box = page.locator("#settings").get_by_label("level V", exact=True)
    box.fill("")
    box.press("Enter")
    page.wait_for_timeout(200)
    assert not any(a["type"] == "set" for a in double.asked)
    assert box.input_value() == "0.02"  # what runs


def changed_graph() -> dict[str, Any]:
    told = graph(2, yaml="pipeline: rings\nnodes:\n  footprint: {level_v: 0.05}\n")
    told["nodes"][0]["settings"][0] = setting("level_v", "number", 0.05, low=0.0, slider_low=0.0,
                                              slider_high=0.1, unit="V", changed=True)  # fmt: skip
    return told


def test_what_was_set_is_marked_in_the_yaml_and_can_be_reset(page: Any, double: Double) -> None:
    double.say(changed_graph())
    page.wait_for_selector("#yaml li.changed")
    lines = page.locator("#yaml li").all()
    assert [line.get_attribute("class") or "" for line in lines] == ["", "", "changed"]
    assert page.locator("#settings-sum").inner_text() == "1 changed"
    page.locator("#settings").get_by_label("Reset footprint, level_v").click()
    assert double.heard("unset") == {"type": "unset", "node": "footprint", "setting": "level_v"}
    page.get_by_role("button", name="Reset all").click()
    assert double.heard("unset") == {"type": "unset", "node": "", "setting": ""}


def test_saving_needs_a_name(page: Any, double: Double) -> None:
    name = page.get_by_label("Save as")
    assert name.input_value() == "rings-live"
    name.fill("  ")
    page.get_by_role("button", name="Save", exact=True).click()
    name.fill("mine")
    name.press("Enter")
    assert double.heard("save")["name"] == "mine"


def test_a_refused_setting_goes_back(page: Any, double: Double) -> None:
    box = page.locator("#settings").get_by_label("level V", exact=True)
    box.fill("-1")
    box.press("Enter")
    double.heard("set")
    double.say({"type": "told", "text": "level_v: must be > 0, got -1", "level": "error"})
    page.wait_for_selector(".say.error")
    assert box.input_value() == "0.02"
    page.get_by_role("button", name="Put away").click()
    assert page.locator(".say").count() == 0


HELD = """(slider) => {
    slider.value = "0.09";
    window.held = setInterval(() => slider.dispatchEvent(new Event("input", { bubbles: true })), 50);
}"""


def test_dragging_is_not_fought_by_answers(page: Any, double: Double) -> None:
    slider = page.locator("#settings").get_by_role("slider", name="footprint, level v")
    slider.evaluate(HELD)
    double.heard("set")
    double.say(changed_graph())
    page.wait_for_selector("#yaml li.changed")
    assert slider.input_value() == "0.09"
    page.evaluate("clearInterval(held)")
    wait_for(lambda: slider.input_value() == "0.05", "what runs is shown once the hand is off")


def test_a_node_is_shown_large_with_its_settings(page: Any, double: Double) -> None:
    page.locator("#nodes [data-name=footprint]").click()
    card = page.locator("#node")
    assert card.get_by_role("heading").inner_text() == "footprint"
    assert "What footprint does." in card.inner_text()
    card.get_by_role("slider", name="footprint, factor").fill("3")
    assert double.heard("set")["setting"] == "factor"
    card.get_by_role("button", name="Close the node").click()
    assert card.is_hidden()


def test_outcomes_are_words_and_shapes(page: Any, double: Double) -> None:
    nodes = {"footprint": {"outcome": "ran", "reason": "", "us": 9.0},
             "boundary": {"outcome": "skipped", "reason": "deadline", "us": None},
             "circle": {"outcome": "failed", "reason": "all points lie in a line", "us": 5.0}}  # fmt: skip
    page.wait_for_timeout(300)
    double.say(frame(1, nodes=nodes, rows=[]))
    page.wait_for_selector("#nodes [data-name=circle] .badge[data-fate=failed]")
    words = {n: page.locator(f"#nodes [data-name={n}] .badge").inner_text() for n in nodes}
    assert words == {"footprint": "ran", "boundary": "no time", "circle": "failed"}
    drawn = page.locator("#nodes .badge path").evaluate_all(
        "all => all.map(p => p.getAttribute('d'))"
    )
    assert len(set(drawn)) == 3
    circle = page.locator("#nodes [data-name=circle]")
    wait_for(lambda: "all points lie in a line" in circle.inner_text(), "the reason is written")


def test_numbers_stand_with_their_units(page: Any, double: Double) -> None:
    page.wait_for_timeout(300)
    double.say(frame(0))
    rows = page.locator("#result-rows tr").all_inner_texts()
    assert ["\t".join(r.split()) for r in rows][:4] == [
        "circle\tCircle", "x\t6\tcm", "y\t7\tcm", "radius\t2\tcm",
    ]  # fmt: skip


def test_a_unit_that_is_the_pads_goes_with_its_frames(page: Any, double: Double) -> None:
    peak = {"key": "peak", "name": "peak", "unit": "", "units": {"volt": "V", "kilopascal": "kPa"}}
    row = {"output": "circle", "item": 1, "outcome": "ok", "type": "Load", "peak": 9.0}
    double.say(graph(2, columns=[peak]))
    rows = page.locator("#result-rows tr").nth(1)
    for index, quantity, unit in ((1, "kilopascal", "kPa"), (2, "volt", "V")):
        pad = frame(index)["pad"] | {"quantity": quantity, "unit": unit}
        double.say(frame(index, rows=[row], pad=pad))
        wait_for(lambda u=unit: rows.inner_text().split() == ["peak", "9", u], f"it is in {unit}")


def test_several_things_have_a_table(page: Any, double: Double) -> None:
    rows = [{"output": "circle", "item": i, "outcome": "ok", "type": "Circle", "x_cm": 1.5 * i,
             "y_cm": 2.0} for i in (1, 2, 3)]  # fmt: skip
    page.wait_for_timeout(300)
    double.say(frame(1, rows=rows))
    page.wait_for_selector("#contact-rows tr:nth-child(3)")
    heads = page.locator("#contact-head th").all_inner_texts()
    assert heads == ["no.", "x cm", "y cm"]
    assert page.locator("#contact-rows tr").nth(1).inner_text().split() == ["2", "3", "2"]


def test_the_status_line(page: Any, double: Double) -> None:
    double.say(pulse(lost=3, shed=14))
    page.wait_for_selector("#lost-stat.alarm")
    told = " ".join(page.locator("#status").inner_text().split())
    assert "500 a second" in told
    assert "Lost ! 3" in told or "Lost 3" in told
    assert "800 µs median · 1.90 ms 99 %" in told


def test_why_nothing_comes_stands_there_as_long_as_it_lasts(page: Any, double: Double) -> None:
    double.say(pulse(state="ended", trouble="./tty: stalled: nothing came for 2 s"))
    page.locator("#silent").wait_for()
    assert page.locator("#silent").inner_text() == (
        "No frames come. ./tty: stalled: nothing came for 2 s"
    )
    assert page.locator("#link").inner_text().strip() == "the source ended"
    double.say(pulse(trouble=""))
    page.locator("#silent").wait_for(state="hidden")


def test_what_runs_beside_is_told(page: Any, double: Double) -> None:
    beside = {"variant": "circle-3", "frames": 200, "passed": 40, "same_outcomes": 199,
              "differences": {"radius_cm": {"mean": 0.1, "most": 0.75}}, "median_us": 29.0,
              "beside_median_us": 140.0, "kept": [7], "trouble": ""}  # fmt: skip
    double.say(pulse(beside=beside, missed=7))
    page.locator("#beside-stat").wait_for()
    assert page.locator("#beside-stat").inner_text().split("\n")[-1] == (
        "200 frames, 40 passed by; as here in 99.5 %; 140 µs for 29 µs here; "
        "radius_cm 0.1000 apart, 0.7500 at most"
    )
    assert page.locator("#missed").inner_text() == "7"


def test_nodes_that_run_apart_are_marked_and_how_their_process_fares(
    page: Any, double: Double
) -> None:
    message = graph(2, ("footprint", "boundary", "each_one", "circle"))
    message["nodes"][1]["apart"] = {"process": "hull", "time_limit_s": None}
    message["nodes"][3]["apart"] = {"process": "", "time_limit_s": 0.5}
    within = {**message["nodes"][1], "name": "each_one/hull"}
    double.say({**message, "nodes": [*message["nodes"], within]})
    marks = page.locator("#nodes .apart:visible")
    wait_for(lambda: marks.count() == 3, "three nodes are marked")
    row = page.get_by_role("option", name=re.compile("boundary_step apart: Runs in a process sha"))
    shared = row.locator(".apart")
    assert shared.get_attribute("title") == "Runs in a process shared as hull."
    other = page.locator("#nodes [data-name=each_one] .apart")
    assert other.get_attribute("title") == "hull runs in a process shared as hull."
    fares = {"restarts": 2, "starting": True, "why": "took longer than its 0.5 s"}
    double.say(pulse(processes={"circle": fares}))
    own = page.locator("#nodes [data-name=circle] .apart")
    own.and_(page.locator(".starting")).wait_for()
    assert own.locator("[aria-hidden]").inner_text() == "restarting"
    told = (
        "Runs in a process of its own, ended there after 0.5 s. It is being started anew. "
        "Started anew 2 times; the last took longer than its 0.5 s."
    )
    assert own.get_attribute("title") == told
    assert shared.get_attribute("title") == "Runs in a process shared as hull."
    page.locator("#nodes [data-name=circle]").click()
    assert page.locator("#node-apart").inner_text() == told
    double.say(pulse(processes={"circle": {**fares, "starting": False}}))
    wait_for(lambda: "apart, restarted 2×: " in own.inner_text(), "it is there again")
    assert "It is being" not in page.locator("#node-apart").inner_text()
    page.locator("#nodes [data-name=footprint]").click()
    assert page.locator("#node-apart").inner_text() == ""
    double.say(graph(3))
    wait_for(lambda: marks.count() == 0, "none is marked any more")


def test_a_wrong_file_says_where_and_that_the_old_graph_runs(page: Any, double: Double) -> None:
    errors = [{"line": 3, "column": 9, "text": "level_v: must be > 0, got -1"},
              {"line": 0, "column": 0, "text": "no outputs"}]  # fmt: skip
    double.say({"type": "trouble", "version": 2, "errors": errors})
    banner = page.locator("#trouble")
    banner.wait_for()
    told = banner.inner_text()
    assert "The file as saved has 2 errors. The old graph still runs." in told
    assert "Line 3, column 9: level_v: must be > 0, got -1" in told
    double.say({"type": "trouble", "version": 3, "errors": []})
    banner.wait_for(state="hidden")


def test_another_graph_keeps_the_focus(page: Any, double: Double) -> None:
    box = page.locator("#settings").get_by_label("level V", exact=True)
    box.focus()
    double.say(changed_graph())
    page.wait_for_selector("#yaml li.changed")
    assert box.evaluate("e => e === document.activeElement")


def test_nodes_come_and_go_with_the_graph(page: Any, double: Double) -> None:
    double.say(graph(2, ("footprint", "hull")))
    page.wait_for_selector("#nodes [data-name=hull]")
    names = page.locator("#nodes [role=option] b").all_inner_texts()
    assert names == ["frame", "footprint", "hull"]


def test_a_server_of_another_version_says_so(window: Any) -> None:
    with served(Double(hello(protocol=99))) as double:
        opened = window()
        opened.page.goto(double.address)
        opened.page.wait_for_selector(".say.error")
        assert "Load the page again" in opened.page.locator(".say").inner_text()


def test_each_drawn_frame_is_answered(page: Any, double: Double) -> None:
    double.say(*(frame(i) for i in range(1, 11)))
    wait_for(lambda: 10 in double.answered, "the newest frame is answered")
    assert sorted(double.answered) == list(range(11))
