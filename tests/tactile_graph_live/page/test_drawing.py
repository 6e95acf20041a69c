"""What is drawn: where it belongs, in the right colours, thirty times a second without effort."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import COLUMNS, ROWS, Double, drawn, frame, picture, pulse, wait_for

pytestmark = pytest.mark.slow  # a browser starts

AT = """([x, y]) => {
    const c = document.getElementById("pad-canvas"), ratio = c.width / c.clientWidth;
    return [...c.getContext("2d").getImageData(Math.round(x * ratio), Math.round(y * ratio), 1, 1).data];
}"""
YELLOW, PURPLE, GREY = (253, 231, 37, 255), (68, 1, 84, 255), (120, 120, 120, 255)


@pytest.fixture
def page(window: Any, double: Double) -> Iterator[Any]:
    opened = window()
    opened.page.goto(double.address)
    opened.page.wait_for_selector("#result-rows tr")
    yield opened.page
    # Only the tests themselves read back what is drawn.
    assert [c for c in opened.complaints() if "getImageData" not in c] == []
    opened.leave()


def pad(values: dict[tuple[int, int], int]) -> dict[str, Any]:
    """Return cells that are all 0 but for some."""
    cells = [0] * (ROWS * COLUMNS)
    for (row, column), level in values.items():
        cells[row * COLUMNS + column] = level
    return picture(cells)


def shown(page: Any, double: Double, **more: Any) -> None:
    """Have a frame drawn."""
    double.say(frame(42, **more))
    drawn(page, "frame 42")


def place(page: Any, row: float, column: float) -> list[float]:
    """Return where a cell's middle lies on the canvas, in CSS pixels, by the axes' margins."""
    box = page.locator("#pad-canvas").bounding_box()
    left, top, right, bottom = 38, 8, 72, 34
    width, height = box["width"] - left - right, box["height"] - top - bottom
    side = min(width / COLUMNS, height / ROWS)
    x0, y0 = left + (width - side * COLUMNS) / 2, top + (height - side * ROWS) / 2
    return [x0 + (column + 0.5) * side, y0 + (row + 0.5) * side]


def test_cells_have_the_colours_of_their_values(page: Any, double: Double) -> None:
    shown(page, double, pad=pad({(2, 3): 254, (5, 7): 255}), drawing=[])
    assert tuple(page.evaluate(AT, place(page, 2, 3))) == YELLOW
    assert tuple(page.evaluate(AT, place(page, 2, 4))) == PURPLE
    assert tuple(page.evaluate(AT, place(page, 5, 7))) == GREY
    assert "no reading" in page.locator("#legend").inner_text()


def test_cells_are_crisp_unless_asked_otherwise(page: Any, double: Double) -> None:
    shown(page, double, pad=pad({(2, 3): 254}), drawing=[])
    x, y = place(page, 2, 3)
    edge = (place(page, 2, 4)[0] - x) / 2
    beside = [x + edge - 2, y]
    assert tuple(page.evaluate(AT, beside)) == YELLOW
    page.get_by_label("smooth").check()
    assert tuple(page.evaluate(AT, beside)) != YELLOW


def test_found_and_true_lie_where_they_are(page: Any, double: Double) -> None:
    cross = {"shape": "cross", "role": "found", "node": "circle", "x": 3.5 * 1.3, "y": 2.5 * 1.3}
    truth = {"shape": "points", "role": "true", "node": "", "xy": [[7.5 * 1.3, 5.5 * 1.3]]}
    shown(page, double, pad=pad({}), drawing=[cross, truth])
    assert tuple(page.evaluate(AT, place(page, 2, 3)))[:3] == (216, 27, 96)
    assert tuple(page.evaluate(AT, place(page, 5, 7)))[:3] == (0, 131, 143)
    assert page.locator("#legend").inner_text().split("\n") == ["found", "truly there"]


def test_pointing_tells_the_cell(page: Any, double: Double) -> None:
    shown(page, double, pad=pad({(2, 3): 127}), drawing=[])
    x, y = place(page, 2, 3)
    page.locator("#pad-canvas").hover(position={"x": x, "y": y})
    assert page.locator("#readout").inner_text() == "Row 2, column 3: about 1.5 V, at 4.5, 3.3 cm"


@pytest.mark.parametrize("kind", ["<f8", "<f4"])
def test_a_cell_reads_what_it_reads_however_far_the_colours_reach(
    page: Any, double: Double, kind: str
) -> None:
    cells = [0.0] * (ROWS * COLUMNS)
    cells[23], cells[24], cells[25], cells[26] = 100.0, 0.0042, math.nan, 2345.6
    colours = [*[1] * 25, 255, *[1] * (ROWS * COLUMNS - 26)]
    told = picture(colours, cells, kind, low=-1137.0, high=1e6)
    shown(page, double, pad=told, drawing=[])
    read = []
    for column in range(3, 8):
        x, y = place(page, 2, column)
        page.locator("#pad-canvas").hover(position={"x": x, "y": y})
        read.append(page.locator("#readout").inner_text().split(": ")[1].split(", at")[0])
    assert read == ["100 V", "0.0042 V", "no reading", "2346 V", "0 V"]
    words = page.locator("#pad-canvas")
    wait_for(lambda: "highest 2346 V" in words.get_attribute("aria-label"), "the highest is told")


def test_without_readings_no_more_digits_are_told_than_colours_tell(
    page: Any, double: Double
) -> None:
    told = picture([64] * (ROWS * COLUMNS), low=-1137.0, high=3400.0)  # 0 by a colour of 6.2
    shown(page, double, pad=told, drawing=[])
    x, y = place(page, 2, 3)
    page.locator("#pad-canvas").hover(position={"x": x, "y": y})
    assert "about 10 V" in page.locator("#readout").inner_text()


def test_numbers_say_where_there_is_no_room_for_them(window: Any, double: Double) -> None:
    page = window(viewport={"width": 390, "height": 800}).page
    page.goto(double.address)
    page.wait_for_selector("#result-rows tr")
    page.get_by_label("numbers").check()
    word = page.locator("#numbers-word")
    for n, expected in ((16, "numbers"), (60, "numbers: no room")):
        small = picture([0] * n * n, [100.0] * n * n, rows=n, columns=n)
        shown(page, double, pad=small, drawing=[])
        wait_for(lambda told=expected: word.inner_text() == told, expected)


def test_a_wide_pad_fits(page: Any, double: Double) -> None:
    wide = picture([9] * 320) | {"rows": 4, "columns": 80}
    shown(page, double, pad=wide)
    box = page.locator("#pad-canvas").bounding_box()
    assert box["height"] < 0.5 * box["width"]


def test_numbers_stand_in_the_cells(page: Any, double: Double) -> None:
    shown(page, double, pad=pad({}), drawing=[])
    x, y = place(page, 4, 4)
    ink = """([x, y]) => {
        const c = document.getElementById("pad-canvas"), r = c.width / c.clientWidth;
        const data = c.getContext("2d").getImageData((x - 14) * r, (y - 8) * r, 28 * r, 16 * r).data;
        return data.reduce((n, value, i) => n + (i % 4 === 1 && value > 150), 0);
    }"""
    assert page.evaluate(ink, [x, y]) == 0
    page.get_by_label("numbers").check()
    assert page.evaluate(ink, [x, y]) > 10


PAINTED = """([id, name]) => {
    const e = document.createElement("span");
    e.style.color = `var(${name})`;
    document.body.append(e);
    const [r, g, b] = getComputedStyle(e).color.match(/\\d+/g).map(Number);
    const c = document.getElementById(id), ratio = c.width / c.clientWidth;
    const data = c.getContext("2d").getImageData(54 * ratio, 0, c.width - 64 * ratio, c.height).data;
    let n = 0;
    for (let i = 0; i < data.length; i += 4) {
        const away = Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b);
        if (data[i + 3] > 100 && away < 12) n += 1;
    }
    return n;
}"""


def test_lost_and_shed_frames_and_both_latencies_have_lines_of_their_colours(
    page: Any, double: Double
) -> None:
    to_page = {"median": 1300.0, "p99": 2000.0, "most": 2500.0}
    for n in range(12):
        double.say(pulse(lost=20 * n, shed=30 * n, frames=100 * n, page_latency_us=to_page))
        page.wait_for_timeout(120)
    for canvas, lines in (("flow-chart", ("--accent", "--p99", "--bad")),
                          ("latency-chart", ("--accent", "--p99", "--good", "--bad"))):  # fmt: skip
        for name in lines:
            assert page.evaluate(PAINTED, [canvas, name]) > 5, (canvas, name)
    told = [key.strip() for key in page.locator("#flow .keyed > span").all_inner_texts()]
    assert told == ["answered", "lost on the way", "shed here"]
    told = [key.strip() for key in page.locator("#timing .keyed > span").all_inner_texts()]
    assert told == ["to the result, median", "99\xa0%", "to the page, median", "deadline"]


def test_thirty_pictures_a_second_cost_little_and_leave_nothing_behind(
    page: Any, double: Double
) -> None:
    """Every frame is drawn, in a fraction of its time; the document does not grow."""
    page.locator("#nodes [data-name=circle]").click()
    count = "document.getElementsByTagName('*').length"
    index, due = 0, time.monotonic()
    before = None
    for second in range(4):
        for _ in range(30):
            index += 1
            double.say(frame(index))
            due += 1 / 30
            page.wait_for_timeout(max(0.0, 1e3 * (due - time.monotonic())))
        double.say(pulse())
        if second == 1:
            before = page.evaluate(count)
    median_ms, worst_ms = map(
        float, page.evaluate("document.documentElement.dataset.drawMs").split()
    )
    assert page.evaluate(count) == before
    assert median_ms < 12
    assert worst_ms < 100
    assert len(set(double.answered)) == index + 1
