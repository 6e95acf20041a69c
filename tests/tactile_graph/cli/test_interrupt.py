"""Ctrl-C waits for the end of what must be whole."""

from __future__ import annotations

import signal

import pytest

from tactile_graph.cli.interrupt import Interrupts


def test_outside_of_what_is_held_it_comes_at_once():
    with pytest.raises(KeyboardInterrupt), Interrupts():
        signal.raise_signal(signal.SIGINT)


def write_a_line(done: list[str]) -> None:
    with Interrupts() as interrupts:
        with interrupts.held:
            signal.raise_signal(signal.SIGINT)
            done.append("whole line")
        done.append("never")


def test_inside_it_waits_for_the_end():
    done: list[str] = []
    with pytest.raises(KeyboardInterrupt):
        write_a_line(done)
    assert done == ["whole line"]


def test_afterwards_the_handler_is_as_it_was():
    before = signal.getsignal(signal.SIGINT)
    with Interrupts():
        assert signal.getsignal(signal.SIGINT) is not before
    assert signal.getsignal(signal.SIGINT) is before
