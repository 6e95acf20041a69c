"""The kernel of all morphology: erosion by a plan of few AND sweeps over flat planes.

An element of N cells asks for N shifted ANDs per cell. A *plan* gets by with fewer: runs of
cells in a row, and equal runs in rows below each other, are put together by doubling (the AND
over 8 cells is that over 4, twice), as erosion does not mind counting a cell twice. A 21 x 21
square takes 10 sweeps instead of 441, whatever the image. Dilation is the erosion of the
complement (De Morgan), so one kernel serves for everything.

The image is laid into one flat row of bytes with a margin wide enough for the element, so that
every sweep is a plain loop over contiguous bytes that the compiler turns into vector code.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph.wires import Mask, quick_mask
from tactile_graph.wires.stacks import MaskStack
from tactile_graph_filters.morphology.elements import Element

Plan = NDArray[np.int64]
"""Row 0: planes, margin rows, margin columns, value outside, first row of the second stage,
result plane, flip the result. Other rows are sweeps: target, source, down a, right a, down b,
right b, whether the target is new: ``target[x] (&)= source[x + a] & source[x + b]``; a sweep
whose source is -1 complements its target."""

BOOL = np.dtype(np.bool_)

_WORTH_DOUBLING = 4


@dataclass
class _Sweeps:
    """Collects the sweeps of a plan."""

    rows: list[tuple[int, ...]]
    planes: int = 1

    def new(self, source: int, a: tuple[int, int], b: tuple[int, int]) -> int:
        """Add a sweep into a new plane; return the plane."""
        target, self.planes = self.planes, self.planes + 1
        self.rows.append((target, source, *a, *b, 1))
        return target


def _runs(element: Element) -> dict[tuple[int, int], list[int]]:
    """Return (first column, length) of each run of cells -> the rows it stands in."""
    runs: dict[tuple[int, int], list[int]] = {}
    middle_row, middle_column = element.reach
    for row, cells in enumerate(element.cells):
        for on, group in groupby(enumerate(cells), key=lambda pair: bool(pair[1])):
            columns = [column for column, _ in group]
            if on:
                key = (columns[0] - middle_column, len(columns))
                runs.setdefault(key, []).append(row - middle_row)
    return runs


def _stretches(rows: list[int]) -> list[tuple[int, int]]:
    """Return (first, length) of the stretches of consecutive numbers in ``rows``."""
    grouped = groupby(enumerate(rows), key=lambda pair: pair[1] - pair[0])
    stretches = [[row for _, row in group] for _, group in grouped]
    return [(stretch[0], len(stretch)) for stretch in stretches]


def _stage(sweeps: _Sweeps, source: int, element: Element) -> int:
    """Add the sweeps that erode plane ``source``; return the plane that holds the result."""
    doubled = {1: source}  # width -> plane whose cells are the AND over so many cells rightwards
    runs = _runs(element)
    width = 1
    while 2 * width <= max(length for _, length in runs):
        doubled[2 * width] = sweeps.new(doubled[width], (0, 0), (0, width))
        width *= 2
    parts: list[tuple[int, int, int, int, int]] = []
    for (column, length), rows in runs.items():
        width = 1 << (length.bit_length() - 1)
        plane, shift = doubled[width], length - width
        for row, height in _stretches(rows):
            if height < _WORTH_DOUBLING:
                parts += [(plane, r, column, r, column + shift) for r in range(row, row + height)]
            else:
                tall, half = _tall(sweeps, plane, shift, height)
                parts.append((tall, row, column, row + height - half, column))
    target, sweeps.planes = sweeps.planes, sweeps.planes + 1
    sweeps.rows += [(target, *part, int(n == 0)) for n, part in enumerate(parts)]
    return target


def _tall(sweeps: _Sweeps, plane: int, shift: int, height: int) -> tuple[int, int]:
    """Add the sweeps that double a run downwards; return the plane and its height."""
    if shift:
        plane = sweeps.new(plane, (0, 0), (0, shift))
    half = 1
    while 2 * half <= height:
        plane = sweeps.new(plane, (0, 0), (half, 0))
        half *= 2
    return plane, half


def make_plan(
    first: Element, second: Element | None = None, *, dilate: bool = False, border: bool = False
) -> Plan:
    """Return the plan of an erosion or dilation, or of one followed by the other.

    Parameters
    ----------
    first : Element
        What to erode with (to dilate with, if ``dilate``).
    second : Element, optional
        What to do the opposite with afterwards.
    dilate : bool
        Whether the first operation is a dilation.
    border : bool
        What the cells outside the image count as.

    Returns
    -------
    ndarray of int64, shape (1 + sweeps, 7)
        To be handed to `sweep`.
    """
    sweeps = _Sweeps([])
    result = _stage(sweeps, 0, first)
    if second is not None:
        sweeps.rows.append((result, -1, 0, 0, 0, 0, 0))
        result = _stage(sweeps, result, second)
    elements = [first] if second is None else [first, second]
    margins = [sum(element.reach[axis] for element in elements) for axis in (0, 1)]
    flip_out = dilate ^ (second is not None)
    head = (sweeps.planes, *margins, int(border), int(dilate), result, int(flip_out))
    return _frozen([head, *sweeps.rows])


def _frozen(rows: Sequence[tuple[int, ...]]) -> Plan:
    plan = np.array(rows, np.int64)
    plan.setflags(write=False)
    return plan


def _sweep_plain(values: NDArray[np.bool_], plan: Plan, out: NDArray[np.bool_]) -> int:
    """Write into ``out`` what ``plan`` makes of ``values``; return how many cells are on.

    Both are of shape (rows, columns).
    """
    n_planes, margin_rows, margin, border, flip_in, result, flip_out = plan[0].tolist()
    rows, columns = values.shape
    stride = columns + margin  # the margin right of a row is the one left of the next
    start, size = margin + margin_rows * stride, margin + (rows + 2 * margin_rows) * stride
    inner = slice(start, start + rows * stride)
    planes = np.zeros((n_planes, size), np.bool_)
    planes[0] = border ^ flip_in
    planes[0, inner].reshape(rows, stride)[:, :columns] = values ^ bool(flip_in)
    for target, source, down_a, right_a, down_b, right_b, new in plan[1:].tolist():
        if source < 0:
            np.logical_not(planes[target], out=planes[target])
            continue
        a, b = down_a * stride + right_a, down_b * stride + right_b
        low, high = max(0, -min(a, b)), size - max(0, a, b)
        both = planes[source, low + a : high + a] & planes[source, low + b : high + b]
        planes[target, low:high] = both if new else planes[target, low:high] & both
    done = planes[result, inner].reshape(rows, stride)[:, :columns]
    np.not_equal(done, bool(flip_out), out=out)
    return int(np.count_nonzero(out))


def swept_mask(mask: Mask, plan: Plan) -> Mask:
    """Return a mask eroded (or dilated) by a plan."""
    out = np.empty(mask.values.shape, BOOL)
    count = sweep.call(mask.values, plan, out)
    return quick_mask(out, mask.pitch_cm, mask.origin_cm, count)


def swept(masks: MaskStack, plan: Plan) -> MaskStack:
    """Return what ``plan`` makes of several masks."""
    out, counts = np.empty(masks.values.shape, np.bool_), np.empty(len(masks), np.int64)
    sweep_each.call(masks.values, plan, out, counts)
    return MaskStack(out, masks.pitch_cm, masks.origin_cm, counts)


@compiled_twin_of(_sweep_plain)
def sweep(values, plan, out):  # type: ignore[no-untyped-def]
    """Write into ``out`` what ``plan`` makes of ``values``; return how many cells are on."""
    rows, columns = values.shape
    margin = plan[0, 2]
    stride = columns + margin  # the margin right of a row is the one left of the next
    size = margin + (rows + 2 * plan[0, 1]) * stride
    start = margin + plan[0, 1] * stride
    planes = np.empty((plan[0, 0], size), np.uint8)
    flip = np.uint8(plan[0, 4])
    planes[0, :] = np.uint8(plan[0, 3]) ^ flip
    for i in range(rows):
        row = planes[0, start + i * stride : start + i * stride + columns]
        given = values[i]
        for j in range(columns):
            row[j] = np.uint8(given[j]) ^ flip
    for k in range(1, plan.shape[0]):
        target = planes[plan[k, 0]]
        if plan[k, 1] < 0:
            for x in range(size):
                target[x] ^= np.uint8(1)
            continue
        a = plan[k, 2] * stride + plan[k, 3]
        b = plan[k, 4] * stride + plan[k, 5]
        low, high = max(0, -min(a, b)), size - max(0, a, b)
        source = planes[plan[k, 1]]
        at_a, at_b, goal = source[low + a : high + a], source[low + b : high + b], target[low:high]
        if plan[k, 6]:
            for x in range(high - low):
                goal[x] = at_a[x] & at_b[x]
        else:
            for x in range(high - low):
                goal[x] &= at_a[x] & at_b[x]
    done, flip = planes[plan[0, 5]], np.uint8(plan[0, 6])
    count = 0
    for i in range(rows):
        row = done[start + i * stride : start + i * stride + columns]
        wanted = out[i]
        for j in range(columns):
            wanted[j] = (row[j] ^ flip) != 0
            count += (row[j] ^ flip) != 0
    return count


@compiled_later
def sweep_each(values, plan, out, counts):  # type: ignore[no-untyped-def]
    """Write into ``out`` what ``plan`` makes of each of several masks, and how many are on."""
    for k in range(values.shape[0]):
        counts[k] = sweep(values[k], plan, out[k])
