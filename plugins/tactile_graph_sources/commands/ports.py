"""``tactile-graph ports``: which ports there are, and which one a pad appears on."""

from __future__ import annotations

import click

from tactile_graph.cli.say import say


@click.command()
@click.option(
    "--wait",
    "wait_s",
    type=click.FloatRange(min=0.0, min_open=True),
    metavar="SECONDS",
    help="Wait for a pad to be plugged in and name its port.",
)
def ports(wait_s: float | None) -> None:
    """List the serial ports, or find the one that appears when a pad is plugged in."""
    from tactile_graph.errors import UsageError
    from tactile_graph_sources.devices.port_list import PortInfo, list_ports, wait_for_new_port

    def show(port: PortInfo) -> None:
        say("  ".join(t for t in (*port[:4], port.serial_number) if t))

    if wait_s is not None:
        say("plug the pad in now (unplug it first if it is in) …", err=True)
        new = wait_for_new_port(wait_s)
        if new is None:
            raise UsageError(f"no new port within {wait_s:g} s")
        show(new)
        return
    found = list_ports()
    if not found:
        say("no serial ports found; a pad may need its driver, or another cable", err=True)
    for port in found:
        show(port)
