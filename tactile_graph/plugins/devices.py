"""Sources whose frames come from a device: nobody else may open it, and it waits for nobody."""

from __future__ import annotations

from tactile_graph.plugins.registry import installed


def reads_device(source: str) -> bool:
    """Return whether a source step captures a device, as a plugin offers it.

    Raises
    ------
    PluginError
        If what a plugin offers cannot be imported.
    """
    registry = installed()
    devices = [registry.load("devices", name) for name in registry.names("devices")]
    return source in {registry.spelled("steps", d.step) for d in devices}
