"""Who waits for the compiler is told what is compiled; who does not wait is told nothing."""

from __future__ import annotations

import io
import time

import pytest

from tactile_graph.compiled import preparing
from tactile_graph.compiled.preparing import Line, Preparing, told_by


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(preparing, "WORTH_A_LINE_S", -1.0)


def compile_three(stream: io.StringIO) -> str:
    work = Preparing()
    with told_by(Line(stream)), work.of("fit", 3):
        for kernel in ("fit", "step", "step", "length"):
            work.at(kernel)
        work.all_together()
    return stream.getvalue()


def test_short_work_is_not_told() -> None:
    assert compile_three(Terminal()) == ""


@pytest.mark.usefixtures("slow")
def test_a_terminal_has_one_line_that_changes_and_goes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(preparing, "REDRAW_S", 0.0)
    shown = compile_three(Terminal())
    lines = [text.removesuffix("\x1b[K") for text in shown.split("\r")]
    start = "compiling fit, once on this machine: "
    assert lines == [
        "",
        f"{start}1 of 3 kernels, 0 s",
        f"{start}2 of 3 kernels, 0 s",
        f"{start}2 of 3 kernels, 0 s",
        f"{start}3 of 3 kernels, 0 s",
        f"{start}3 kernels into one, 0 s",
        "",
    ]


@pytest.mark.usefixtures("slow")
def test_a_log_has_a_plain_line_now_and_then() -> None:
    assert compile_three(io.StringIO()) == (
        "compiling fit, once on this machine: 1 of 3 kernels, 0 s\n"
    )


@pytest.mark.usefixtures("slow")
def test_the_last_who_asked_is_told() -> None:
    first: list[str | None] = []
    second: list[str | None] = []
    work = Preparing()
    with told_by(first.append):
        with told_by(second.append), work.of("fit", 1):
            work.at("fit")
        with work.of("turn", 1):
            work.at("turn")
    assert [str(text)[:14] for text in second] == ["compiling fit,", "None"]
    assert [str(text)[:14] for text in first] == ["compiling turn", "None"]


def test_what_was_prepared_before_anybody_listened_is_not_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    told: list[str | None] = []
    with preparing.preparing.of("fit", 1):
        monkeypatch.setattr(time, "monotonic", lambda now=time.monotonic: now() + 60.0)
    with told_by(told.append), preparing.preparing.of("turn", 1):
        preparing.preparing.at("turn")
    assert told == [None]


@pytest.mark.usefixtures("slow")
def test_nobody_need_listen(capsys: pytest.CaptureFixture[str]) -> None:
    with Preparing().of("fit", 1):
        pass
    assert capsys.readouterr() == ("", "")
