"""Why a port cannot be opened is told in words, with what to do."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

import pytest
import serial

from tactile_graph.errors import UsageError
from tactile_graph.steps.injected import Report
from tactile_graph_sources.devices.port_words import refusal
from tactile_graph_sources.serial_port import serial as source

PORTS = ["/dev/ttyACM0", "/dev/ttyUSB0"]


def opening(port: str) -> str:
    with pytest.raises(UsageError) as caught:
        next(source(port=port, preset="m1616", report=Report()))
    return str(caught.value)


def test_a_port_that_is_not_there_is_told_with_the_nearest() -> None:
    error = serial.SerialException(errno.ENOENT, "could not open port x: [Errno 2] No such")
    assert refusal("/dev/ttyACM1", error, PORTS) == (
        "port '/dev/ttyACM1' cannot be opened: there is no such port; "
        "did you mean '/dev/ttyACM0'?; ports here: /dev/ttyACM0, /dev/ttyUSB0"
    )
    assert opening("/dev/no-such-port").startswith(
        "port '/dev/no-such-port' cannot be opened: there is no such port"
    )


def test_what_is_no_port_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for name in (tmp_path, tmp_path / "file", "/dev/null"):
        assert f"port '{name}' cannot be opened: it is no serial port; ports" in opening(str(name))


@pytest.mark.parametrize("scheme", ["", "spy://", "alt://"])
def test_a_port_that_another_program_has_open_is_told(scheme: str) -> None:
    master, slave = os.openpty()
    name = scheme + os.ttyname(slave)
    try:
        with serial.Serial(os.ttyname(slave), exclusive=True):
            assert opening(name) == f"port {name!r} cannot be opened: another program has it open"
    finally:
        os.close(master)
        os.close(slave)


def test_a_port_that_may_not_be_opened_says_who_may(monkeypatch: pytest.MonkeyPatch) -> None:
    import grp

    error = serial.SerialException(errno.EACCES, "could not open port")
    monkeypatch.setattr(grp, "getgrgid", lambda _: grp.struct_group(("dialout", "x", 20, [])))
    told = refusal("/dev/null", error, PORTS)
    assert told.startswith(
        "port '/dev/null' cannot be opened: permission denied; it belongs to the group 'dialout': "
        "'sudo usermod -aG dialout $USER' lets you in"
    )
    assert refusal("/dev/no-such", error, PORTS).endswith("permission denied")


@pytest.mark.parametrize(
    ("within", "told"),
    [
        ("PermissionError(13, 'Access is denied.', None, 5)", "another program has it open"),
        (
            "FileNotFoundError(2, 'The system cannot find the file specified.', None, 2)",
            "there is no such port; did you mean 'COM4'?; ports here: COM11, COM4",
        ),
        (
            "OSError(22, 'The semaphore timeout period has expired.', None, 121)",
            "The semaphore timeout period has expired.; ports here: COM11, COM4",
        ),
    ],
)
def test_what_pyserial_tells_on_windows_within_its_text_is_understood(
    within: str, told: str
) -> None:
    error = serial.SerialException(f"could not open port 'COM3': {within}")
    assert refusal("COM3", error, ["COM11", "COM4"]) == f"port 'COM3' cannot be opened: {told}"


@pytest.mark.parametrize(
    ("url", "message"),
    [
        ("socket://127.0.0.1:1", "cannot be opened: Connection refused"),
        ("socket://", "it names no host and port; a URL is like socket://host:port"),
        ("http://x", "protocol 'http' not known; a URL is like socket://host:port"),
    ],
)
def test_a_url_that_leads_nowhere_is_told(url: str, message: str) -> None:
    got: Any = opening(url)
    assert got.startswith(f"port {url!r} cannot be opened: ")
    assert message in got


@pytest.mark.parametrize("option", ["file={}", "raw&file={}", "fil%65={}"])
def test_a_port_that_would_be_written_to_a_file_is_refused(tmp_path: Path, option: str) -> None:
    victim = tmp_path / "victim"
    victim.write_text("kept")
    for scheme in ("spy", "SPY"):
        message = opening(f"{scheme}:///dev/no-such-port?{option.format(victim)}")
        assert "cannot be opened: spy:// writes no file here" in message
        assert victim.read_text() == "kept"


@pytest.mark.parametrize("pattern", ["[Nn]o-such-port", "VID:PID=FFFF:FFF[0-9]-none"])
def test_a_pattern_of_ports_may_have_brackets(pattern: str) -> None:
    got: Any = opening(f"hwgrep://{pattern}")
    assert "no ports found matching" in got
