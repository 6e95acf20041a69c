"""The page's own little algorithms: rails, changed lines, numbers in words, what charts keep."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="the extra `live` is not there")

from helpers_live_page import Double, served

pytestmark = pytest.mark.slow  # a browser starts


@pytest.fixture(scope="module")
def call(browser: Any) -> Any:
    """Calls a function of one of the page's modules."""
    with served(Double()) as double:
        page = browser.new_page()
        page.goto(double.address)
        page.wait_for_selector("#nodes [role=option]")

        def call(module: str, name: str, *values: Any) -> Any:
            code = (
                "async ([module, name, values]) => (await import(`/${module}.js`))[name](...values)"
            )
            return page.evaluate(code, [module, name, values])

        yield call
        page.close()


def wires(*pairs: str) -> list[dict[str, str]]:
    return [{"start": p[0], "end": p[1], "kind": "data"} for p in pairs]


def named(names: str) -> list[dict[str, str]]:
    return [{"name": n} for n in names]


def test_a_chain_takes_one_lane(call: Any) -> None:
    found = call("rails", "rails", named("abc"), wires("ab", "bc"))
    assert [r["lane"] for r in found["rows"]] == [0, 0, 0]
    assert found["count"] == 1


def test_what_is_read_again_keeps_its_lane_until_then(call: Any) -> None:
    found = call("rails", "rails", named("abcd"), wires("ab", "bc", "cd", "ad"))
    lanes = [r["lane"] for r in found["rows"]]
    assert lanes == [0, 1, 1, 0] or lanes == [0, 1, 1, 1]
    assert [r["passing"] for r in found["rows"]] == [[], [0], [0], []]
    assert not found["rows"][3]["goesOn"]


def test_no_lane_is_taken_twice(call: Any) -> None:
    found = call(
        "rails", "rails", named("abcdefg"), wires("ab", "ac", "ad", "be", "ce", "df", "ef", "ag")
    )
    for row in found["rows"]:
        assert row["lane"] not in row["passing"]
        assert len(set(row["passing"])) == len(row["passing"])


def test_nodes_stand_after_what_they_read(call: Any) -> None:
    found = call("rails", "ordered", named("cba"), wires("ab", "bc"))
    assert [n["name"] for n in found] == ["a", "b", "c"]


def test_a_circle_of_wires_still_comes_out(call: Any) -> None:
    assert len(call("rails", "ordered", named("ab"), wires("ab", "ba"))) == 2


@pytest.mark.parametrize(
    ("before", "after", "marks"),
    [
        ("a b c", "a b c", ["", "", ""]),
        ("a b c", "a x c", ["", "changed", ""]),
        ("a c", "a b c", ["", "added", ""]),
        ("a b c", "a c", ["", ""]),
        ("", "a", ["changed"]),
        ("a b c d e", "x b c y e", ["changed", "", "", "changed", ""]),
    ],
)
def test_lines_that_differ(call: Any, before: str, after: str, marks: list[str]) -> None:
    assert call("yaml", "changes", before.split(" "), after.split(" ")) == marks


@pytest.mark.parametrize(
    ("field", "words"),
    [
        ("radius_cm", ["radius", "cm"]),
        ("centre_error_cm", ["centre error", "cm"]),
        ("area_cm2", ["area", "cm²"]),
        ("speed_cm_per_s", ["speed", "cm/s"]),
        ("n_points", ["n points", ""]),
        ("s", ["s", ""]),
    ],
)
def test_fields_in_words(call: Any, field: str, words: list[str]) -> None:
    assert call("numbers", "named", field) == words


@pytest.mark.parametrize(
    ("value", "text"),
    [(6.0, "6"), (6.04321, "6.043"), (123.456, "123.5"), (0.00012, "0.0001"), (True, "yes"),
     (None, "–"), (1234567.8, "1.23e+6"), ("disc", "disc"), (-0.4766, "-0.4766")],
)  # fmt: skip
def test_values_are_told_short(call: Any, value: Any, text: str) -> None:
    assert call("numbers", "told", value) == text


@pytest.mark.parametrize(
    ("us", "text"),
    [(5.25, "5.3 µs"), (812.4, "812 µs"), (1900.0, "1.90 ms"), (48_000.0, "48.0 ms"),
     (2.5e6, "2.5 s"), (None, "–")],
)  # fmt: skip
def test_times_in_the_unit_that_suits_them(call: Any, us: Any, text: str) -> None:
    assert call("numbers", "duration", us) == text


@pytest.mark.parametrize(
    ("text", "told"),
    [("50.0 ms", "50 ms"), ("1.50 ms", "1.5 ms"), ("100 ms", "100 ms"), ("0.1000", "0.1"),
     ("2.0 s", "2 s"), ("20", "20"), ("1.05 ms", "1.05 ms")],
)  # fmt: skip
def test_beside_an_axis_decimals_that_say_nothing_are_left_out(
    call: Any, text: str, told: str
) -> None:
    assert call("numbers", "short", text) == told


def test_ticks_are_round_and_within(call: Any) -> None:
    assert call("numbers", "ticks", 0, 20.8, 5) == [0, 5, 10, 15, 20]
    assert call("numbers", "ticks", 0, 3, 6) == [0, 0.5, 1, 1.5, 2, 2.5, 3]
    assert call("numbers", "ticks", 2, 2, 5) == [2]
    assert call("numbers", "ticks", 0, 4095, 0.5) == [0, 2000, 4000]  # room for half of one
    assert call("numbers", "ticks", -0.3, 0.9, 1) == [0, 0.5]


HISTORY = """async ([seconds, values]) => {
    const { History } = await import("/charts.js");
    const history = new History(seconds);
    for (const [at, value] of values) history.push(at, value);
    return [history.times, history.values, history.range()];
}"""


def history(page: Any, seconds: float, values: list[Any]) -> Any:
    return page.evaluate(HISTORY, [seconds, values])


def test_a_history_keeps_some_seconds_and_gaps(window: Any) -> None:
    page = window().page
    with served(Double()) as double:
        page.goto(double.address)
        times, values, of = history(page, 10, [[0, 1], [100, None], [200, 3]])
        assert (times, values, of) == ([0, 100, 200], [1, None, 3], [1, 3])
        assert history(page, 10, [[0, None]])[2] is None
        times, values, of = history(page, 1, [[10 * n, n] for n in range(5000)])
        assert len(times) == len(values) <= 100 + 65  # trimmed now and then
        assert times[-1] - times[0] <= 1000 + 650
        assert of[1] == 4999
