"""Tactile images through graphs of plugin steps that YAML files declare."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline as Pipeline
    from tactile_graph.api.pipeline import load as load
    from tactile_graph.api.pipeline import loads as loads
    from tactile_graph.api.result import Result as Result
    from tactile_graph.errors import Degenerate as Degenerate
    from tactile_graph.errors import Skip as Skip
    from tactile_graph.errors import SourceWarning as SourceWarning
    from tactile_graph.errors import TactileGraphError as TactileGraphError
    from tactile_graph.plugins.hookspecs import hookimpl as hookimpl
    from tactile_graph.wires import Circle as Circle
    from tactile_graph.wires import Ellipse as Ellipse
    from tactile_graph.wires import Frame as Frame
    from tactile_graph.wires import Image as Image
    from tactile_graph.wires import Mask as Mask
    from tactile_graph.wires import Points as Points
    from tactile_graph.wires import Polygon as Polygon
    from tactile_graph.wires import Rectangle as Rectangle

# Name -> module. Loaded on first use: a plugin that wants only `hookimpl` must not pay for NumPy.
_HOMES = {
    "Circle": "wires.shapes",
    "Degenerate": "errors",
    "Ellipse": "wires.shapes",
    "Frame": "wires.frame",
    "Image": "wires.image",
    "Mask": "wires.image",
    "Pipeline": "api.pipeline",
    "Points": "wires.points",
    "Polygon": "wires.shapes",
    "Rectangle": "wires.shapes",
    "Result": "api.result",
    "Skip": "errors",
    "SourceWarning": "errors",
    "TactileGraphError": "errors",
    "hookimpl": "plugins.hookspecs",
    "load": "api.pipeline",
    "loads": "api.pipeline",
}
__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tactile_graph' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"tactile_graph.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
