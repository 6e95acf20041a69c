"""Whether a source reads a device, whatever other plugins offer."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import pytest

from tactile_graph import hookimpl
from tactile_graph.plugins import devices
from tactile_graph.plugins.devices import reads_device
from tactile_graph.plugins.registry import Registry, found_plugins


def beside_all(monkeypatch: pytest.MonkeyPatch, kind: str, offers: dict[str, Any]) -> None:
    """Have one more plugin beside those that are installed."""

    def offered() -> dict[str, Any]:
        return offers

    module = ModuleType("late")
    name = offered.__name__ = f"tactile_graph_{kind}"
    vars(module)[name] = hookimpl(offered)
    registry = Registry([*found_plugins(), ("late", "late", "", lambda: module)])
    monkeypatch.setattr(devices, "installed", lambda: registry)


def test_a_broken_device_of_a_plugin_says_nothing_of_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    beside_all(monkeypatch, "devices", {"broken": "no_such_module:DEVICE"})
    assert not reads_device("simulate")
    assert reads_device("serial")


def test_a_device_is_known_where_another_plugin_has_a_step_of_its_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    beside_all(monkeypatch, "steps", {"serial": list})
    assert not reads_device("simulate")
    assert reads_device("sources.serial")
    assert not reads_device("late.serial")
