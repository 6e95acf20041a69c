"""Files of presets and scenes as ``check`` and ``schema`` take them."""

from __future__ import annotations

from tactile_graph.plugins.file_kind import FileKind
from tactile_graph_sources.devices.preset import Preset
from tactile_graph_sources.devices.preset_file import load_preset
from tactile_graph_sources.scene import Scene, load_scene


def tell_preset(preset: Preset) -> str:
    """Return what a preset reads, in a line."""
    geometry, units = preset.geometry, {"packet": "packets", "text": "lines of text"}
    framed = units.get(preset.framer.kind, "bytes up to an end byte")
    brings = {"full": "a frame", "rows": "a row", "chunks": "a chunk", "cells": "a cell"}
    return (
        f"{geometry.rows} x {geometry.columns} cells in {geometry.quantity}; {framed} of "
        f"{brings[preset.assembler]} each; {preset.transport.baud} baud"
    )


def tell_scene(scene: Scene) -> str:
    """Return what lies in a scene, in a line, and the furthest place; no pad is known here."""
    places = [t.place for group in scene.in_turn or (scene.objects,) for t in group]
    given = [place for place in places if not isinstance(place, str)]
    if not given:
        return _told_objects(scene)
    x, y = (max(along) for along in zip(*given, strict=True))
    return f"{_told_objects(scene)}; places up to x {x:g} cm, y {y:g} cm"


def _told_objects(scene: Scene) -> str:
    if scene.in_turn:
        sizes = sorted({len(group) for group in scene.in_turn})
        n = str(sizes[0]) if len(sizes) == 1 else f"{sizes[0]} to {sizes[-1]}"
        if n == "1":
            return f"{_counted(len(scene.in_turn), 'object')} in turn"
        return f"{_counted(len(scene.in_turn), 'placement')} in turn, {n} objects each"
    return _counted(len(scene.objects), "object") if scene.objects else "an empty pad"


def _counted(n: int, what: str) -> str:
    return f"{n} {what}{'s' if n != 1 else ''}"


PRESET = FileKind("presets", Preset, load_preset, tell_preset, base_key="extends")
SCENE = FileKind("scenes", Scene, load_scene, tell_scene)
