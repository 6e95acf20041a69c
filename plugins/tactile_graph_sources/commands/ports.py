"""``tactile-graph ports``: which ports there are, and which one a pad appears on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from tactile_graph.cli.numbers import Finite
from tactile_graph.cli.say import say

if TYPE_CHECKING:
    from tactile_graph_sources.devices.port_list import PortInfo

OFFERS = "devices"
USUAL = "serial"


@click.command()
@click.option(
    "--wait",
    "wait_s",
    type=Finite(min=0.0, min_open=True),
    metavar="SECONDS",
    help="Wait for a pad to be plugged in and name its port.",
)
def ports(wait_s: float | None) -> None:
    """List the ports, or find the one that appears when a pad is plugged in.

    Behind a port that is none of the serial ones stands what 'record --device' calls it.
    """
    from tactile_graph.errors import UsageError
    from tactile_graph_sources.devices.port_list import wait_for_new_port

    if wait_s is not None:
        say("plug the pad in now (unplug it first if it is in) …", err=True)
        new = wait_for_new_port(wait_s, lambda: [port for _, port in _connected()])
        if new is None:
            raise UsageError(f"no new port within {wait_s:g} s")
        _show(next((name for name, port in _connected() if port.device == new.device), USUAL), new)
        return
    found = _connected()
    if not found:
        say("no serial ports found; a pad may need its driver, or another cable", err=True)
    for name, port in found:
        _show(name, port)


def _connected() -> list[tuple[str, PortInfo]]:
    """Return what hangs on this machine, each with the name of its kind of device."""
    from tactile_graph.plugins.registry import installed

    registry = installed()
    return [
        (name, port)
        for name in registry.offered(OFFERS)
        for port in registry.load(OFFERS, name).connected()
    ]


def _show(name: str, port: PortInfo) -> None:
    kind = "" if name == USUAL else f"--device {name}"
    say("  ".join(t for t in (*port[:4], port.serial_number, kind) if t))
