"""What the values of an image mean: the quantities that plugins offer, and their units."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any

from tactile_graph.errors import did_you_mean, one_of
from tactile_graph.vocabulary import QUANTITIES


def is_quantity(name: str) -> bool:
    """Return whether somebody offers a quantity of that name."""
    return name in QUANTITIES


def unit_of(quantity: str) -> str:
    """Return the unit of a quantity's values; the quantity itself where that is its own unit."""
    return QUANTITIES.get(quantity) or quantity


def unknown_quantity(names: Iterable[str]) -> str:
    """Return what is wrong with the first of the names that nobody offers; "" if all are known."""
    for name in names:
        if name not in QUANTITIES:
            known = list(QUANTITIES)
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
        return tuple(QUANTITIES)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_after_validator_function(checked_quantity, handler(source))

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        return {**handler(schema), "enum": list(self.choices())}


QuantityName = Annotated[str, OneOfQuantities()]
"""The type of a setting, or of a field, that names a quantity."""
