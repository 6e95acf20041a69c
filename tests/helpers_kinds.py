"""A plugin with a kind of file of its own: lamps, offered as scenes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, ClassVar

from annotated_types import Gt

from tactile_graph import hookimpl
from tactile_graph.errors import PipelineError
from tactile_graph.pipeline.document import read_document
from tactile_graph.plugins.file_kind import FileKind
from tactile_graph.plugins.registry import installed


@dataclass(frozen=True)
class Bulb:
    """What is screwed into a lamp."""

    watt: Annotated[float, Gt(0)]
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


@dataclass(frozen=True)
class Lamp:
    """A lamp.

    Parameters
    ----------
    bulbs : tuple of Bulb
        What is in it; ``None`` is no bulb.
    about : str
        One line.
    """

    bulbs: tuple[Bulb, ...]
    about: str = ""
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


def read_lamp(name: str) -> Lamp:
    path = Path(name) if name.endswith(".yaml") else installed().path("scenes", name)
    document = read_document(path.read_text(), name)
    bulbs = document.data.get("bulbs", [])
    for i, bulb in enumerate(bulbs):
        if bulb["watt"] <= 0:
            document.problem(f"watt must be > 0, got {bulb['watt']}", "bulbs", i, "watt")
    if document.problems:
        raise PipelineError(document.problems)
    return Lamp(tuple(Bulb(**bulb) for bulb in bulbs))


LAMP = FileKind("scenes", Lamp, read_lamp, lambda lamp: f"{len(lamp.bulbs)} bulbs", base_key="like")
NO_KIND = 3


def lamp_plugin(folder: Path, **more: Any) -> Callable[[], ModuleType]:
    """Return the plugin, with two lamps written into the folder; ``more`` adds to its kinds."""
    paths = {name: folder / f"{name}-lamp.yaml" for name in ("desk", "discs")}
    for name, path in paths.items():
        path.write_text(f"about: the lamp {name}\nbulbs: [{{watt: 40}}, {{watt: 5}}]\n")
    module = ModuleType("lamps")

    @hookimpl
    def tactile_graph_scenes() -> Mapping[str, Path]:
        return paths

    @hookimpl
    def tactile_graph_file_kinds() -> Mapping[str, str]:
        return {"lamp": "helpers_kinds:LAMP", **more}

    module.tactile_graph_scenes = tactile_graph_scenes  # type: ignore[attr-defined]
    module.tactile_graph_file_kinds = tactile_graph_file_kinds  # type: ignore[attr-defined]
    return lambda: module
