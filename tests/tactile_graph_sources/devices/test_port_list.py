"""Finding ports."""

from __future__ import annotations

from tactile_graph_sources.devices.port_list import PortInfo, list_ports, wait_for_new_port

A, B = PortInfo("/dev/a", "A"), PortInfo("/dev/b", "B")


def test_ports_are_listed_sorted() -> None:
    found = list_ports()
    assert found == sorted(found)


def test_the_port_that_appears_is_found() -> None:
    answers = iter([[A], [A], [A, B]])
    assert wait_for_new_port(5.0, lambda: next(answers), poll_s=0.001) == B


def test_a_pad_unplugged_and_plugged_in_again_is_found() -> None:
    answers = iter([[A, B], [A], [A, B]])
    assert wait_for_new_port(5.0, lambda: next(answers), poll_s=0.001) == B


def test_no_new_port_within_the_time_is_none() -> None:
    assert wait_for_new_port(0.01, lambda: [A], poll_s=0.001) is None
