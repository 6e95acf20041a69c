"""Settings that steps share: a dataclass of them, whose fields a step takes like its own."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from typing import Any, get_type_hints

from tactile_graph.docstring import parameters
from tactile_graph.errors import PluginError


@dataclass(frozen=True, slots=True)
class Spread:
    """Marks a parameter that is a dataclass of settings; in YAML its fields are the step's own.

    ::

        def fit(
            points: Points, *, robust: bool = False, common: Annotated[Common, Spread()] = Common()
        ) -> Circle: ...

    Those named are settings, in that order, all where none is named; the others stay as the
    parameter's default has them, or else the dataclass.
    """

    names: tuple[str, ...] = ()

    def __init__(self, *names: str) -> None:
        object.__setattr__(self, "names", names)


@dataclass(frozen=True)
class Record:
    """The dataclass behind a `Spread`: the parameter it is handed to, and what it is by default."""

    parameter: str
    type: type
    default: Any = MISSING

    def made(self, given: Mapping[str, Any]) -> Any:
        """Return the dataclass with some fields given, the others by default."""
        if self.default is MISSING:
            return self.type(**given)
        kept = {f.name: getattr(self.default, f.name) for f in fields(self.type) if f.init}
        return type(self.default)(**(kept | dict(given)))

    def meaning(self, name: str) -> str:
        """Return what the dataclass's docstring says of a field, or that of one it inherits."""
        documented = (parameters(inspect.cleandoc(c.__doc__ or "")) for c in self.type.__mro__)
        return next((found[name] for found in documented if name in found), "")


def spread(
    step: str, parameter: inspect.Parameter, kind: Any, marker: Spread
) -> tuple[Record, list[tuple[str, Any, Any]]]:
    """Return a parameter's record, and name, annotation and default of each of its settings.

    Raises
    ------
    PluginError
        If the parameter's type is no dataclass, or has no field of a name.
    """
    what = f"step {step!r}: {parameter.name!r}"
    if not (isinstance(kind, type) and is_dataclass(kind)):
        raise PluginError(f"{what} is spread, but its type is no dataclass")
    default = MISSING if parameter.default is parameter.empty else parameter.default
    record = Record(parameter.name, kind, default)
    own = {f.name: f for f in fields(kind) if f.init}
    unknown = [n for n in marker.names if n not in own]
    if unknown:
        raise PluginError(f"{what} spreads {unknown[0]!r}, which {kind.__name__} has not")
    try:
        hints = get_type_hints(kind, include_extras=True)
    except Exception as error:
        message = f"{what}: {kind.__name__}'s annotations cannot be read: {error}"
        raise PluginError(message) from error
    settings = []
    for name in marker.names or own:
        f, value = own[name], parameter.empty
        if default is not MISSING:
            value = getattr(default, name)
        elif f.default is not MISSING:
            value = f.default
        elif f.default_factory is not MISSING:
            value = f.default_factory()
        settings.append((name, hints[name], value))
    return record, settings
