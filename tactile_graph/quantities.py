"""What the values of an image mean, and in which unit: the quantities that plugins offer.

A quantity means the same wherever it is named, so there is one table for the process. Registries
enter what their plugins offer; whoever asks for a name before there is any has the installed
plugins found.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pkgutil import resolve_name
from types import MappingProxyType
from typing import Annotated, Any

from tactile_graph.errors import did_you_mean, one_of

_INSTALLED = "tactile_graph.plugins.registry:installed"
"""By import string, as plugins name what they offer: the registry knows steps, and they these."""
_units: dict[str, str] = {}
_asking = False


def enter(quantity: str, unit: str) -> None:
    """Make a quantity known; ``unit`` is empty where the quantity is its own unit."""
    _units[quantity] = unit


def quantities() -> Mapping[str, str]:
    """Return every quantity that is known, with its unit, those of the installed plugins too."""
    global _asking
    if not _asking:  # a plugin may ask while it is found
        _asking = True
        try:
            resolve_name(_INSTALLED)()
        finally:
            _asking = False
    return MappingProxyType(_units)


def is_quantity(name: str) -> bool:
    """Return whether somebody offers a quantity of that name."""
    return name in _units or name in quantities()


def unit_of(quantity: str) -> str:
    """Return the unit of a quantity's values; the quantity itself where that is its own unit."""
    unit = _units.get(quantity)
    return (quantities().get(quantity) if unit is None else unit) or quantity


def unknown_quantity(names: Iterable[str]) -> str:
    """Return what is wrong with the first of the names that nobody offers; "" if all are known."""
    for name in names:
        if not is_quantity(name):
            known = list(quantities())
            hint = did_you_mean(name, known) or f"; there are: {one_of(known, len(known))}"
            return f"unknown quantity {name!r}{hint}"
    return ""


def checked_quantity(name: str) -> str:
    """Return a name that is a quantity's.

    Raises
    ------
    ValueError
        If it is none.
    """
    if unknown := unknown_quantity([name]):
        raise ValueError(unknown)
    return name


class OneOfQuantities:
    """Beside ``str`` in an annotation: the text is a quantity's name, of whichever plugin."""

    def choices(self) -> tuple[str, ...]:
        """Return all that the text may be."""
        return tuple(quantities())

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_after_validator_function(checked_quantity, handler(source))

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        return {**handler(schema), "enum": list(self.choices())}


QuantityName = Annotated[str, OneOfQuantities()]
"""The type of a setting, or of a field, that names a quantity."""
