"""What a call hands in beside frames, told in words where it is of the wrong type."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from operator import index
from typing import Any

from tactile_graph.errors import UsageError, shown


def checked_text(text: Any) -> str:
    """Return a pipeline's text.

    Raises
    ------
    UsageError
        If it is none.
    """
    if not isinstance(text, str):
        got, hint = type(text).__name__, ""
        if isinstance(text, bytes):
            hint = "; .decode() makes text of it"
        elif isinstance(text, Mapping):
            hint = "; yaml.safe_dump() makes text of it"
        raise UsageError(f"loads() takes a pipeline's YAML as text, got {got}{hint}")
    return text


def checked_names(only: Any) -> tuple[str, ...]:
    """Return the names asked for, each once; one by itself is no sequence of letters.

    Raises
    ------
    UsageError
        If they are no texts.
    """
    if only is None:
        return ()
    names = (only,) if isinstance(only, str) else only
    if not isinstance(names, Iterable) or isinstance(names, bytes):
        raise UsageError(f"only: names of nodes or outputs are needed, got {shown(only)}")
    names = tuple(names)
    for name in names:
        if not isinstance(name, str):
            raise UsageError(f"only: names are texts, got {shown(name)}")
    return tuple(dict.fromkeys(names))


def checked_seed(seed: Any) -> int:
    """Return a seed.

    Raises
    ------
    UsageError
        If it is no whole number.
    """
    try:
        return index(seed)
    except TypeError:
        raise UsageError(f"seed: must be a whole number >= 0, got {shown(seed)}") from None


def checked_settings(settings: Any) -> Mapping[str, Any]:
    """Return settings by name.

    Raises
    ------
    UsageError
        If they are none.
    """
    if not isinstance(settings, Mapping):
        raise UsageError(
            f"settings must be a mapping {{'node.setting': value}}, got {shown(settings)}"
        )
    for name in settings:
        if not isinstance(name, str):
            raise UsageError(f"settings: names are texts, 'node.setting', got {shown(name)}")
    return settings


def checked_step(step: Any) -> str:
    """Return the name of a source.

    Raises
    ------
    UsageError
        If it is none.
    """
    if not isinstance(step, str):
        raise UsageError(f"a source is named by a text, got {shown(step)}; frames go to stream()")
    return step
