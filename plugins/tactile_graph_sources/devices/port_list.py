"""The ports of this machine, and the one that appears when a pad is plugged in."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

POLL_S = 0.25


class PortInfo(NamedTuple):
    """One port: what to open, and what the machine knows of what hangs on it."""

    device: str
    description: str
    usb_id: str = ""
    maker: str = ""
    serial_number: str = ""


def list_ports() -> list[PortInfo]:
    """Return the ports of this machine, sorted by name."""
    from serial.tools import list_ports as pyserial_list

    out = []
    for p in pyserial_list.comports():
        usb = f"{p.vid:04x}:{p.pid:04x}" if p.vid is not None and p.pid is not None else ""
        description = "" if p.description in (None, "n/a") else p.description
        out.append(
            PortInfo(p.device, description, usb, p.manufacturer or "", p.serial_number or "")
        )
    return sorted(out)


def wait_for_new_port(
    timeout_s: float,
    listing: Callable[[], list[PortInfo]] = list_ports,
    poll_s: float = POLL_S,
) -> PortInfo | None:
    """Return the port that appears within ``timeout_s``, or None.

    A port that goes and comes back, as when a pad is unplugged and plugged in, counts as new.
    """
    known = {p.device for p in listing()}
    deadline = time.perf_counter() + timeout_s
    while time.perf_counter() < deadline:
        time.sleep(poll_s)
        now = listing()
        new = [p for p in now if p.device not in known]
        if new:
            return new[0]
        known &= {p.device for p in now}
    return None
