"""What the numbers of a value are in that speak of an image, followed along the wires."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from tactile_graph.pipeline.graph import FRAME, Graph, Node, NodeKind
from tactile_graph.pipeline.wiring import Ref, arms, public_fields
from tactile_graph.steps.signature import list_item
from tactile_graph.vocabulary import QUANTITIES
from tactile_graph.wires import Frame, Image

ByFrame = Mapping[str, str]
"""A quantity by that of the frame: "" where nobody knows it, none where there is no value. Empty
where nobody knows it of any frame."""


class Told(NamedTuple):
    """The quantities of a value.

    Attributes
    ----------
    image : mapping of str to str
        Of the image that it is. Nobody knows what a step makes of readings unless it promises it.
    measured : mapping of str to str
        Of the image that it is measured on, where it is a record whose class names such numbers
        (``image_unit``): the step's own, or those that came to it.
    """

    image: ByFrame
    measured: ByFrame

    def of(self, kind: Any) -> ByFrame:
        """Return that of the numbers which a type names."""
        return self.image if _is_image(kind) else self.measured


UNKNOWN = Told({}, {})


Known = dict[tuple[int, Ref], Told]


def told_of(graph: Graph, ref: Ref, known: Known | None = None) -> Told:
    """Return the quantities of the value at a reference; of its items where it is a list.

    ``known`` are those found before, so that each is followed once where wires meet again.
    """
    known = {} if known is None else known
    place = id(graph), ref
    if place not in known:
        known[place] = _told_of(graph, ref, known)
    return known[place]


def _told_of(graph: Graph, ref: Ref, known: Known) -> Told:
    if ref.node == FRAME:
        same = {quantity: quantity for quantity in QUANTITIES}
        return Told(same, same)
    node = graph.nodes[ref.node]
    if node.choices:
        return _of_choices(graph, node, [_further(choice, ref) for choice in node.choices], known)
    if node.kind is NodeKind.MAP and node.inner is not None:
        return _of_each(graph, node, node.inner, ref, known)
    if node.kind is NodeKind.GIVEN:
        return UNKNOWN
    promised = node.facts.by_frame
    settled = any(promised.values()) or _is_image(_kind_at(graph, Ref(ref.node)))
    measured = promised if settled else _read(graph, node, known)
    if ref.whole:
        return Told(promised, measured)
    if _is_measured_view(graph, ref):
        return Told(measured, measured)
    *_, last = (*ref.path, *ref.item_path)
    return Told(promised if last in node.facts.views else {}, measured)


def _read(graph: Graph, node: Node, known: Known) -> ByFrame:
    """Return the quantity of the images that a node reads, where all are in one."""
    refs = [r for b in node.inputs if _speaks_of_images(b.port.type) for r in b.refs]
    found = (told_of(graph, ref, known) for ref in refs)
    kinds = [_kind_at(graph, ref) for ref in refs]
    return _agreed(
        (told.of(kind) for told, kind in zip(found, kinds, strict=True)), node.facts.by_frame
    )


def _of_choices(graph: Graph, node: Node, refs: Sequence[Ref], known: Known) -> Told:
    """Return the quantities of the first of several that has a value, where all agree."""
    told, here = [told_of(graph, ref, known) for ref in refs], node.facts.by_frame
    images = [
        one.image for one, ref in zip(told, refs, strict=True) if _is_image(_kind_at(graph, ref))
    ]
    return Told(
        _agreed(images, here) if images else {},
        _agreed((one.measured for one in told), here),
    )


def _of_each(graph: Graph, node: Node, inner: Graph, ref: Ref, known: Known) -> Told:
    """Return the quantities of what a pipeline gives that runs for each item of a list."""
    names = {name.replace(".", "_"): output for name, output in inner.outputs.items()}
    path = ref.path
    if len(names) > 1:
        if not path:
            return UNKNOWN
        names, path = {path[0]: names[path[0]]}, path[1:]
    (output,) = names.values()
    found = told_of(inner, _further(output, Ref(ref.node, path, ref.item_path)), known)
    frames = node.inputs[0].refs[0]
    outer = told_of(graph, frames, known).of(_kind_at(graph, frames))
    image, measured = (
        {q: its.get(of, "") if of else "" for q, of in outer.items()} for its in found
    )
    return Told(image, measured)


def _further(ref: Ref, within: Ref) -> Ref:
    """Return where the path of another reference leads from a value on."""
    return Ref(ref.node, (*ref.path, *within.path), (*ref.item_path, *within.item_path))


def _agreed(told: Iterable[ByFrame], here: ByFrame) -> ByFrame:
    """Return what all say for the frames for which a node has a value; "" where they differ."""
    several = [*told]
    if not all(several):
        return dict.fromkeys(here, "")
    found = {q: {one[q] for one in several if q in one} for q in here}
    return {q: names.pop() if len(names) == 1 else "" for q, names in found.items()}


# -- types -------------------------------------------------------------------------------------


def _is_image(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, Image | Frame)


def _speaks_of_images(kind: Any) -> bool:
    """Return whether values of a type are images, or hold numbers or views of one."""
    if (item := list_item(kind)) is not None:
        return _speaks_of_images(item)
    return any(
        _speaks_of_images(arm) if list_item(arm) is not None else _is_image(arm) or _measured(arm)
        for arm in arms(kind)
    )


def _measured(kind: Any) -> bool:
    return bool(getattr(kind, "image_unit", ())) or Image in getattr(kind, "provides", {})


def _kind_at(graph: Graph, ref: Ref) -> Any:
    """Return the type of the value at a reference, or of its items where it is a list."""
    kind = graph.type_of(Ref(ref.node, ref.path))
    item = list_item(kind)
    kind = _known(kind if item is None else item)
    for name in ref.item_path:
        kind = _known(public_fields(kind).get(name, Any))
    return kind


def _known(kind: Any) -> Any:
    """Return the first arm of a type that is a value's."""
    return next((arm for arm in arms(kind) if arm is not type(None)), kind)


def _is_measured_view(graph: Graph, ref: Ref) -> bool:
    """Return whether a record is seen as the image that it is measured on."""
    *rest, last = (*ref.path, *ref.item_path)
    n = len(ref.path)
    owner = _kind_at(graph, Ref(ref.node, tuple(rest[:n]), tuple(rest[n:])))
    views = getattr(owner, "provides", {}).values()
    return bool(getattr(owner, "image_unit", ())) and last in views
