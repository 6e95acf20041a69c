"""Step ``correct_readings``: readings as a learned pad's file says they should be."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import RuleError
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import require_finite


class CorrectReadings:
    """Take off each element's offset, divide by its gain, and make what is no good invalid.

    Parameters
    ----------
    pad : str or mapping
        A file that ``tactile-graph learn-pad`` has written.
    keep_stuck : bool
        Whether stuck elements keep what they read: before ``decouple`` or a localiser that
        decouples, as they pull on their column whether anybody believes them or not. The step
        once more behind ``force`` makes them invalid.

    Raises
    ------
    UsageError
        If the pad was not learned from recordings.
    DataError
        If its table of elements cannot be read.

    Notes
    -----
    Offsets belong to images of the quantity that was recorded, gains to that or to grams, as the
    file says; an image gets what belongs to its quantity. Dead, stuck, noisy and missing elements
    become invalid in either, and in siemens and grams made of volts or counts. Readings below the
    offset stay negative.
    """

    stateless = True

    def __init__(self, *, pad: str | dict[str, Any], keep_stuck: bool = False) -> None:
        from tactile_graph_pads.pad import learned_of

        learned = learned_of(pad)
        self._learned, table = learned, learned.table
        self._reading, self._gain_of = learned.reading, learned.gain_of
        stuck = table.state == "stuck"
        self._good: NDArray[np.bool_] = table.good | stuck if keep_stuck else table.good
        self._all_good = bool(self._good.all())
        self._offset, self._gain = np.where(stuck, 0.0, table.offset), table.gain
        self._known = {self._reading, self._gain_of}
        if self._reading in ("volt", "counts"):
            self._known |= {"siemens", "gram"}

    def __call__(
        self, image: Image
    ) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
        """Return the corrected image.

        Raises
        ------
        RuleError
            If the image has another shape or pitch than the pad, or a quantity the pad says
            nothing of.
        DataError
            If a valid cell holds NaN or infinity.
        """
        if image.shape != self._good.shape:
            rows, columns = self._good.shape
            raise RuleError(f"the pad has {rows} x {columns} elements, got {image.shape}")
        self._learned.require_pitch(image)
        if image.quantity not in self._known:
            raise RuleError(
                f"the pad was learned from {self._reading}, got {image.quantity}: put this step "
                "before what converts"
            )
        require_finite(image)
        values = np.asarray(image.values, np.float64)
        if image.quantity == self._reading:
            values = values - self._offset
        if image.quantity == self._gain_of:
            values = values / self._gain
        if self._all_good and image.valid is None:
            return image.with_values(values)
        valid = self._good if image.valid is None else self._good & image.valid
        return image.with_values(np.where(valid, values, 0.0), valid=valid.copy())
