"""Ctrl-C waits for the end of what must be whole."""

from __future__ import annotations

import ctypes
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress

import pytest

from tactile_graph.cli import interrupt
from tactile_graph.cli.interrupt import ENDS, Ended, Interrupts, code_of, reader_awaited, words_of


def test_outside_of_what_is_held_it_comes_at_once():
    with pytest.raises(KeyboardInterrupt), Interrupts():
        signal.raise_signal(signal.SIGINT)


def test_what_ended_one_command_does_not_end_the_next():
    with pytest.raises(KeyboardInterrupt), Interrupts():
        signal.raise_signal(signal.SIGINT)
    with Interrupts():
        assert Interrupts.latest is None


def test_what_was_swallowed_before_a_part_of_a_command_comes_again_there():
    with Interrupts():
        with suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt), Interrupts() as interrupts:
            interrupts.again()


def write_a_line(done: list[str], number: signal.Signals = signal.SIGINT) -> None:
    with Interrupts() as interrupts:
        with interrupts.held:
            signal.raise_signal(number)
            done.append("whole line")
        done.append("never")


def test_inside_it_waits_for_the_end():
    done: list[str] = []
    with pytest.raises(KeyboardInterrupt):
        write_a_line(done)
    assert done == ["whole line"]


def stay_inside(*after_s: float) -> None:
    """Raise Ctrl-C at once, and after as many seconds, in a block that then waits."""
    with Interrupts() as interrupts, interrupts.held:
        signal.raise_signal(signal.SIGINT)
        for pause_s in after_s:
            time.sleep(pause_s)
            signal.raise_signal(signal.SIGINT)
        time.sleep(SLEEP_S)


def test_a_second_one_gets_through_to_a_block_that_does_not_end(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(interrupt, "PATIENCE_S", 0.05)
    begun_s = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        stay_inside(0.0, 0.06)
    assert 0.05 < time.monotonic() - begun_s < SLEEP_S


def test_one_gets_through_to_where_a_reader_is_awaited(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(interrupt, "PATIENCE_S", 0.05)
    begun_s = time.monotonic()
    with pytest.raises(KeyboardInterrupt), reader_awaited():
        stay_inside()
    assert 0.05 < time.monotonic() - begun_s < SLEEP_S


def hand_on_slowly(taken: list[int]) -> None:
    with Interrupts() as interrupts, interrupts.held:
        signal.raise_signal(signal.SIGINT)
        for k in range(15):
            with reader_awaited():
                time.sleep(0.015)
            taken.append(k)


def test_one_waits_while_a_reader_takes_something(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(interrupt, "PATIENCE_S", 0.1)
    taken: list[int] = []
    with pytest.raises(KeyboardInterrupt):
        hand_on_slowly(taken)
    assert len(taken) == 15


def test_what_ends_by_itself_is_asked_once_before_it_is_made_to():
    asked: list[str] = []
    with Interrupts() as interrupts:
        interrupts.politely = lambda: not asked.append("end")
        signal.raise_signal(signal.SIGTERM)
        interrupts.again()
        assert isinstance(interrupts.heeded, Ended)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert asked == ["end"]


def test_afterwards_the_handler_is_as_it_was():
    before = signal.getsignal(signal.SIGINT)
    with Interrupts():
        assert signal.getsignal(signal.SIGINT) is not before
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize("number", ENDS)
def test_what_ends_programs_is_held_like_ctrl_c_and_told_apart(number: signal.Signals):
    done: list[str] = []
    with pytest.raises(Ended) as got:
        write_a_line(done, number)
    assert done == ["whole line"]
    assert code_of(got.value) == 128 + number
    assert words_of(got.value) == f"ended by {number.name}"
    assert (code_of(KeyboardInterrupt()), words_of(KeyboardInterrupt())) == (130, "interrupted")


SLEEP_S = 30.0


class Deaf:
    """Something whose end swallows what is raised in it."""

    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)


def swallowed_by_an_end() -> None:
    Deaf()


def swallowed_by_a_callback() -> None:
    """Raise Ctrl-C in what machine code calls, as a compiler's cache does."""
    called = ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(signal.SIGINT))
    called()


def swallow(swallowed: Callable[[], None]) -> None:
    with Interrupts():
        swallowed()
        time.sleep(SLEEP_S)


@pytest.mark.parametrize("swallowed", [swallowed_by_an_end, swallowed_by_a_callback])
def test_what_nothing_lets_out_comes_again(swallowed: Callable[[], None]):
    before, begun_s = sys.unraisablehook, time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        swallow(swallowed)
    assert time.monotonic() - begun_s < SLEEP_S  # it wakes who sleeps
    assert sys.unraisablehook is before


def test_other_errors_that_nothing_lets_out_are_told_as_before(monkeypatch: pytest.MonkeyPatch):
    told: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", lambda what: told.append(what.exc_value))

    def fails() -> None:
        raise ValueError("in a callback")

    with Interrupts():
        ctypes.CFUNCTYPE(None)(fails)()
    assert [str(error) for error in told] == ["in a callback"]
