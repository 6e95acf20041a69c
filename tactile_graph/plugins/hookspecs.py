"""The hooks of the core: each returns what a plugin offers, by name, and changes nothing.

A plugin may have hooks of its own, which all may answer: functions like these, marked with `hook`
or `hook_of`, in a module ``hookspecs`` that it imports where its entry point leads.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import pluggy

PROJECT = "tactile_graph"
hookimpl = pluggy.HookimplMarker(PROJECT)
F = TypeVar("F", bound=Callable[..., Any])
_marked = pluggy.HookspecMarker(PROJECT)


class Answer(NamedTuple):
    """What a hook's mapping holds beside each name.

    Attributes
    ----------
    types : tuple of type
        Of what stands there.
    wanted : str
        That in words, for whoever gave something else.
    imported : bool
        Whether a text is an import string of what is offered.
    record : str
        Import string of the type of what an import string leads to; "" where it may be anything.
    endings : bool
        Whether the names are endings of files' names: ``.csv``.
    """

    types: tuple[Any, ...] = (str,)
    wanted: str = 'an import string "module:name" is needed'
    imported: bool = True
    record: str = ""
    endings: bool = False


FILE = Answer((str, Path), "a file's path is needed", imported=False)


def hook(answer: Answer) -> Callable[[F], F]:
    """Return what marks a function as a hook that plugins answer with names of such things."""

    def mark(function: F) -> F:
        setattr(function, f"{PROJECT}_answer", answer)
        return _marked(function)

    return mark


def hook_of(record: str, endings: bool = False) -> Callable[[F], F]:
    """Return what marks a hook answered with import strings of things of one type.

    Parameters
    ----------
    record : str
        Import string of the type, which ``tactile-graph plugins --check`` holds them against.
    endings : bool
        Whether their names are endings of files' names.
    """
    return hook(Answer(record=record, endings=endings))


@hook(Answer((str, Callable)))
def tactile_graph_steps() -> Mapping[str, str | Callable[..., Any]]:  # type: ignore[empty-body]
    """Step name -> import string ``"package.module:name"`` (loaded when used), or the step."""


@hook(Answer(wanted="the name of its setting is needed", imported=False))
def tactile_graph_readers() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Source step that reads recordings -> its setting that takes the path, or a list of paths.

    The first offered reads the recordings a command line names; ``--source`` names another.
    """


@hook(Answer((int, float, type(None)), "the seconds a call may take, or None, is needed", False))
def tactile_graph_isolated() -> Mapping[str, float | None]:  # type: ignore[empty-body]
    """Step of this plugin that runs in a process apart -> seconds a call may take; None for ever.

    All that are named share one process. A node that says ``isolated: false`` stays out of it.
    """


@hook(FILE)
def tactile_graph_pipelines() -> Mapping[str, Path]:  # type: ignore[empty-body]
    """Pipeline name -> its YAML file."""


@hook(FILE)
def tactile_graph_pads() -> Mapping[str, Path]:  # type: ignore[empty-body]
    """Pad name -> its YAML file."""


@hook(FILE)
def tactile_graph_presets() -> Mapping[str, Path]:  # type: ignore[empty-body]
    """Device preset name -> its YAML file."""


@hook(FILE)
def tactile_graph_scenes() -> Mapping[str, Path]:  # type: ignore[empty-body]
    """Scene name -> its YAML file."""


@hook_of("tactile_graph.plugins.file_kind:FileKind")
def tactile_graph_file_kinds() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Kind of YAML file (``"pad"``) -> import string of its `FileKind`, for check and schema."""


@hook_of("click:Command")
def tactile_graph_commands() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Command name -> import string of a click command, ``"package.module:name"``."""


@hook_of("tactile_graph.plugins.file_check:FileCheck")
def tactile_graph_checks() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Kind of file -> import string of its `FileCheck`, by which ``check`` looks it through."""


@hook_of("tactile_graph.exporter:Exporter", endings=True)
def tactile_graph_exporters() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Ending of a file's name (``.csv``) -> import string of the `Exporter` by which runs write."""


@hook_of("tactile_graph.many.executor_kind:ExecutorKind")
def tactile_graph_executors() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Name for ``--on`` -> import string of the `ExecutorKind` that works on many frames."""


@hook(Answer(wanted='its unit is needed, or "" where it is its own', imported=False))
def tactile_graph_quantities() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Quantity, what values of an image mean -> its unit as tables print it; "" for none."""


@hook(Answer(wanted="how people write the unit is needed", imported=False))
def tactile_graph_units() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Unit as names of fields and columns end in it (``cm2``) -> as people write it (``cm²``)."""
