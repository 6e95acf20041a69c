"""What authors of plugins get wrong, in words that say where and what to do."""

from __future__ import annotations

import importlib
import traceback
from collections.abc import Iterable
from importlib.metadata import distributions
from inspect import isroutine
from pathlib import Path
from types import ModuleType

import pluggy

from tactile_graph.errors import PluginError, did_you_mean, one_of, text_of

_PASSED = tuple(str(Path(str(f)).parent) for f in (__file__, importlib.__file__, pluggy.__file__))
"""Where frames that lead to a plugin's code lie."""


def why(error: BaseException) -> str:
    """Return an error that importing raised: type, text in one line, and file and line."""
    text = " ".join(text_of(error).split())
    if not isinstance(error, ImportError | PluginError | pluggy.PluginValidationError) or not text:
        text = f"{type(error).__name__}: {text}".removesuffix(": ")
    where = "" if isinstance(error, SyntaxError) else _where(error)
    return f"{text} ({where})" if where else text


def _where(error: BaseException) -> str:
    """Return file and line of the last frame that is neither ours nor the import system's."""
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        if not frame.filename.startswith(("<", *_PASSED)):
            return f"{frame.filename}:{frame.lineno}"
    return ""


def stale(error: BaseException, package: str) -> str:
    """Return what to do about an entry point whose module is not there; "" for other errors."""
    if isinstance(error, ModuleNotFoundError) and not _where(error):
        return f"; its entry point is stale: install {package} again, or uninstall it"
    return ""


def check_hooks(module: ModuleType, known: Iterable[str], project: str, sure: bool) -> None:
    """Refuse a hook that nobody would ask: misspelt, or without its mark.

    Parameters
    ----------
    module : module
    known : iterable of str
        All hooks there are.
    project : str
    sure : bool
        Whether these are all: a hook that nobody knows may be one of a plugin that is not there.

    Raises
    ------
    PluginError
    """
    hooks = sorted(known)
    for attribute, value in vars(module).items():
        mark = getattr(value, f"{project}_impl", None) if isroutine(value) else None
        name = (mark and mark["specname"]) or attribute
        if not name.startswith(f"{project}_") or not callable(value):
            continue
        marked = hasattr(value, f"{project}_impl")
        optional = mark and mark["optionalhook"]  # pluggy's word for a hook that may not be there
        if marked and name not in hooks and sure and not optional:
            hint = did_you_mean(name, hooks) or f"; hooks: {one_of(hooks)}"
            raise PluginError(f"unknown hook {name!r}{hint}")
        if name in hooks and not marked:
            raise PluginError(f"{name} lacks @hookimpl, so nobody asks it")


def near_groups(group: str) -> list[str]:
    """Return words about each package that has entry points in a group named much like ours."""
    found = []
    near = (group, f"{group}_plugin", f"{group}_step")
    for dist in distributions():
        for entry in dist.entry_points:
            alike = entry.group.lower().replace("-", "_").replace(".", "_").removesuffix("s")
            if entry.group != group and alike in near:
                found.append(
                    f"package {dist.name} has its entry point {entry.name!r} in the group "
                    f"{entry.group!r}; the group is {group!r}"
                )
    return sorted(set(found))
