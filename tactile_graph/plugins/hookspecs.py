"""The whole plugin API: each hook returns what a plugin offers and changes nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pluggy

PROJECT = "tactile_graph"
hookspec = pluggy.HookspecMarker(PROJECT)
hookimpl = pluggy.HookimplMarker(PROJECT)


@hookspec
def tactile_graph_steps() -> Mapping[str, str | Callable[..., Any]]:  # type: ignore[empty-body]
    """Step name -> import string ``"package.module:name"`` (loaded when used), or the step."""


@hookspec
def tactile_graph_readers() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Source step that reads recordings -> its setting that takes the path, or a list of paths.

    The first offered reads the recordings a command line names; ``--source`` names another.
    """


@hookspec
def tactile_graph_pipelines() -> Mapping[str, Path]:  # type: ignore[empty-body]
    """Pipeline name -> its YAML file."""


@hookspec
def tactile_graph_pads() -> Mapping[str, Path]:  # type: ignore[empty-body]
    """Pad name -> its YAML file."""


@hookspec
def tactile_graph_presets() -> Mapping[str, Path]:  # type: ignore[empty-body]
    """Device preset name -> its YAML file."""


@hookspec
def tactile_graph_scenes() -> Mapping[str, Path]:  # type: ignore[empty-body]
    """Scene name -> its YAML file."""


@hookspec
def tactile_graph_file_kinds() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Kind of YAML file (``"pad"``) -> import string of its `FileKind`, for check and schema."""


@hookspec
def tactile_graph_commands() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Command name -> import string of a click command, ``"package.module:name"``."""
