"""Arrays that lie in memory which their step can go on writing into are copied; no others are.

To make a view read-only says nothing of the array that it is a view of.
"""

from __future__ import annotations

from collections.abc import Callable
from sys import getrefcount
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.image import Image, Mask, packed_mask
from tactile_graph.wires.points import Points
from tactile_graph.wires.shapes import Polygon

Array = NDArray[Any]
Call = Callable[..., Any]


def own_array(array: Array) -> Array:
    """Return an array itself, or a read-only copy where it lies in another's that may change."""
    if array.base is None or not _changes(array):
        return array
    own = array.copy("K")
    own.setflags(False)  # type: ignore[call-arg]
    return own


def _changes(view: Any) -> bool:
    """Return whether memory that a view lies in can be written into by somebody who holds it."""
    while (base := getattr(view, "base", None)) is not None:
        if isinstance(base, memoryview):
            return not base.readonly
        open_ = not isinstance(base, np.ndarray) or base.flags.writeable
        del base  # or it would count
        if open_ and _holders(view) > _ALONE:
            return True
        view = view.base
    return False


def _holders(view: Any) -> int:
    return getrefcount(view.base)


_ALONE = _holders(np.empty(2)[:1])
"""What Python counts where the view is the only one that holds what it lies in."""


def _image(value: Image) -> Image:
    values, valid = value.values, value.valid
    own, own_valid = own_array(values), None if valid is None else own_array(valid)
    if own is values and own_valid is valid:
        return value
    return Image(own, value.pitch_cm, value.origin_cm, value.quantity, own_valid)


def _mask(value: Mask) -> Mask:
    words = value.words
    if words is not None:
        own = own_array(words)
        if own is words:
            return value
        return packed_mask(own, value.shape[1], value.pitch_cm, value.origin_cm, value.count)
    cells = value.values
    own_cells = own_array(cells)
    if own_cells is cells:
        return value
    return Mask(own_cells, value.pitch_cm, value.origin_cm, value._count)


def _points(value: Points) -> Points:
    own = own_array(value.xy_cm)
    return value if own is value.xy_cm else Points(own)


def _polygon(value: Polygon) -> Polygon:
    own = own_array(value.xy_cm)
    return value if own is value.xy_cm else Polygon(own)


OWN: dict[type, Callable[[Any], Any]] = {
    Image: _image,
    Mask: _mask,
    Points: _points,
    Polygon: _polygon,
}
"""By the type of a wire that holds arrays, what returns it with arrays of its own."""


def detached(call: Call) -> Call:
    """Return a step that gives wires whose arrays it does not go on writing into.

    What it was given and hands on is left as it is: whoever gave it answers for it.
    """

    def detaching(*args: Any, **kwargs: Any) -> Any:
        value = call(*args, **kwargs)
        of_its_own = OWN.get(value.__class__)
        if of_its_own is None:
            return value
        own = of_its_own(value)
        if own is value or any(value is given for given in (*args, *kwargs.values())):
            return value
        return own

    return detaching
