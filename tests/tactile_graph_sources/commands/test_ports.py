"""``ports`` lists ports and finds the new one."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from tactile_graph.cli import cli
from tactile_graph_sources.commands.ports import ports
from tactile_graph_sources.devices import port_list
from tactile_graph_sources.devices.port_list import PortInfo

PAD = PortInfo("/dev/ttyACM0", "Teensy", "16c0:0483", "Teensyduino", "12345")


def test_ports_are_listed_with_what_is_known_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(port_list, "list_ports", lambda: [PAD, PortInfo("/dev/ttyS0", "")])
    result = CliRunner().invoke(ports)
    assert result.output == "/dev/ttyACM0  Teensy  16c0:0483  Teensyduino  12345\n/dev/ttyS0\n"


def test_no_ports_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(port_list, "list_ports", list)
    assert "no serial ports found" in CliRunner().invoke(ports).output


def test_the_port_that_appears_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(port_list, "wait_for_new_port", lambda timeout_s, listing: PAD)
    result = CliRunner().invoke(ports, ["--wait", "1"])
    assert result.output.endswith("/dev/ttyACM0  Teensy  16c0:0483  Teensyduino  12345\n")


def test_no_new_port_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(port_list, "wait_for_new_port", lambda timeout_s, listing: None)
    result = CliRunner().invoke(cli, ["ports", "--wait", "1"])
    assert result.exit_code == 2
    assert "no new port within 1 s" in result.output
