"""``Subject``: a registered step that can be fed with points, a mask or an image."""

from __future__ import annotations

import types
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Union, get_args, get_origin

from tactile_graph.errors import TactileGraphError, UsageError
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.signature import Kind, Port, Signature
from tactile_graph.wires import Circle, Ellipse, Image, Mask, Points, Polygon, Rectangle

FEEDS: dict[str, type] = {"points": Points, "mask": Mask, "image": Image}

KINDS = (
    "circle", "ellipse", "rectangle", "hull", "orientation", "points",
    "mask", "decouple", "restore", "image",
)  # fmt: skip
"""What a step is stressed as: by what it takes and gives."""

SUPPLIERS = {"Orientation": "orientation", "Polygon": "hull", "Ellipse": "fit_ellipse"}
"""Types that no case brings, and the step that makes one of what the case does bring."""

TURNING = "rotate_points"
"""Makes the points for steps that take points beside an axis: those want them turned along it."""

OWN_FRAME = ("rotate_points", "rotate_mask", "shape_decision")
"""Steps whose answer does not turn with the input: they turn it to its axis, or go along an outline
from its leftmost corner."""


@dataclass(frozen=True)
class Subject:
    """A step and how it is fed.

    Parameters
    ----------
    name : str
        The step's.
    feed : str
        What a case brings: ``points``, ``mask`` or ``image``.
    kind : str
        One of `KINDS`.
    wires : dict of str to str
        For each port what it is wired to: a feed's name or a supplying step's.
    plugin : str
        Who offers the step.
    signature : Signature
        Its ports and settings.
    """

    name: str
    feed: str
    kind: str
    wires: dict[str, str]
    plugin: str
    signature: Signature

    @property
    def suppliers(self) -> list[str]:
        """The steps that make what the case itself does not bring."""
        made = {w for w in self.wires.values() if w in (*SUPPLIERS.values(), TURNING)}
        return sorted(made | ({"orientation"} if TURNING in made else set()))

    @property
    def label(self) -> str:
        """The step's name, with the feed where it may take another one too."""
        takes_other = self.feed == "mask" and fits(self.signature.ports[0], "points")
        return f"{self.name} (mask)" if takes_other else self.name

    @property
    def lengths(self) -> dict[str, float]:
        """Settings that are lengths by their name, with their defaults: they scale as points do.

        A default of None may stand for a length, too, which the step tells by an attribute.
        """
        told: Mapping[str, float] = getattr(self.signature.target, "usual_cm", {})
        return {
            s.name: float(told.get(s.name, s.default))
            for s in self.signature.settings
            if s.name in told or (s.name.endswith("_cm") and isinstance(s.default, (int, float)))
        }


class Left(NamedTuple):
    """A step that is not stressed, who offers it, and why it is not."""

    name: str
    plugin: str
    why: str

    def __str__(self) -> str:
        return f"step {self.name!r} cannot be stressed: {self.why}"


def subjects(registry: Registry) -> tuple[list[Subject], list[Left]]:
    """Return what can be stressed, in the order of `KINDS`, and what cannot."""
    found: list[Subject] = []
    left: list[Left] = []
    for name in registry.names("steps"):
        plugin = registry.offer("steps", name).plugin.name
        try:
            signature = registry.step(name)
        except TactileGraphError as error:
            left.append(Left(name, plugin, str(error)))
            continue
        mine, why = _of(name, signature, plugin, registry)
        found += mine
        if not mine:
            left.append(Left(name, plugin, why))
    return sorted(found, key=lambda s: KINDS.index(s.kind)), left


def chosen(
    found: list[Subject], wanted: tuple[str, ...], left: Sequence[Left] = ()
) -> tuple[list[Subject], list[Left]]:
    """Return the subjects of the wanted steps, kinds or plugins, and which of these are left out.

    All of both if nothing is named.

    Raises
    ------
    UsageError
        If a name is none of these.
    """
    from tactile_graph.errors import did_you_mean, one_of

    known = {s.name for s in found} | {s.kind for s in found} | {s.plugin for s in found}
    apart = {one.name for one in left} | {one.plugin for one in left}
    for name in wanted:
        if name not in known | apart:
            hint = did_you_mean(name, known) or f"; kinds: {one_of(KINDS)}"
            raise UsageError(f"no step, kind or plugin named {name!r} can be stressed{hint}")
    names = set(wanted)
    return (
        [s for s in found if not names or names & {s.name, s.kind, s.plugin}],
        [one for one in left if not names or names & {one.name, one.plugin}],
    )


def _of(
    name: str, signature: Signature, plugin: str, registry: Registry
) -> tuple[list[Subject], str]:
    if signature.kind is Kind.SOURCE:
        return [], "a source"
    if any(s.required for s in signature.settings):
        return [], f"needs its setting {next(s.name for s in signature.settings if s.required)!r}"
    found = []
    why = "has no ports"
    for feed in FEEDS:
        wires, why = _wires(signature, feed, registry)
        if wires:
            kind = _kind(signature, feed)
            found.append(Subject(name, feed, kind, wires, plugin, signature))
    if len(found) > 1 and {s.feed for s in found} == {"mask", "image"}:
        found = [s for s in found if s.feed == "image"]  # a mask is an image of zeros and ones
    return found, why


def _wires(signature: Signature, feed: str, registry: Registry) -> tuple[dict[str, str], str]:
    wires: dict[str, str] = {}
    for port in signature.ports:
        if not port.required and not _axis(port):
            continue
        supplier = "orientation" if _axis(port) else SUPPLIERS.get(_name(port.type), "")
        if fits(port, feed):
            wires[port.name] = feed
        elif feed == "image" and fits(port, "mask"):
            wires[port.name] = "mask"
        elif _supplied(supplier, feed, registry):
            wires[port.name] = supplier
        elif not port.required:
            continue
        else:
            return {}, f"nothing here makes its port {port.name!r}"
    if not set(wires.values()) & {feed, *SUPPLIERS.values()}:
        return {}, f"takes no {feed}"
    beside_axis = signature.name not in OWN_FRAME and all(p.required for p in signature.ports)
    if feed == "points" and beside_axis and "orientation" in wires.values():
        wires = {p: TURNING if w == feed else w for p, w in wires.items()}
    return wires, ""


def _axis(port: Port) -> bool:
    """Return whether a port takes an axis, needed or not."""
    return any(_name(kind) == "Orientation" for kind in (get_args(port.type) or (port.type,)))


def _name(kind: Any) -> str:
    return str(getattr(kind, "__name__", ""))


def _supplied(supplier: str, feed: str, registry: Registry) -> bool:
    """Return whether there is a step that makes what a port needs of what a case brings."""
    return (
        bool(supplier)
        and registry.has("steps", supplier)
        and fits(registry.step(supplier).ports[0], feed)
    )


def fits(port: Port, feed: str) -> bool:
    """Return whether a port takes what a feed brings."""
    union = get_origin(port.type) in (Union, types.UnionType)
    return FEEDS[feed] in (get_args(port.type) if union else (port.type,))


def _kind(signature: Signature, feed: str) -> str:
    out = signature.output
    if feed == "points":
        for kind, shape in (
            ("circle", Circle), ("ellipse", Ellipse), ("rectangle", Rectangle), ("hull", Polygon),
        ):  # fmt: skip
            if isinstance(out, type) and issubclass(out, shape):
                return kind
        return "orientation" if "angle_rad" in _fields(out) else "points"
    if feed == "mask":
        return "mask"
    quantity = signature.output_quantity
    if out is Image and quantity is not None and quantity.names == ("siemens",):
        return "decouple"
    fields = _fields(out)
    restores = {"image", "mean"} & set(fields) and signature.port("region") is not None
    return "restore" if restores else "image"


def _fields(out: Any) -> tuple[str, ...]:
    return tuple(getattr(out, "_fields", ()))
