"""Values for a step's ports: of a case, or made of it by the steps on offer that give such."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import reduce
from typing import Any, get_origin
from weakref import WeakKeyDictionary

import numpy as np

from tactile_graph.errors import TactileGraphError
from tactile_graph.pipeline.wiring import Ref, arms, assignable, fit, public_fields
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.settings import validate_settings
from tactile_graph.steps.signature import Kind, Port, Signature, list_item, type_name
from tactile_graph.testing.cases import Case
from tactile_graph.wires import (
    Circle,
    Ellipse,
    Frame,
    Image,
    Mask,
    Points,
    Polygon,
    Rectangle,
    TrueObject,
)

DEEPEST = 3
"""How many steps may stand one before the other to make a value."""
Maker = Callable[[Case], Any]
_made: WeakKeyDictionary[Any, dict[tuple[Any, ...] | None, bytes]] = WeakKeyDictionary()
"""What steps made, packed, by what it was made of; several steps may take the same."""


class Unmakeable(Exception):  # noqa: N818 -- what became of a value
    """No value can be made for a port, and why; ``case`` where only this one is to blame."""

    def __init__(self, why: str, case: bool = False) -> None:
        super().__init__(why)
        self.case = case


@dataclass(frozen=True)
class Makers:
    """Makes values of wire types.

    Parameters
    ----------
    registry : Registry
        Whose steps make the types that only plugins know.
    given : mapping of str to callable
        An author's own makers, by port: what they return for a `Case` goes in.
    """

    registry: Registry
    given: Mapping[str, Maker]

    def maker(self, port: Port, quantity: str, but: str) -> Maker:
        """Return what makes a port's value of a case.

        Parameters
        ----------
        port : Port
        quantity : str
            Of images, where the port does not ask for another.
        but : str
            Name of the step whose port it is: no value is made by itself.

        Raises
        ------
        Unmakeable
            If nothing on offer gives such a value.
        """
        if port.name in self.given:
            return self.given[port.name]
        names = port.quantity.names if port.quantity is not None else ()
        wanted = quantity if not names or quantity in names else names[0]
        for arm in arms(port.type):
            made = self._of(arm, wanted, (but,))
            if made is not None:
                return made
        raise Unmakeable(f"no step on offer gives a {type_name(port.type)} for {port.name!r}")

    def _of(self, kind: Any, quantity: str, but: tuple[str, ...]) -> Maker | None:
        if kind is Image:
            return lambda case: case.image(quantity)
        made = _PLAIN.get(kind) or (_frame(quantity) if kind is Frame else None)
        if made is not None:
            return made
        item = list_item(kind)
        found = None if kind is type(None) else self._given_by_a_step(kind, quantity, but)
        if found is None and item is not None:
            kinds = [a for a in arms(item) if a is not type(None)]
            one = self._of(Circle if kinds[0] is Any else kinds[0], quantity, but)
            found = None if one is None else (lambda case, one=one: (one(case),))
        return found

    def _given_by_a_step(self, kind: Any, quantity: str, but: tuple[str, ...]) -> Maker | None:
        if len(but) > DEEPEST or list_item(kind) is Any or kind is Any:
            return None
        for signature in self._steps():
            path = _path(signature.output, kind)
            if signature.name in but or path is None:
                continue
            try:
                makers = {
                    p.name: self._port(p, quantity, (*but, signature.name))
                    for p in signature.ports
                    if p.required
                }
            except Unmakeable:
                continue
            return _through(signature, makers, path, quantity)
        return None

    def _port(self, port: Port, quantity: str, but: tuple[str, ...]) -> Maker:
        for arm in arms(port.type):
            made = self._of(arm, quantity, but)
            if made is not None:
                return made
        raise Unmakeable(port.name)

    def _steps(self) -> list[Signature]:
        """Return the steps that need nothing but ports, those with the fewest first."""
        found = []
        for name in self.registry.names("steps"):
            try:
                signature = self.registry.step(name)
            except TactileGraphError:
                continue
            plain = not any(s.required for s in signature.settings)
            if plain and signature.ports and not signature.stateful and not signature.rng:
                found.append(signature)
        return sorted(found, key=lambda s: (len(s.ports), s.name))


def _path(given: Any, wanted: Any) -> tuple[str, ...] | None:
    """Return by which attributes an output gives a wanted type; () where it is one."""
    if get_origin(given) is None and given is Any:
        return None
    ref = fit(Ref("output"), given, wanted)
    if ref is not None:
        return None if ref.item_path else ref.path
    found = [n for n, kind in public_fields(given).items() if kind is not Any]
    for name in found:
        if assignable(public_fields(given)[name], wanted):
            return (name,)
    return None


def _through(
    signature: Signature, makers: Mapping[str, Maker], path: tuple[str, ...], quantity: str
) -> Maker:
    """Return what has a step make values; of the same inputs once, copies of it from then on."""
    settings = signature.arguments(validate_settings(signature, {})[0])
    target = signature.target
    try:
        known = _made.setdefault(target, {})
    except TypeError:  # a callable that has no hash
        known = {}

    def make(case: Case) -> Any:
        inputs = {name: maker(case) for name, maker in makers.items()}
        key: tuple[Any, ...] | None = None
        with suppress(Exception):  # of what cannot be pickled each value is made anew
            key = (path, pickle.dumps((inputs, case.number)))
        if key in known:
            return pickle.loads(known[key])
        try:
            with np.errstate(all="ignore"):
                if signature.kind is Kind.CLASS:
                    value = target(**settings)(**inputs)
                else:
                    value = target(**inputs, **settings)
        except Exception as error:
            raise Unmakeable(f"{signature.name} gives none: {error}", case=True) from None
        made = spoiled(reduce(getattr, path, value), case.number)
        if key is not None:
            with suppress(Exception):  # what cannot be pickled is told when that step is tried
                known[key] = pickle.dumps(made)
        return made

    return make


def spoiled(value: Any, number: float | None) -> Any:
    """Return a record with all its floats another number; other values as they are."""
    if number is None:
        return value
    if hasattr(value, "_replace"):
        floats = [n for n in value._fields if isinstance(getattr(value, n), float)]
        return value._replace(**dict.fromkeys(floats, number))
    if isinstance(value, tuple | list):
        return tuple(spoiled(v, number) for v in value)
    if not is_dataclass(value) or isinstance(value, type):
        return value
    changed: dict[str, Any] = {}
    for field in fields(value):
        if not field.init or field.name.startswith("_"):
            continue
        old = getattr(value, field.name)
        if isinstance(old, float) and not isinstance(old, bool):
            changed[field.name] = number
        elif isinstance(old, np.ndarray) and old.dtype.kind == "f" and "xy" in field.name:
            changed[field.name] = np.full_like(old, number)
    try:
        return replace(value, **changed)
    except Exception as error:  # a record that refuses such numbers
        raise Unmakeable(f"{type(value).__name__} refuses {number}: {error}", case=True) from None


# -- the closed vocabulary -------------------------------------------------------------------


def _frame(quantity: str) -> Maker:
    return lambda case: Frame(
        case.image(quantity), 0, 0.0, (TrueObject(Circle(*_lengths(case)), 100.0, "disc"),)
    )


def _lengths(case: Case) -> tuple[float, float, float]:
    """Return x, y and size of the first object of the ordinary case on this case's pitch."""
    x_cm, y_cm = case.pitch_cm
    return 3.4 * x_cm, 3.1 * y_cm, 2.3 * (x_cm * y_cm) ** 0.5


def _circle(case: Case) -> Any:
    return spoiled(Circle(*_lengths(case)), case.number)


def _ellipse(case: Case) -> Any:
    x, y, r = _lengths(case)
    return spoiled(Ellipse(x, y, 1.3 * r, 0.8 * r, 0.4), case.number)


def _rectangle(case: Case) -> Any:
    x, y, r = _lengths(case)
    return spoiled(Rectangle(x, y, 2.2 * r, 1.4 * r, 0.4), case.number)


def _polygon(case: Case) -> Any:
    xy = case.xy_cm.copy()
    xy.setflags(write=False)
    return Polygon(xy)


_PLAIN: dict[Any, Maker] = {
    Mask: Case.mask,
    Points: Case.points,
    Circle: _circle,
    Ellipse: _ellipse,
    Rectangle: _rectangle,
    Polygon: _polygon,
}
