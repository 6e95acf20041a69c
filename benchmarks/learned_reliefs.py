"""Objects named by one press, by reliefs learned from 25 presses each.

    python benchmarks/learned_reliefs.py --pads strip --seeds 11

Objects, pads and presses are those of `identify_objects`. Told are counts, names, grid, full scale
and the pad's law: blur, power and threshold, no settings that all pads share. Place, turn, lean and
depth of every press, each object's relief, the gains of the elements and how much readings differ
from what is expected are learned. The cover is taken for a bed of springs, which it is here.

An object's presses are first laid on each other by their pictures; relief and presses are then
fitted in turns, those that fit badly being looked for anew and trusted less. Beyond what any press
touched a relief goes on as it rises at its rim. A press is named by fitting every object's relief
to it, and is as far from an object as its misfit, still cells left out, is over the median misfit
of that object's own. Strangers are found where that is more than all but a share of the known
presses have: limits on the test readings, as in the curves of `identify_objects`, and one that
accepts 95 % of the presses learned. An object's relief is learned from its own presses alone, gains
and variances from those of all objects, the stranger's among them.

That reliefs can be learned from 25 presses is refuted by less than 85 % of strangers found where
5 % are lost or less than 95 % nearest to their own, on any one pad. Settings were chosen on
catalogue 1 of the strip and the capacitive pad, how far an object's usual misfit counts on
catalogue 11 of the strip, what is missed by a soft relief and by still cells on catalogue 2 of the
strip, what tells where a relief was touched and where large objects begin on catalogue 2 of the
capacitive pad. Measured besides: 11, 12, 41 and 42 of the strip, 11 and 41 of the capacitive pad,
41 of the resistive one.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from identify_objects import presses
from numpy.typing import NDArray
from pressed_objects import INSTRUMENTS, Instrument, Pad, Thing, catalogue
from pressed_reliefs import (
    HUBER,
    NODES,
    POINTS,
    add_picture,
    cost_of_all,
    expected,
    fitted,
    likeness,
)
from scipy import sparse
from scipy.ndimage import distance_transform_edt
from scipy.optimize import minimize, nnls
from scipy.sparse.linalg import spsolve

from tactile_graph import Frame

Values = NDArray[np.float64]
LOST = (0.01, 0.025, 0.036, 0.05, 0.1)
CONFIDENCE = 0.95
TURNS = 2.0 * math.pi * np.arange(60) / 60
NOTHING = 0.012
"""Readings below this share of full scale are none."""
MARGIN = 3
"""Cells around a footprint that are looked at."""
LARGE, LEANING = 300, np.arange(-6.0, 6.1, 1.5)
"""Cells of a large press, and how far off the middle of what it touches it may lie."""
CUT, WIDER = 0.75, 1.3
"""How much more is kept than one press shows, where the edge cuts more than this share of them."""
STIFF = 0.3
"""What a kink of the relief costs."""
SOFT = 0.03
"""Depth, of the usual one, over which touching begins."""
GAIN_SPREAD = 0.12
STAGES = ((0.15, 8.0, 30), (0.1, 4.0, 30), (0.06, 2.0, 30), (0.04, 1.0, 40), (SOFT, 1.0, 60))
"""First descent: softness, how much wider variances are taken, steps.

What a soft relief misses at its rim is added to the variances: still cells vary by so little that
else no relief at all fits better than one laid a little wrongly, and from there none comes back."""
AGAIN = ((SOFT, 1.0, 40), (SOFT, 1.0, 40))
STARTS, FOLLOWED, OBJECTS = 6, 2, 6
"""Turns begun with for each object, how many of them are followed, and of how many objects."""


class Seen(NamedTuple):
    """Presses of one object: readings of full scale above zero, footprints' boxes, centres."""

    values: Values
    boxes: NDArray[np.int64]
    centres: Values

    @classmethod
    def of(cls, frames: Iterable[Values], full_scale: float) -> Seen:
        """Return frames of counts as presses; a box is row, column, rows, columns."""
        values, boxes, centres = [], [], []
        for counts in frames:
            above = (counts - np.median(counts[counts <= np.quantile(counts, 0.6)])) / full_scale
            foot = above > max(0.02 * above.max(), NOTHING)
            i, j = np.nonzero(foot)
            low = np.maximum([i.min() - MARGIN, j.min() - MARGIN], 0)
            high = np.minimum([i.max() + MARGIN + 1, j.max() + MARGIN + 1], counts.shape)
            values.append(above)
            boxes.append([*low, *(high - low)])
            share = above[foot] / above[foot].sum()
            centres.append([((j + 0.5) * share).sum(), ((i + 0.5) * share).sum()])
        return cls(np.array(values), np.array(boxes), np.array(centres))

    def cells(self) -> NDArray[np.int64]:
        """Return how many cells of each press are looked at."""
        return self.boxes[:, 2] * self.boxes[:, 3]

    def totals(self) -> Values:
        """Return the sum of each press."""
        return np.maximum(self.values, 0.0).sum(axis=(1, 2))

    def cut(self) -> NDArray[np.bool_]:
        """Return which presses reach the edge of the pad."""
        v = self.values
        rim = np.maximum.reduce([v[:, 0].max(1), v[:, -1].max(1), v[:, :, 0].max(1),
                                 v[:, :, -1].max(1)])  # fmt: skip
        return rim > 0.05 * v.max(axis=(1, 2))


@dataclass
class Reads:
    """How a pad reads: gains, and variance of readings: still, of their square, of their slope."""

    it: Instrument
    gains: Values
    top: float
    variances: Values
    lean_variance: float = 0.06**2

    def __post_init__(self) -> None:
        blur = self.it.blur_cells * POINTS
        reach = math.ceil(3.0 * blur)
        bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / blur) ** 2)
        self.taps = np.convolve(bell / bell.sum(), np.full(POINTS, 1.0 / POINTS))

    def law(self, soft: float) -> Values:
        """Return what the kernels take."""
        return np.array([soft, self.it.law, self.it.threshold, self.top, self.lean_variance])

    def parts(self, values: Values) -> Values:
        """Return what each of the variances is multiplied by, shape (3, ...)."""
        down, along = np.zeros_like(values), np.zeros_like(values)
        down[:, 1:-1] = (values[:, 2:] - values[:, :-2]) / 2.0
        along[:, :, 1:-1] = (values[:, :, 2:] - values[:, :, :-2]) / 2.0
        return np.array([np.ones_like(values), np.maximum(values, 0.0) ** 2, down**2 + along**2])

    def weights(self, values: Values) -> Values:
        """Return one over the variance of each reading."""
        return 1.0 / np.tensordot(self.variances, self.parts(values), 1)


@dataclass
class Relief:
    """A learned object.

    Parameters
    ----------
    depth : ndarray, shape (N, N)
    presses : ndarray, shape (n, 6)
        Those it was learned from.
    usual, soft : float
        Depth of a usual press, and over which touching begins.
    misfits : ndarray, shape (n,)
        Of all cells while it is learned, then as `distances` has them.
    picture : ndarray, shape (N, N)
        Mean of what was read, each press divided by its sum.
    deep : ndarray, shape (2,)
        Depth of a press by the logarithm of its sum: at 0, and slope.
    """

    depth: Values
    presses: Values
    usual: float
    soft: float
    misfits: Values
    picture: Values
    deep: Values

    def trust(self, seen: Seen) -> Values:
        """Return what presses count while their relief is learned: little where they fit badly."""
        each = self.misfits / seen.cells()
        return np.where(each <= 3.0 * np.quantile(each, 0.3), 1.0, 0.02)

    def start(self, x: float, y: float, turn: float, total: float) -> Values:
        """Return a press to begin with."""
        return np.array([x, y, turn, self.deep @ [1.0, math.log(total)], 0.0, 0.0])


# -- laying presses on each other ---------------------------------------------------------------


def shifts(box: NDArray[np.int64], shape: tuple[int, ...]) -> Values:
    """Return by how much a press may be off its centre: far if the pad's edge cuts it."""
    large = min(shape) > 20
    ends = (box[:2] == 0) | (box[:2] + box[2:] == shape)
    if ends.any() and large:
        return np.arange(-5.0, 5.1, 1.0)
    return np.arange(-2.0, 2.1, 1.0) if ends.any() or large else np.arange(-1.5, 1.6, 0.75)


def alike(picture: Values, seen: Seen, k: int) -> Values:
    """Return for each of `TURNS` the correlation of a press with a picture, and where."""
    box, values = seen.boxes[k], np.maximum(seen.values[k], 0.0)
    stride = 2 if box[2] * box[3] > LARGE else 1
    return likeness(picture, values, box, TURNS, shifts(box, values.shape), seen.centres[k], stride)


def picture_of(seen: Seen, poses: Values, nodes: int, trust: Values) -> Values:
    """Return the mean of presses laid on each other."""
    total, weight = np.zeros((nodes, nodes)), np.zeros((nodes, nodes))
    sums = seen.totals()
    for k, pose in enumerate(poses):
        add_picture(total, weight, np.maximum(seen.values[k], 0.0) / sums[k], pose, trust[k])
    return total / np.maximum(weight, 1e-9)


def laid(seen: Seen, place: int) -> tuple[Values, Values]:
    """Return x, y and turn of presses laid on the fullest one or a lesser, and their picture."""
    sums = seen.totals()
    area = (seen.values > 0.05 * seen.values.max(axis=(1, 2))[:, None, None]).sum(axis=(1, 2))
    odd = np.abs(np.log(sums / np.median(sums))) > 0.7
    fullness = area * np.where(odd, 0.5, 1.0) * np.where(seen.cut(), 0.1, 1.0)
    first = int(np.argsort(-fullness)[place])
    radius = 1.05 * np.hypot(seen.boxes[:, 2], seen.boxes[:, 3]).max() / 2.0 + 1.5
    radius *= WIDER if seen.cut().mean() > CUT else 1.0
    nodes = 2 * math.ceil(radius * NODES) + 1
    poses = np.column_stack([seen.centres, np.zeros(len(sums))])
    picture = picture_of(seen, poses, nodes, (np.arange(len(sums)) == first).astype(float))
    for sharp in (8, 8, 4, 4):
        best = np.zeros(len(sums))
        for k in range(len(sums)):
            found = alike(picture, seen, k)
            t = int(np.argmax(found[:, 0]))
            best[k], poses[k] = found[t, 0], (*found[t, 1:], TURNS[t])
        picture = picture_of(seen, poses, nodes, np.maximum(best, 0.01) ** sharp)
    return poses, picture


# -- fitting presses ------------------------------------------------------------------------------


def starts(relief: Relief, seen: Seen, k: int, n: int) -> list[Values]:
    """Return presses to begin with: turns about which the pictures are most alike.

    A large object that leans touches far off its middle: half as many begin as far off as that.
    """
    total = float(np.maximum(seen.values[k], 0.0).sum())
    far = [alike(relief.picture, seen, k)]
    if seen.cells()[k] > LARGE:
        far.append(likeness(relief.picture, np.maximum(seen.values[k], 0.0), seen.boxes[k], TURNS,
                            LEANING, seen.centres[k], 2))  # fmt: skip
    out = []
    for found, most in zip(far, (n, n // 2), strict=False):
        score = found[:, 0]
        peaks = np.flatnonzero((score >= np.roll(score, 1)) & (score >= np.roll(score, -1)))
        out += [relief.start(*found[t, 1:], TURNS[t], total)
                for t in peaks[np.argsort(-score[peaks])][:most]]  # fmt: skip
    return out


def stepped(
    relief: Relief, press: Values, seen: Seen, k: int, weights: Values, reads: Reads, n_steps: int
) -> tuple[float, Values]:
    """Return the misfit of a press after so many steps, and the press."""
    return fitted(relief.depth, press, seen.values[k], weights[k], seen.boxes[k], reads.gains,
                  reads.taps, reads.law(relief.soft), n_steps)  # fmt: skip


def least(
    relief: Relief, begun: Sequence[Values], seen: Seen, k: int, weights: Values, reads: Reads
) -> tuple[float, Values]:
    """Return the least misfit of those that come of several presses begun with."""
    first = [stepped(relief, press, seen, k, weights, reads, 4) for press in begun]
    first.sort(key=lambda one: one[0])
    return min((stepped(relief, press, seen, k, weights, reads, 20)
                for _, press in first[:FOLLOWED]), key=lambda one: one[0])  # fmt: skip


def everywhere(relief: Relief, seen: Seen, k: int) -> list[Values]:
    """Return presses at every turn and place near the centre."""
    x, y = seen.centres[k]
    total = float(np.maximum(seen.values[k], 0.0).sum())
    return [relief.start(x + dx, y + dy, turn, total) for turn in TURNS[::3]
            for dx in (-3.0, 0.0, 3.0) for dy in (-3.0, 0.0, 3.0)]  # fmt: skip


def refit(relief: Relief, seen: Seen, weights: Values, reads: Reads, search: str) -> None:
    """Fit all presses to the relief; look anew for those that fit badly."""
    for k, press in enumerate(relief.presses):
        relief.misfits[k], relief.presses[k] = stepped(relief, press, seen, k, weights, reads, 8)
    each = relief.misfits / seen.cells()
    good = 1.6 * np.quantile(each, 0.2)
    trust = np.where(each <= good, 1.0, 1e-3)
    relief.picture = picture_of(seen, relief.presses, len(relief.depth), trust)
    logs = np.column_stack([np.ones(len(each)), np.log(seen.totals())])
    relief.deep = np.linalg.lstsq(logs, relief.presses[:, 3], rcond=None)[0]
    if not search:
        return
    for k in np.flatnonzero(each > good * (4.0 if search == "everywhere" else 1.0)):
        begun = (everywhere(relief, seen, k) if search == "everywhere"
                 else starts(relief, seen, k, STARTS))  # fmt: skip
        misfit, press = least(relief, begun, seen, k, weights, reads)
        if misfit < relief.misfits[k] - 5.0:
            relief.misfits[k], relief.presses[k] = misfit, press


# -- learning a relief -----------------------------------------------------------------------------


def scales(nodes: int) -> list[Values]:
    """Return interpolations from coarser grids, shape (nodes, m): descents go in large steps."""
    out = []
    for step in (2, 4, 8):
        at = np.arange(nodes) / step
        whole = at.astype(int)
        up = np.zeros((nodes, (nodes + step - 1) // step + 1))
        up[np.arange(nodes), whole] += 1.0 - (at - whole)
        up[np.arange(nodes), np.minimum(whole + 1, up.shape[1] - 1)] += at - whole
        out.append(up * math.sqrt(step) / 1.4)
    return out


def kinks(depth: Values) -> tuple[float, Values]:
    """Return what the kinks of a relief cost, and the gradient."""
    cost, gradient, small = 0.0, np.zeros_like(depth), 0.05
    for x, out in ((depth, gradient), (depth.T, gradient.T)):
        second = np.diff(x, 2, axis=0)
        size = np.sqrt(second**2 + small**2)
        cost += STIFF * float((size - small).sum())
        pull = STIFF * second / size
        out[:-2] += pull
        out[1:-1] -= 2.0 * pull
        out[2:] += pull
    return cost, gradient


def descend(relief: Relief, seen: Seen, weights: Values, reads: Reads, n_steps: int) -> None:
    """Fit relief and presses together by so many steps of L-BFGS."""
    nodes, usual = len(relief.depth), relief.usual
    radius = max(2.0, float(np.median(np.hypot(*(seen.boxes[:, 2:] - 2 * MARGIN).T))) / 2.8)
    unit = 0.3 * np.array([1, 1, 1 / radius, usual, usual / radius, usual / radius])
    ups, base, begun = [np.eye(nodes), *scales(nodes)], relief.presses.copy(), relief.depth / usual
    ends = np.cumsum([0, *(up.shape[1] ** 2 for up in ups)])
    by_node, by_number = np.zeros((nodes, nodes)), np.zeros(base.shape)

    def depth(x: Values) -> Values:
        parts = [up @ x[a:b].reshape(up.shape[1], -1) @ up.T
                 for up, a, b in zip(ups, ends, ends[1:], strict=False)]  # fmt: skip
        return begun + sum(parts)

    def cost(x: Values) -> tuple[float, Values]:
        now, moved = depth(x), x[ends[-1] :].reshape(base.shape) * unit + base
        total = cost_of_all(now * usual, moved, seen.values, weights, seen.boxes, reads.gains,
                            reads.taps, reads.law(relief.soft), by_node, by_number)  # fmt: skip
        more, gradient = kinks(now)
        gradient += by_node * usual
        parts = [(up.T @ gradient @ up).ravel() for up in ups]
        return total + more, np.concatenate([*parts, (by_number * unit).ravel()])

    x = minimize(cost, np.zeros(ends[-1] + base.size), jac=True, method="L-BFGS-B",
                 options={"maxiter": n_steps, "maxcor": 20}).x  # fmt: skip
    relief.depth = depth(x) * usual
    relief.presses = x[ends[-1] :].reshape(base.shape) * unit + base


def deepest(relief: Relief, seen: Seen) -> Values:
    """Return how deep each node was ever pressed; minus infinity where none was looked at.

    Presses that fit badly count for nothing: they tell of places where they never were.
    """
    half = (len(relief.depth) - 1) / 2.0
    at = (np.arange(len(relief.depth)) - half) / NODES
    v, u = np.meshgrid(at, at, indexing="ij")
    out = np.full(u.shape, -np.inf)
    trusted = relief.trust(seen) == 1.0
    for press, box in zip(relief.presses[trusted], seen.boxes[trusted], strict=True):
        x0, y0, turn, deep, lean_u, lean_v = press
        x = x0 + u * math.cos(turn) - v * math.sin(turn)
        y = y0 + u * math.sin(turn) + v * math.cos(turn)
        on = (x > box[1]) & (x < box[1] + box[3]) & (y > box[0]) & (y < box[0] + box[2])
        out = np.where(on, np.maximum(out, deep - lean_u * u - lean_v * v), out)
    return out


def extend(relief: Relief, seen: Seen, within: int = 8) -> None:
    """Let the relief go on beyond what was touched, as smoothly as it comes, never touching."""
    below, depth = deepest(relief, seen), relief.depth
    learned = depth < below - 0.02 * relief.usual
    free = ~learned & (distance_transform_edt(~learned) <= within)
    number = np.where(free, np.cumsum(free.ravel()).reshape(free.shape) - 1, -1)
    n = len(depth)
    rows, columns, factors, right = [], [], [], []
    n_rows = 0
    for i, j, factor in ((0, 1, 1.0), (1, 0, 1.0), (1, 1, 0.5), (1, -1, 0.5)):
        three = [(np.s_[1 - s * i : n - 1 - s * i], np.s_[1 - s * j : n - 1 - s * j])
                 for s in (1, 0, -1)]  # fmt: skip
        used = np.logical_and.reduce([(free | learned)[at] for at in three])
        used &= np.logical_or.reduce([free[at] for at in three])
        row, off = n_rows + np.arange(used.sum()), np.zeros(used.sum())
        for at, times in zip(three, (factor, -2.0 * factor, factor), strict=True):
            which = number[at][used]
            rows.append(row[which >= 0])
            columns.append(which[which >= 0])
            factors.append(np.full((which >= 0).sum(), times))
            off -= np.where(which < 0, times * depth[at][used], 0.0)
        right.append(off)
        n_rows += len(row)
    M = sparse.csr_matrix((np.concatenate(factors), (np.concatenate(rows),
                           np.concatenate(columns))), shape=(n_rows, int(free.sum())))  # fmt: skip
    A = (M.T @ M + 1e-6 * sparse.identity(M.shape[1])).tocsc()
    smooth = spsolve(A, M.T @ np.concatenate(right) + 1e-6 * depth[free])
    out = depth.copy()
    out[free] = np.maximum(smooth, np.where(np.isfinite(below[free]), below[free], smooth))
    rest = ~learned & ~free
    out[rest] = np.maximum(depth[rest], below.max() + 4.0 * relief.usual)
    relief.depth = out


def begun(seen: Seen, place: int) -> Relief:
    """Return a relief to begin with: the depth that the mean reading of all presses leaves."""
    poses, picture = laid(seen, place)
    sums = seen.totals()
    load = picture * np.median(sums)
    top = float(load.max())
    usual = float(np.quantile(load[load > 0.3 * top], 0.8))
    depth, low = usual - load, load < 0.15 * top
    depth[low] += 0.5 * usual * (1.0 - load[low] / (0.15 * top))
    deep = usual * (1.0 + 0.7 * np.clip(np.log(sums / np.median(sums)), -1.0, 1.0))
    n = len(sums)
    return Relief(depth, np.column_stack([poses, deep, np.zeros((n, 2))]), usual,
                  STAGES[0][0] * usual, np.zeros(n), picture, np.zeros(2))  # fmt: skip


def learned(seen: Seen, reads: Reads, relief: Relief | None = None, place: int = 0) -> Relief:
    """Return the relief of an object by its presses, from a former one where there is one."""
    stages = AGAIN if relief else STAGES
    relief = relief or begun(seen, place)
    trust = np.ones(len(seen.values))
    for i, (soft, wider, n_steps) in enumerate(stages):
        relief.soft = soft * relief.usual
        missed = (soft - SOFT) * relief.usual
        weights = 1.0 / (wider / reads.weights(seen.values) + missed**2)
        descend(relief, seen, weights * trust[:, None, None], reads, n_steps)
        last = i == len(stages) - 1
        refit(relief, seen, weights, reads,
              "" if last else "everywhere" if i == len(stages) - 2 else "turns")  # fmt: skip
        trust = relief.trust(seen)
    extend(relief, seen)
    descend(relief, seen, weights * trust[:, None, None], reads, 30)
    extend(relief, seen)
    refit(relief, seen, weights, reads, "")
    return relief


def improve(reads: Reads, reliefs: Sequence[Relief], all_seen: Sequence[Seen]) -> None:
    """Learn gains, variances and the spread of the lean from what reliefs leave over."""
    each = [r.misfits / s.cells() for r, s in zip(reliefs, all_seen, strict=True)]
    limit = 2.5 * float(np.median(np.concatenate(each)))
    over, under = np.zeros(reads.gains.shape), np.zeros(reads.gains.shape)
    parts, squares = [], []
    for relief, seen, off in zip(reliefs, all_seen, each, strict=True):
        weights, by = reads.weights(seen.values), reads.parts(seen.values)
        for k in np.flatnonzero(off <= limit):
            i, j, m, n = seen.boxes[k]
            box = np.s_[i : i + m, j : j + n]
            value = expected(relief.depth, relief.presses[k], seen.boxes[k], reads.gains,
                             reads.taps, reads.law(relief.soft))  # fmt: skip
            real, weight = seen.values[k][box], weights[k][box]
            counts = ~((real >= reads.top) & (value > real))
            told = np.where(counts & (value > 0.01), weight, 0.0)
            over[box] += told * value * (real - value)
            under[box] += told * value**2
            parts.append(by[:, k][:, *box][:, counts].T)
            squares.append(np.minimum((real - value) ** 2, 9.0 / weight)[counts])
    change = over / (under + 1.0 / GAIN_SPREAD**2)
    reads.gains = reads.gains * np.exp(np.clip(change, -0.3, 0.3) / reads.it.law)
    A, b = np.concatenate(parts), np.concatenate(squares)
    for _ in range(3):
        weight = 1.0 / (A @ reads.variances)
        found = nnls(A * weight[:, None], b * weight)[0]
        reads.variances = np.maximum(found, [1e-7, 1e-5, 1e-5])
    leans = np.concatenate([r.presses[:, 4:].ravel() for r in reliefs])
    reads.lean_variance = 1.2 * float(np.mean(leans**2))


def off_a_cell(relief: Relief, seen: Seen) -> float:
    """Return the mean misfit of a cell."""
    return float(np.mean(relief.misfits / seen.cells()))


def begin_again(reliefs: list[Relief], all_seen: Sequence[Seen], reads: Reads) -> None:
    """Learn objects that fit badly anew, their presses laid on two other ones first."""
    off = [off_a_cell(*one) for one in zip(reliefs, all_seen, strict=True)]
    for o in np.flatnonzero(off > 2.0 * np.median(off)):
        more = [learned(all_seen[o], reads, place=place) for place in (1, 2)]
        reliefs[o] = min([reliefs[o], *more], key=lambda one, o=o: off_a_cell(one, all_seen[o]))


def learn_all(
    frames: Sequence[Values], it: Instrument, say: Callable[[str], None], rounds: int = 3
) -> tuple[list[Relief], Reads]:
    """Return the reliefs of all objects, and how the pad reads."""
    all_seen = [Seen.of(some, it.full_scale) for some in frames]
    top = 0.99 * max(float(s.values.max()) for s in all_seen)
    reads = Reads(it, np.ones(frames[0].shape[1:]), top, np.array([0.0015, 0.1, 0.02]) ** 2)
    reliefs: list[Relief] = []
    for k in range(rounds):
        known = reliefs or [None] * len(all_seen)
        reliefs = [learned(s, reads, r) for s, r in zip(all_seen, known, strict=True)]
        if k == 0:
            begin_again(reliefs, all_seen, reads)
        improve(reads, reliefs, all_seen)
        say(f"round {k + 1}: readings vary by {100 * math.sqrt(reads.variances[1]):.1f} %, gains "
            f"by {100 * np.log(reads.gains).std():.1f} %")  # fmt: skip
    for relief, seen in zip(reliefs, all_seen, strict=True):
        weights = reads.weights(seen.values)
        refit(relief, seen, weights, reads, "")
        less, more = still(seen, weights)
        relief.misfits = np.maximum(relief.misfits - less, 0.0) + more
    return reliefs, reads


# -- naming ----------------------------------------------------------------------------------------


def still(seen: Seen, weights: Values) -> tuple[Values, Values]:
    """Return the misfit of each press's cells that read nothing, if so expected; how many read.

    The former is the same of every object, and hangs on how far the zeros have drifted.
    """
    misfits, n_felt = np.zeros(len(seen.values)), np.zeros(len(seen.values))
    for k, (i, j, m, n) in enumerate(seen.boxes):
        box = np.s_[k, i : i + m, j : j + n]
        nothing = seen.values[box] < NOTHING
        off = (np.abs(seen.values[box]) * np.sqrt(weights[box]))[nothing]
        misfits[k] = np.where(off > HUBER, HUBER * (2.0 * off - HUBER), off**2).sum()
        n_felt[k] = np.count_nonzero(~nothing)
    return misfits, n_felt


def usual_of(reliefs: Sequence[Relief]) -> Values:
    """Return each object's usual misfit, shape (K,).

    That of a badly learned object is held back, lest it take in the presses of others.
    """
    usual = np.array([np.median(relief.misfits) for relief in reliefs])
    return np.clip(usual, 0.67 * np.median(usual), 1.5 * np.median(usual))


def distances(reliefs: Sequence[Relief], reads: Reads, seen: Seen) -> Values:
    """Return how far presses are from objects, shape (n, K): misfits over each object's usual.

    Misfits are those beyond what still cells have, and one for each cell that reads.
    """
    weights = reads.weights(seen.values)
    less, more = still(seen, weights)
    usual = usual_of(reliefs)
    out = np.empty((len(seen.values), len(reliefs)))
    for k in range(len(out)):
        begun_with = [
            sorted((stepped(relief, press, seen, k, weights, reads, 4)
                    for press in starts(relief, seen, k, STARTS)), key=lambda one: one[0])
            for relief in reliefs
        ]  # fmt: skip
        misfits = np.array([found[0][0] for found in begun_with])
        far = (np.maximum(misfits - less[k], 0.0) + more[k]) / usual
        for o in np.argsort(far)[:OBJECTS]:
            misfits[o] = min(stepped(reliefs[o], press, seen, k, weights, reads, 20)[0]
                             for _, press in begun_with[o][:FOLLOWED])  # fmt: skip
        out[k] = (np.maximum(misfits - less[k], 0.0) + more[k]) / usual
    return out


def told(known: Values, foreign: Values) -> str:
    """Return shares named right and of strangers found, at limits on these and at 1.

    Parameters
    ----------
    known : ndarray, shape (K, n, K)
        Distances of each object's presses to every object.
    foreign : ndarray, shape (m, K)
    """
    own = np.arange(len(known))
    nearest = known.min(axis=2)
    others = known.copy()
    others[own, :, own] = np.inf
    right = known.argmin(axis=2) == own[:, None]
    limits = [np.quantile(nearest, 1.0 - lost) for lost in LOST]
    shares = lambda far: " ".join(f"{100 * (far > limit).mean():5.1f}" for limit in limits)  # noqa: E731
    by_itself = (
        f"limit on presses learned: named right {100 * (right & (nearest <= 1.0)).mean():.1f} %, "
        f"lost {100 * (nearest > 1.0).mean():.1f} %, strangers found "
        f"{100 * (others.min(axis=2) > 1.0).mean():.1f} %, foreign "
        f"{100 * (foreign.min(axis=1) > 1.0).mean():.1f} %; limits on test presses: "
    )
    return (f"{by_itself}nearest is right {100 * right.mean():.1f} %, named right where 5 % are "
            f"lost {100 * (right & (nearest <= limits[3])).mean():.1f} %; of strangers found where "
            f"{', '.join(f'{100 * lost:g}' for lost in LOST)} % are lost "
            f"{shares(others.min(axis=2))} %; foreign {shares(foreign.min(axis=1))} %")  # fmt: skip


def counts_of(frames: Iterable[Frame], things: Sequence[Thing]) -> list[Values]:
    """Return the counts of each thing's presses, shape (n, rows, columns)."""
    found: dict[str, list[Values]] = {thing.name: [] for thing in things}
    for frame in frames:
        found[str(frame.label)].append(np.asarray(frame.image.values, dtype=np.float64))
    return [np.array(some) for some in found.values()]


def tried(
    it: Instrument, believed: Instrument, seed: int, every: int, say: Callable[[str], None]
) -> tuple[Values, Values]:
    """Return distances of known and of foreign presses on one pad and catalogue.

    Over the limit that accepts 95 % of the presses learned. The pad's law is that of what it is
    believed to be.
    """
    rng = np.random.default_rng([seed])
    pad = Pad(it, rng)
    things = catalogue(it, rng)
    to_learn = counts_of(presses(pad, things), things)
    to_test = counts_of(presses(pad, things), things)
    others = catalogue(it, np.random.default_rng([seed, 1]), "foreign ")
    foreign = counts_of(presses(pad, others), others)
    reliefs, reads = learn_all(to_learn, believed, say)
    far = [[distances(reliefs, reads, Seen.of(some[::every], it.full_scale)) for some in part]
           for part in (to_test, foreign)]  # fmt: skip
    usual = usual_of(reliefs)
    own = [relief.misfits / its for relief, its in zip(reliefs, usual, strict=True)]
    limit = float(np.quantile(np.concatenate(own), CONFIDENCE))
    return np.array(far[0]) / limit, np.concatenate(far[1]) / limit


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--pads", nargs="*", choices=INSTRUMENTS, default=[*INSTRUMENTS])
    parser.add_argument("--seeds", nargs="*", type=int, default=[11])
    parser.add_argument("--every", type=int, default=1, help="name every so many-th press only")
    parser.add_argument("--law", nargs=3, type=float, metavar=("BLUR", "POWER", "THRESHOLD"),
                        help="believe this of the pads in place of what is so")  # fmt: skip
    asked = parser.parse_args(arguments)
    every: list[tuple[Values, Values]] = []
    for name in asked.pads:
        it = believed = INSTRUMENTS[name]
        if asked.law:
            blur_cells, law, threshold = asked.law
            believed = replace(it, blur_cells=blur_cells, law=law, threshold=threshold)
        for seed in asked.seeds:
            begin = time.process_time()
            every.append(tried(it, believed, seed, asked.every,
                               lambda text: print(text, flush=True)))  # fmt: skip
            spent = time.process_time() - begin
            print(f"{name}, catalogue {seed}: {told(*every[-1])}; {spent:.0f} s", flush=True)
    if len(every) > 1:
        known = np.concatenate([one[0] for one in every], axis=1)
        foreign = np.concatenate([one[1] for one in every])
        print(f"all of them: {told(known, foreign)}")


if __name__ == "__main__":
    main()
