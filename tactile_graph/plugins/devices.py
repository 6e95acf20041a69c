"""Sources whose frames come from a device: nobody else may open it, and it waits for nobody."""

from __future__ import annotations

from contextlib import suppress

from tactile_graph.errors import TactileGraphError
from tactile_graph.plugins.names import qualified
from tactile_graph.plugins.registry import Registry, installed


def reads_device(source: str) -> bool:
    """Return whether a source step captures a device, as a plugin offers it.

    A device that cannot be loaded, or whose step is not there, says nothing of other sources.
    """
    registry = installed()
    for name in registry.names("devices"):
        with suppress(TactileGraphError):
            if source == registry.spelled("steps", _step(registry, name)):
                return True
    return False


def _step(registry: Registry, name: str) -> str:
    """Return the step of a device: its own plugin's, where others offer one of that name too."""
    step: str = registry.load("devices", name).step
    own = qualified(registry.offer("devices", name).plugin.name, step)
    return own if registry.has("steps", own) else step
