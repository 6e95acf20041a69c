"""The page and the real server: what is edited, unplugged or killed is seen in the browser."""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live import COUNTS, PIPELINE, Command, Sending, running
from helpers_live_page import drawn, free_port, wait_for
from helpers_serial import KITS, FakePad

pytestmark = pytest.mark.slow  # a browser and a server start

NETWORK = ("WebSocket connection to", "net::ERR_CONNECTION_REFUSED")
WATCH = """() => {
    window.seen = [];
    new MutationObserver(() => seen.push([Date.now() / 1000, document.documentElement.dataset.graph,
                                          document.documentElement.dataset.drawn]))
        .observe(document.documentElement, { attributeFilter: ["data-graph", "data-drawn"] });
}"""
WRONG = (
    "pipeline: mine\nnodes: [",
    PIPELINE.replace("level_v: 0.01", "level_v: high"),
    PIPELINE.replace("step: boundary_scan", "step: boundary_scann"),
    PIPELINE.replace("in: boundary}", "in: boundaryy}"),
    "",
    "\x00",
    PIPELINE.replace("outputs: [circle]", "outputs: [<img src=x onerror=alert(1)>]"),
    PIPELINE + PIPELINE,
)


def save(path: Path, text: str) -> None:
    """Write a file as editors do: whole, in the place of the old one."""
    beside = path.with_suffix(".new")
    beside.write_text(text)
    os.replace(beside, path)


def opened(window: Any, command: Command) -> Any:
    found = window()
    found.page.goto(command.address)
    found.page.wait_for_selector("#result-rows tr", timeout=60_000)
    return found


def count(page: Any) -> int:
    """Return how many frames the page says there were."""
    return int("0" + "".join(filter(str.isdigit, page.locator("#frames").inner_text())))


def standing(page: Any) -> str:
    """Return which frame is shown, once no other follows."""
    shown = ["", page.locator("#when").inner_text()]
    for _ in range(40):
        page.wait_for_timeout(300)
        shown.append(page.locator("#when").inner_text())
        if shown[-1] == shown[-2]:
            return str(shown[-1])
    raise AssertionError(f"frames go on: {shown}")


@pytest.fixture(scope="module")
def shared_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("shared") / "mine.yaml"
    path.write_text(PIPELINE)
    return path


@pytest.fixture(scope="module")
def shared(shared_file: Path) -> Iterator[Command]:
    """A command for tests that leave its file, its settings and its source as they were."""
    with running(shared_file.parent, shared_file.name, "--rate", "40") as command:
        yield command


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "mine.yaml"
    path.write_text(PIPELINE)
    return path


def test_edit_save_see(window: Any, file: Path, record_property: Any) -> None:
    """The new graph is there within 300 ms of saving, and a frame that went through it."""
    with running(file.parent, file.name, "--rate", "40") as command:
        found = opened(window, command)
        page = found.page
        page.evaluate(WATCH)
        graph_s, drawn_s = [], []
        for number in range(2, 9):
            text = PIPELINE.replace("0.01", f"0.0{number}")
            text = (
                text
                if number % 2
                else text.replace("circle:", "ring:").replace("[circle]", "[ring]")
            )
            began = time.time()
            save(file, text)
            wait_for(lambda n=number: page.locator(f"html[data-drawn='{n}']").count() == 1,
                     f"version {number} is drawn", 20)  # fmt: skip
            seen = page.evaluate("seen")
            graph_s.append(next(t for t, graph, _ in seen if graph == str(number)) - began)
            drawn_s.append(next(t for t, _, shown in seen if shown == str(number)) - began)
        names = page.locator("#nodes [role=option] b").all_inner_texts()
        assert names == ["frame", "footprint", "boundary", "ring"]
        record_property("graph_ms", [round(1e3 * s) for s in graph_s])
        record_property("drawn_ms", [round(1e3 * s) for s in drawn_s])
        assert statistics.median(graph_s) < 0.3
        assert found.complaints() == []


def test_two_hundred_wrong_saves_leave_the_old_graph_running(window: Any, file: Path) -> None:
    with running(file.parent, file.name, "--rate", "40") as command:
        found = opened(window, command)
        page = found.page
        before = page.locator("#frames").inner_text()
        for number in range(200):
            save(file, WRONG[number % len(WRONG)] + f"# {number}\n")
            page.wait_for_timeout(30)  # and lets the page go on
        banner = page.locator("#trouble")
        save(file, WRONG[1])
        wait_for(lambda: "level_v" in banner.inner_text(), "the errors are told", 20)
        told = banner.inner_text()
        assert "The old graph still runs." in told
        assert "Line 4, column" in told
        assert page.locator("html[data-graph='1']").count() == 1
        wait_for(lambda: page.locator("#frames").inner_text() != before, "frames go on")
        assert page.locator("#nodes .badge[data-fate=ran]").count() == 4
        save(file, PIPELINE.replace("0.01", "0.02"))
        banner.wait_for(state="hidden", timeout=20_000)
        assert page.locator("html:not([data-graph='1'])").count() == 1
        assert found.complaints() == []


def test_a_slider_changes_what_runs_and_the_yaml_is_saved(
    window: Any, shared: Command, shared_file: Path
) -> None:
    found = opened(window, shared)
    page = found.page
    box = page.locator("#settings").get_by_label("level V", exact=True)
    box.fill("0.05")
    box.press("Enter")
    page.locator("#yaml li.changed").wait_for()
    assert "level_v: 0.05" in page.locator("#yaml li.changed").inner_text()
    box.fill("-3")
    box.press("Enter")
    page.locator(".say.error").wait_for()
    wait_for(lambda: box.input_value() == "0.05", "what was refused goes back")
    page.get_by_label("Save as").fill("better")
    page.get_by_role("button", name="Save", exact=True).click()
    page.locator(".say.note").wait_for()
    assert (shared_file.parent / "better.yaml").read_text() == PIPELINE.replace("0.01", "0.05")
    page.locator("#settings").get_by_label("Reset footprint, level_v").click()
    wait_for(lambda: box.input_value() == "0.01", "the file's value is back")
    assert shared_file.read_text() == PIPELINE
    assert found.complaints() == []


NESTED = """\
pipeline: mine
source: {step: sample, with: {name: discs}}
nodes:
  seen: {step: threshold, in: frame, with: {level_v: 0.01}}
  objects: {step: split_contacts, in: [frame, seen]}
  tracks: {step: track, in: objects.contacts}
  cheap: {use: circle-1}
outputs: [cheap, tracks]
"""


def test_a_setting_within_a_pipeline_that_is_used_and_what_begins_anew(
    window: Any, file: Path
) -> None:
    file.write_text(NESTED)
    with running(file.parent, file.name, "--rate", "40") as command:
        found = opened(window, command)
        page = found.page
        group = page.locator("#setting-groups [data-node='cheap/footprint']")
        if group.get_attribute("open") is None:
            group.locator("summary").click()
        box = group.get_by_label("level V", exact=True)
        box.fill("0.05")
        box.press("Enter")
        page.locator("#yaml li.changed").wait_for()
        told = page.locator("#yaml li.changed").inner_text()
        assert "cheap: {use: circle-1, with: {footprint.level_v: 0.05}}" in told
        change = page.locator("#change")
        change.wait_for()
        assert "anew" not in change.inner_text()
        save(file, NESTED.replace("0.01", "0.02"))
        wait_for(lambda: "What tracks kept" in change.inner_text(), "what began anew is told", 20)
        assert found.complaints() == []


def test_a_step_that_is_ended_again_and_again_is_told_and_the_others_go_on(
    window: Any, file: Path
) -> None:
    limited = PIPELINE.replace("in: boundary}", "in: boundary, time_limit_s: 0.000001}")
    file.write_text(limited.replace("outputs: [circle]", "outputs: [circle, boundary]"))
    with running(file.parent, file.name, "--rate", "20") as command:
        found = opened(window, command)
        page = found.page
        mark = page.locator("#nodes [data-name=circle] .apart")
        wait_for(lambda: "restart" in mark.inner_text(), "it is told at the node", 30)
        page.locator(".say.warning", has_text="node 'circle' took longer than its 1e-06 s: its "
                     "process is started anew").wait_for()  # fmt: skip
        page.locator("#nodes [data-name=boundary] .badge[data-fate=ran]").wait_for()
        assert page.locator("#nodes .apart:visible").count() == 1
        save(file, PIPELINE)
        wait_for(lambda: not mark.is_visible(), "it runs with the others again", 20)
        page.locator("#nodes [data-name=circle] .badge[data-fate=ran]").wait_for()
        assert found.complaints() == []


def test_pause_step_scrub_and_live(window: Any, shared: Command) -> None:
    found = opened(window, shared)
    page = found.page
    wait_for(lambda: count(page) > 60, "there is something to scrub over", 60)
    page.keyboard.press("Space")
    page.locator("#link[data-state=paused]").wait_for()
    still = standing(page)
    number = int(still.split(" · ")[0].removeprefix("frame "))
    page.keyboard.press(".")
    drawn(page, f"frame {number + 1}")
    page.get_by_label("Time", exact=True).fill("-1")
    wait_for(lambda: "s ago" in page.locator("#time-text").inner_text(), "it is scrubbed back")
    wait_for(lambda: page.locator("#when").inner_text() != still, "an older frame is drawn")
    page.keyboard.press("l")
    page.locator("#live[aria-pressed=true]").wait_for()
    wait_for(lambda: page.locator("#time-text").inner_text() == "now", "it is live again")
    assert found.complaints() == []


def test_record_and_tare(window: Any, shared: Command, shared_file: Path) -> None:
    pytest.importorskip("zarr", reason="the extra `zarr` is not there")
    found = opened(window, shared)
    page = found.page
    page.get_by_label("Label").fill("cup")
    page.get_by_role("button", name="Record").click()
    page.locator("#record[aria-pressed=true]").wait_for()
    told = page.locator("#recording")
    wait_for(lambda: "frames into " in told.inner_text(), "the recording is told")
    page.wait_for_timeout(700)
    page.get_by_role("button", name="Stop").click()
    page.locator("#record[aria-pressed=false]").wait_for()
    assert len(list(shared_file.parent.glob("*.zarr"))) == 1
    page.keyboard.press("t")
    page.locator("#tare[aria-pressed=true]").wait_for(timeout=10_000)
    page.keyboard.press("t")
    page.locator("#tare[aria-pressed=false]").wait_for(timeout=10_000)
    assert found.complaints() == []


def test_the_server_is_killed_and_started_again(window: Any, file: Path) -> None:
    port = str(free_port())
    with running(file.parent, file.name, "--rate", "40", port=port) as first:
        found = opened(window, first)
        page = found.page
        first.process.kill()
        page.locator("#lost").wait_for()
        first.process.communicate(timeout=30)
    with running(file.parent, file.name, "--rate", "40", port=port):
        page.locator("#link[data-state=running]").wait_for(timeout=20_000)
        page.locator("#lost").wait_for(state="hidden")
        before = page.locator("#when").inner_text()
        wait_for(lambda: page.locator("#when").inner_text() != before, "frames are drawn", 20)
    assert [c for c in found.complaints() if not any(n in c for n in NETWORK)] == []


def test_unplugged_and_plugged_in_again(window: Any, tmp_path: Path) -> None:
    kit = next(k for k in KITS if k.preset == "fabric-16x16")
    (tmp_path / "mine.yaml").write_text(COUNTS)
    pad = FakePad(tmp_path / "tty")
    sending = Sending(pad, kit)
    options = ("mine.yaml", "--port", str(pad.link), "--preset", kit.preset)
    with sending, running(tmp_path, *options) as command:
        found = window()
        page = found.page
        page.goto(command.address)
        page.locator("#nodes .badge[data-fate=ran]").first.wait_for(timeout=60_000)
        with sending.pad_lock:
            pad.unplug()
            wait_for(lambda: "unplugged" in page.locator("#told").inner_text(), "it is told", 20)
            page.locator("#link[data-state=waiting]").wait_for(timeout=10_000)
            assert page.locator("#link").inner_text().strip() == "waiting for frames"
            pad.plug_in()
        page.locator("#link[data-state=running]").wait_for(timeout=20_000)
        before = page.locator("#when").inner_text()
        wait_for(lambda: page.locator("#when").inner_text() != before, "frames are drawn", 20)
        assert found.complaints() == []


def test_two_windows_see_the_same(window: Any, shared: Command) -> None:
    one, two = opened(window, shared).page, opened(window, shared).page
    wait_for(lambda: one.locator("#viewers").inner_text() == "2", "both are counted")
    box = one.locator("#settings").get_by_label("level V", exact=True)
    box.fill("0.05")
    box.press("Enter")
    other = two.locator("#settings").get_by_label("level V", exact=True)
    wait_for(lambda: other.input_value() == "0.05", "the other shows it")
    two.locator("#settings").get_by_label("Reset footprint, level_v").click()
    wait_for(lambda: box.input_value() == "0.01", "the file's value is back")


def test_a_page_from_elsewhere_brings_the_token(window: Any, file: Path) -> None:
    options = ("--host", "0.0.0.0", "--token", "of-letters-enough-to-be-one")
    with running(file.parent, file.name, *options) as command:
        assert "token=" in command.address
        address = command.address.replace("0.0.0.0", "127.0.0.1")
        found = window()
        found.page.goto(address)
        found.page.wait_for_selector("#result-rows tr", timeout=60_000)
        assert found.complaints() == []
