"""Step ``threshold``: the cells at or above a level, fixed or above the frame's own noise."""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Image, Mask, quick_mask
from tactile_graph.wires.stacks import Answered, ImageStack, MaskStack
from tactile_graph_filters.nan import refuse_nan, require_finite
from tactile_graph_filters.thresholds.levelled_masks import LevelledMaskStack
from tactile_graph_filters.thresholds.noise_level import (
    OWN_NOISE,
    LevelledMask,
    is_untold,
    told_level,
)
from tactile_graph_filters.thresholds.recording_level import RecordingLevel, recording_level

BOOL, DOUBLE = np.dtype(np.bool_), np.dtype(np.float64)


@compiled_later
def at_least(values, level, out):  # type: ignore[no-untyped-def]
    """Write into ``out`` where ``values`` reach ``level``; return how many, or -1 if any is NaN."""
    count = numbers = 0
    for i in range(values.shape[0]):
        row, wanted = values[i], out[i]
        for j in range(values.shape[1]):
            wanted[j] = row[j] >= level
            count += row[j] >= level
            numbers += row[j] == row[j]
    return count if numbers == values.size else -1


@compiled_later
def at_least_each(values, level, out, counts):  # type: ignore[no-untyped-def]
    """Do what `at_least` does to each of several frames; ``counts`` takes what it returns."""
    for k in range(values.shape[0]):
        count = numbers = 0
        for i in range(values.shape[1]):
            row, wanted = values[k, i], out[k, i]
            for j in range(values.shape[2]):
                wanted[j] = row[j] >= level
                count += row[j] >= level
                numbers += row[j] == row[j]
        counts[k] = count if numbers == values.shape[1] * values.shape[2] else -1


@compiled_later
def any_at_least(values: NDArray[Any], level: float) -> bool:
    """Return whether any of ``values`` reaches ``level``, or is NaN."""
    for i in range(values.shape[0]):
        row, below = values[i], 0
        for j in range(values.shape[1]):  # without a way out: some instructions for a row
            below += row[j] < level
        if below < values.shape[1]:
            return True
    return False


def footprint(image: Image, level: float) -> Mask:
    """Return the valid cells of ``image`` at or above ``level``.

    Parameters
    ----------
    image : Image
    level : float
        In the image's own unit.

    Returns
    -------
    Mask

    Raises
    ------
    Degenerate
        If no cell is valid.
    DataError
        If a valid cell holds NaN: it is neither on nor off.
    """
    values, valid = image.values, image.valid
    out = np.empty(values.shape, np.bool_)
    count: int | None = at_least.call(values, level, out)
    if valid is not None:
        if not valid.any():
            raise Degenerate("no cell of the image is valid, so it has no footprint")
        np.logical_and(out, valid, out=out)
    if count == -1:
        refuse_nan(image)
    return Mask(out, image.pitch_cm, image.origin_cm, count if valid is None else None)


def footprints(images: ImageStack, level: float) -> Answered:
    """Return the footprints of several frames; those of which `footprint` raises are not done."""
    out = np.empty(images.values.shape, np.bool_)
    counts = np.empty(len(images), np.int64)
    at_least_each.call(images.values, level, out, counts)
    done = counts >= 0
    if images.valid is not None:
        np.logical_and(out, images.valid, out=out)
        done &= images.valid.any(axis=(1, 2))
        counts = out.sum(axis=(1, 2))
    return Answered(MaskStack(out, images.pitch_cm, images.origin_cm, counts), done)


def levelled(image: Image) -> LevelledMask:
    """Return the valid cells above the image's own noise, and the level that this is.

    Raises
    ------
    Degenerate
        If no cell is valid, or there are too few to tell loads from noise.
    DataError
        If a valid cell holds NaN or infinity: no noise is told from either.
    """
    require_finite(image)
    level, above = told_level(image)
    mask = footprint(image, level)
    if mask.count == 0 and is_untold(image):
        raise Degenerate(
            f"{image.values.size} cells, of which some seem to bear a load, are too few to tell it "
            "from the frame's own noise; give level, or noise_of a recording"
        )
    grid = (mask.pitch_cm, mask.origin_cm)
    return LevelledMask(mask.values, *grid, mask.count, level, image.quantity, above)


def levelled_each(images: ImageStack) -> Answered:
    """Return what `levelled` gives of each of several frames; where it raises, it is not done."""
    out, n = np.zeros(images.values.shape, np.bool_), len(images)
    counts, levels, done = np.zeros(n, np.int64), np.zeros(n), np.zeros(n, np.bool_)
    above = [OWN_NOISE] * n
    for i, image in enumerate(images):
        with suppress(Degenerate, DataError):  # told by the step itself
            mask = levelled(image)
            out[i], counts[i], levels[i], done[i] = mask.values, mask.count, mask.level, True
            above[i] = mask.above
    masks = MaskStack(out, images.pitch_cm, images.origin_cm, counts)
    return Answered(LevelledMaskStack(masks, levels, images.quantity, above), done)


def with_level(mask: Mask, recorded: RecordingLevel) -> LevelledMask:
    """Return a mask that says which level, and of which recording, made it."""
    grid, level = (mask.pitch_cm, mask.origin_cm), (recorded.level, recorded.quantity)
    return LevelledMask(mask.values, *grid, mask.count, *level, recorded.told)


class Threshold:
    """Turn on the valid cells at or above a level.

    Parameters
    ----------
    level_v : float, optional
        The level for images in volts; the thesis takes 0.01 V (section 4.1, figure 4.3).
    level : float or 'auto', optional
        The level in the image's own unit, whatever that is. ``auto`` finds one in each frame,
        above the noise that its lower readings show (`noise_level`): the mask then says which.
        Beside ``level_v`` it is for images that are not in volts.
    noise_of : Path or mapping, optional
        A recording, by its file or as settings of the source that reads it: ``auto`` then finds
        one level for all frames, above the noise that the whole recording shows
        (`recording_level`), in its unit.
    above : bool
        Whether a cell must exceed the level instead of reaching it.

    Raises
    ------
    ValueError
        If neither ``level_v`` nor ``level`` is given, or one that is not finite, or ``noise_of``
        without ``level: auto``.

    Notes
    -----
    Thesis section 3.1.1 (Horn 1986, page 47). Invalid cells are never on. What ``auto`` needs is a
    quarter of the cells without a load; where some of few cells (up to 52) seem to bear one and
    none stands out for sure, it says that it cannot tell.
    """

    stateless = True

    def __init__(
        self,
        *,
        level_v: Annotated[float | None, Ge(0)] = None,
        level: float | Literal["auto"] | None = None,
        above: bool = False,
        noise_of: Path | dict[str, Any] | None = None,
    ) -> None:
        if level_v is None and level is None:
            raise ValueError("level_v or level must be given, got neither")
        if noise_of is not None and level != "auto":
            raise ValueError(f"noise_of belongs to level: auto, got level {level}")
        self._above = above
        self._level_v = self._reached(level_v)
        self._other = None if level == "auto" else self._reached(level)
        self.takes = {} if level is not None else {"image": ("volt",)}
        self.takes_by = "level_v"
        self._recorded = None if noise_of is None else recording_level(noise_of)
        if self._recorded is not None:
            self._other = self._reached(self._recorded.level)
            volts = () if level_v is None else ("volt",)
            self.takes = {"image": tuple({self._recorded.quantity, *volts})}
            self.takes_by = "noise_of"
        self.takes_hint = (
            "" if level == "auto" else "level: auto finds one above each frame's noise"
        )
        fixed = None if self.takes or self._recorded is not None else self._other
        self._fixed, self._fixed_in_volts = fixed, fixed if level_v is None else self._level_v
        self._empty: Mask | None = None  # what an empty pad gave last, while it stays empty
        self._empty_shape = self._empty_strides = (0, 0)

    def _reached(self, level: float | None) -> float | None:
        """Return the level that a cell must reach."""
        if level is None:
            return None
        if not math.isfinite(level):
            raise ValueError(f"the level must be a finite number, got {level}")
        # To exceed a float is to reach the next one.
        return math.nextafter(level, math.inf) if self._above else float(level)

    def __call__(self, image: Image) -> Annotated[Mask, Grid.like("image")]:
        """Return the mask of the cells that are on.

        Raises
        ------
        RuleError
            If only a level in another unit is known than the image is in.
        Degenerate
            If no cell is valid, or ``auto`` has too few to tell loads from noise.
        """
        level = self._fixed_in_volts if image.quantity == "volt" else self._fixed
        empty = self._empty
        if level is not None and image.valid is None:  # the usual cases, by the shortest way
            values = image.values
            if empty is None:
                out = np.empty(values.shape, BOOL)
                usual = values.dtype is DOUBLE and values.ndim == 2 and values.flags.c_contiguous
                count = (at_least.direct if usual else at_least.call)(values, level, out)
                if count > 0:
                    return quick_mask(out, image.pitch_cm, image.origin_cm, count)
            elif (  # a pad is empty for long: a look suffices, and nothing is made anew
                values.dtype is DOUBLE
                and values.shape == self._empty_shape
                and values.strides == self._empty_strides  # in order of memory
                and image.pitch_cm == empty.pitch_cm
                and image.origin_cm == empty.origin_cm
                and not any_at_least.direct(values, level)
            ):
                return empty
        in_volts = self._level_v is not None and image.quantity == "volt"
        level = self._level_v if in_volts else self._other
        if self.takes and image.quantity not in self.takes["image"]:
            wanted = " or ".join(self.takes["image"])
            raise RuleError(f"{self.takes_by} is for images in {wanted}, got {image.quantity}")
        if level is None:
            return levelled(image)
        if (
            empty is not None
            and image.valid is None
            and _on_one_grid(image, empty)
            and not any_at_least.call(image.values, level)
        ):
            return empty
        mask = footprint(image, level)
        if self._recorded is not None and not in_volts:
            mask = with_level(mask, self._recorded)
        self._empty = None if mask.count or image.valid is not None else mask
        self._empty_shape = _, columns = mask.shape
        self._empty_strides = 8 * columns, 8
        return mask

    def stacked(self, image: ImageStack) -> Answered:
        """Return the masks of several frames, where a level is known for their quantity."""
        in_volts = self._level_v is not None and image.quantity == "volt"
        level = self._level_v if in_volts else self._other
        takes = self.takes.get("image", (image.quantity,))
        if image.quantity not in takes or (level is not None and image.values.dtype != "f8"):
            return NotImplemented  # type: ignore[no-any-return]
        if level is None:
            return levelled_each(image)
        found = footprints(image, level)
        if in_volts or (recorded := self._recorded) is None:
            return found
        assert isinstance(found.values, MaskStack)
        levels = np.full(len(image), recorded.level)
        masks = LevelledMaskStack(
            found.values, levels, recorded.quantity, [recorded.told] * len(image)
        )
        return Answered(masks, found.done)


def _on_one_grid(image: Image, mask: Mask) -> bool:
    return (
        image.values.shape == mask.values.shape
        and image.pitch_cm == mask.pitch_cm
        and image.origin_cm == mask.origin_cm
    )
