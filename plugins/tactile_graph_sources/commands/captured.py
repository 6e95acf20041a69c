"""A pad on this machine as command lines name it: ``--port``, ``--device``, ``--preset``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.plugins.registry import installed

if TYPE_CHECKING:
    from tactile_graph_sources.devices.capture import CaptureDevice

DEVICES = "devices"
OPTIONS = {"preset": "--preset", "baud": "--baud", "give_up_s": "--give-up"}


def captured(
    port: str | None, name: str, told: Mapping[str, Any], source: str | None
) -> tuple[str, dict[str, Any]]:
    """Return the source step that is meant, and the settings that options give it.

    Raises
    ------
    UsageError
        If the command line names no pad and no other source, or both, or gives a device what it
        does not take.
    """
    if source is not None:
        if port or told["preset"]:
            raise click.UsageError("give --port and --preset, or --source, and not both")
        return source, {}
    registry = installed()
    device: CaptureDevice = registry.load(DEVICES, name)
    known = {s.name: s for s in registry.step(device.step).settings}
    given: dict[str, Any] = {device.address: port}
    for setting, value in told.items():
        if setting in known:
            given[setting] = value
        elif value is not None:
            option = OPTIONS[setting]
            raise click.UsageError(f"{option} is nothing that --device {name} takes")
    for setting, value in given.items():
        if value is None and known[setting].required:
            option = "--port" if setting == device.address else OPTIONS[setting]
            raise click.UsageError(f"Missing option '{option}' (or '--source').")
    return device.step, {k: v for k, v in given.items() if v is not None}
