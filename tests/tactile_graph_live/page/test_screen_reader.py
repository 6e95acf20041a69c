"""The page as a screen reader reads it aloud: Orca, with the system's Chromium."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, NamedTuple

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")
pytest.importorskip("playwright.sync_api", reason="no playwright")

from helpers_browser import BROWSER, OPTIONS
from helpers_live_page import Double, Plain, frame, pulse, served
from helpers_screen_reader import Reader, lacking, screen_reader

pytestmark = pytest.mark.slow  # a screen, a browser and a screen reader start

SECTIONS = ["Pad", "File", "Graph", "Settings", "Results", "Latency", "Rate"]
ROLES = {
    "button": "button", "checkbox": "check box", "spinbutton": "spin button", "textbox": "entry",
    "combobox": "combo box", "link": "link", "region": "region", "DisclosureTriangle": "button",
}  # fmt: skip
"""What it calls the roles; of those not here, the name must do."""
LOADING = re.compile(r"Loading\.|Finished loading")
LOADS = 8
"""How often the page is opened at most."""


@pytest.fixture(scope="module")
def orca(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Reader]:
    """A screen reader; it and its browser serve the whole module."""
    if BROWSER is None:
        pytest.skip("no Chromium on the PATH")
    if lacking():
        pytest.skip(f"no screen reader: {', '.join(lacking())} not on the PATH")
    with screen_reader(BROWSER, OPTIONS, tmp_path_factory.mktemp("reader")) as reader:
        yield reader


class Running:
    """Keeps a double's pad running: ten frames a second, each with what ``more`` has.

    Three pulses a second go with them, each with what ``state`` has.
    """

    def __init__(self, double: Double) -> None:
        self._double = double
        self._over = threading.Event()
        self.more: Plain = {}
        self.state: Plain = {}
        self._thread = threading.Thread(target=self._run, daemon=True)

    def _run(self) -> None:
        index = 0
        while not self._over.wait(0.1):
            index += 1
            self._double.say(frame(index, **self.more))
            if index % 3 == 0:
                self._double.say(pulse(frames=index, **self.state))

    def __enter__(self) -> Running:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join(10)


@contextmanager
def loading_for(page: Any, seconds: float) -> Iterator[None]:
    """Have what is opened take so long to load."""

    def hold(route: Any) -> None:
        time.sleep(seconds)
        route.continue_()

    page.route("**/*.css", hold)
    yield
    page.unroute("**/*.css")


@contextmanager
def opened(orca: Reader, double: Double) -> Iterator[tuple[Reader, Running, str]]:
    """Open the page and have it read to its end, while frames come; with what was said.

    On a busy machine Orca may take the event that loading has ended before the one that it began;
    from then on it takes the page for one that loads, and tells of no dialog. So the page takes its
    time to load, and each time more if that was too little.
    """
    for tried in range(LOADS):
        orca.page.goto("about:blank")
        time.sleep(1)
        orca.said()
        with loading_for(orca.page, 1.0 + tried):
            orca.page.goto(double.address)
        with Running(double) as running:
            orca.page.wait_for_selector("#result-rows tr")
            said = orca.hears(
                lambda text: "Rate | heading" in text, "the page to its end", 60, quiet_s=0.5
            )
            if [one for one in said if LOADING.match(one)][-1].startswith("Finished"):
                yield orca, running, " | ".join(said)
                return
    raise AssertionError(f"taken for one that loads, {LOADS} times: {said}")


class Shown(NamedTuple):
    """A page that was read to its end.

    Parameters
    ----------
    reader : Reader
    double : Double
        Whose page it is.
    running : Running
    text : str
        What was said as it was opened.
    """

    reader: Reader
    double: Double
    running: Running
    text: str


class Kept:
    """A page that stays open for all tests that leave it as they found it."""

    def __init__(self, orca: Reader) -> None:
        self._orca = orca
        self._stack = ExitStack()
        self._shown: Shown | None = None

    def shown(self) -> Shown:
        """Return the page, opened anew where there is none or a test left a dialog in it."""
        if self._shown is None or self._orca.page.locator("dialog[open]").count():
            self.close()
            double = self._stack.enter_context(served(Double()))
            reader, running, text = self._stack.enter_context(opened(self._orca, double))
            self._shown = Shown(reader, double, running, text)
        return self._shown

    def close(self) -> None:
        """Close it, if it is open: another one comes into the same window."""
        self._shown = None
        self._stack.close()


@pytest.fixture(scope="module")
def kept(orca: Reader) -> Iterator[Kept]:
    found = Kept(orca)
    yield found
    found.close()


@pytest.fixture
def shown(kept: Kept) -> Iterator[Shown]:
    """The page that stays open."""
    found = kept.shown()
    found.double.asked.clear()
    yield found
    found.running.more, found.running.state = {}, {}


@pytest.fixture
def reader(shown: Shown) -> Reader:
    """The reader of the page that stays open."""
    return shown.reader


def focused(page: Any) -> tuple[str, str]:
    """Return role and name of what has the focus, by the browser's accessibility tree."""
    session = page.context.new_cdp_session(page)
    nodes = session.send("Accessibility.getFullAXTree")["nodes"]
    session.detach()
    for node in nodes:
        properties = {p["name"]: p["value"].get("value") for p in node.get("properties", [])}
        if properties.get("focused") and node["role"]["value"] != "RootWebArea":
            return node["role"]["value"], " ".join(node["name"]["value"].split())
    return "", ""


def focus(reader: Reader, selector: str, words: str) -> None:
    """Put the focus somewhere, and wait until that is said."""
    reader.press(
        "Shift_L"
    )  # what the focus does after a key of the reader's own it keeps to itself
    reader.page.locator(selector).focus()
    reader.hears(lambda text: words in text, words, quiet_s=0.5)


def test_all_of_it_is_read_and_headings_lead_through_it(shown: Shown) -> None:
    orca, text = shown.reader, shown.text
    assert re.search("Page has .* 8 headings", text)
    for words in ("800 µs", "Tare | toggle button | not pressed",
                  "Time | horizontal slider", "footprint: {level_v: 0.02}",
                  "table with 6 rows 3 columns", "radius | row header | 2 | cm",
                  "radius, last ten seconds: "):  # fmt: skip
        assert words in text, words
    assert not re.search(r"median\d|answeredlost", text), "legends are for eyes"
    focus(orca, "a.skip[href='#pad']", "To the pad")
    orca.press_and_hear("h", "rings heading level 1")
    for name in SECTIONS:
        orca.press_and_hear("h", f"{name} heading level 2")


def test_each_stop_of_the_tab_key_is_told_by_role_and_name(reader: Reader) -> None:
    focus(reader, "#theme", "Theme: system push button")
    told = []
    while not told or told[-1] != ("region", "Results, as a table"):
        assert len(told) < 40, told
        reader.press("Tab")
        reader.page.wait_for_timeout(100)
        role, name = focused(reader.page)
        if name.startswith("The pad"):  # its name tells what it reads just now
            name = name[: name.index(";")]
        words = (name, ROLES.get(role, ""))
        reader.hears(lambda text, w=words: all(p in text for p in w), f"{role} {name}")
        told.append((role, name))
    assert len(told) > 20
    assert {"button", "checkbox", "slider", "spinbutton", "combobox", "textbox", "option"} <= {
        role for role, _ in told
    }


def test_nodes_of_the_graph_are_told_with_what_became_of_them(shown: Shown) -> None:
    fates = {"footprint": ("ran", ""), "boundary": ("skipped", "touched is false"),
             "circle": ("failed", "fewer than 3 points")}  # fmt: skip
    nodes = {n: {"outcome": o, "reason": r, "us": 12.0} for n, (o, r) in fates.items()}
    reader, shown.running.more = shown.reader, {"nodes": nodes}
    focus(reader, "#nodes [data-name=frame]", "frame what the source gives")
    reader.press_and_hear("Down", "footprint footprint_step ran 12 µs")
    reader.press_and_hear("Down", "boundary boundary_step + touched is false + skipped")
    reader.press_and_hear("Down", "circle output circle_step + fewer than 3 points + failed")


def test_cells_of_the_pad_are_told_by_arrow_keys(reader: Reader) -> None:
    focus(reader, "#numbers", "numbers check box")
    reader.press_and_hear("Tab", "The pad, 8 rows of 10 cells + picture + Arrow keys go from cell")
    reader.press_and_hear("Down", "Row 4, column 5: + V, at ")
    reader.press_and_hear("Right", "Row 4, column 6: + V, at ")
    said = reader.press_and_hear("Down", "Row 5, column 6: + V, at ", quiet_s=1.5)
    assert sum(one.startswith("Row 5") for one in said) == 1, said


def test_results_are_told_every_two_seconds_at_most_and_can_be_hushed(reader: Reader) -> None:
    reader.said()
    time.sleep(10)
    told = [one for one in reader.said() if one.startswith("circle, x ")]
    assert 2 <= len(told) <= 6, told
    assert len(set(told)) == len(told)
    focus(reader, "#keys", "opens dialog")
    reader.press_and_hear("Return", "Keys + dialog")
    focus(reader, "#spoken", "Tell results to screen readers")
    reader.press_and_hear("space", "not checked")
    focus(reader, "#help-close", "Close")
    reader.press("Return")
    reader.page.wait_for_selector("dialog", state="hidden")
    time.sleep(4)
    reader.said()
    time.sleep(6)
    assert [one for one in reader.said() if "circle" in one] == []
    reader.page.locator("#spoken").evaluate("box => box.click()")
    reader.hears(lambda text: "circle, x " in text, "results once more")
    reader.page.evaluate("localStorage.clear()")


def test_taring_and_holding_still_are_told_once_done(shown: Shown) -> None:
    reader, double, running, _ = shown
    focus(reader, "#tare", "Tare toggle button not pressed")
    reader.press("space")
    double.heard("tare")
    running.state = {"tared": True}
    reader.hears(lambda text: re.search(r"(^|\| )pressed", text), "that it is tared")
    focus(reader, "#pause", "Pause push button")
    reader.press("space")
    double.heard("pause")
    running.state = {"paused": True}
    reader.hears(lambda text: "paused: circle" in text, "that it is held")
    running.state = {}
    reader.page.wait_for_selector("#pause span:text-is('Pause')")


def test_a_switch_tells_what_it_came_to(reader: Reader) -> None:
    focus(reader, "#theme", "Theme: system push button")
    reader.press_and_hear("space", "Theme: light")
    for choice in ("dark", "system"):
        reader.page.locator("#theme").click()
        reader.page.wait_for_selector(f"#theme:text-is('Theme: {choice}')")


def test_a_setting_is_told_as_it_changes(shown: Shown) -> None:
    reader, double, *_ = shown
    focus(
        reader,
        "input[type=range][aria-label='footprint, factor']",
        "footprint, factor horizontal slider 2",
    )
    reader.press_and_hear("Right", "3")
    assert double.heard("set")["value"] == 3


def test_a_wrong_file_and_its_mending_are_told(shown: Shown) -> None:
    reader, double, *_ = shown
    errors = [{"line": 3, "column": 9, "text": "level_v: must be > 0, got -1"}]
    reader.said()
    double.say({"type": "trouble", "version": 2, "errors": errors})
    reader.hears(lambda text: "The old graph still runs" in text and "Line 3, column 9: level_v" in text,
                 "the error with its place")  # fmt: skip
    double.say({"type": "trouble", "version": 2, "errors": []})


def test_a_lost_connection_is_told_once(kept: Kept) -> None:
    reader = kept.shown().reader
    reader.said()
    kept.close()
    said = reader.hears(lambda text: "Connection lost" in text, "that it is lost", 30, quiet_s=6)
    assert sum("Connection lost" in one for one in said) == 1
