"""``CaptureDevice``: a way in which pads hang on this machine, and what captures their frames."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from tactile_graph_sources.devices import port_list
from tactile_graph_sources.devices.port_list import PortInfo


class CaptureDevice(NamedTuple):
    """A way in which pads hang on this machine.

    Attributes
    ----------
    step : str
        The source step that captures frames; it ends when it is closed.
    address : str
        Its setting that takes which pad is meant, as ``--port`` names it.
    connected : callable
        Returns what hangs on this machine now, for ``ports``; `PortInfo.device` is the address.
    """

    step: str
    address: str
    connected: Callable[[], list[PortInfo]]


SERIAL = CaptureDevice("serial", "port", lambda: port_list.list_ports())
