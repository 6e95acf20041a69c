"""A second opinion: pads simulated without a line of the project's own pad physics.

Nothing here comes from `tactile_graph_pads`. Coverage is counted over points sown in each element;
pressure is a function of those points; the force law, the divider, what the scan adds and what is
broken are written anew from the thesis' text (chapter 2) and from what real pads are known to do.
A pad draws what it is from a seeded generator, and every frame carries its truth.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Circle, Frame, Rectangle
from tactile_graph.wires import TrueObject

Values = NDArray[np.float64]
Pressure = Callable[[Values, Values], Values]
"""Of u and v, a point's place in the object: 0 in its middle, of the length 1 at its rim."""
Carry = Callable[[Values, float], Values]
"""Of loads and a width in cells: what foam makes of them."""
Outline = Circle | Rectangle

SUPPLY_V = 5.0
BIAS_OHM = 33e3
SOWN = 20
"""Points along each side of an element; a disc's area comes out within a part in a thousand."""
STUCK_OHM = 2e3
COUNTS = 4095.0
KPA_CM2_PER_G = 0.0980665
DISCS = ((1860.0, 6.8), (6360.0, 5.1), (6810.0, 7.7))
"""Weight in grams and radius in cm of the discs of table 4.2."""
RECTANGLES = ((3000.0, 16.0, 7.0), (1500.0, 14.0, 3.0))
"""Weight in grams, length and breadth in cm of the rectangles of table 4.6."""


def even(u: Values, v: Values) -> Values:
    """The same pressure everywhere."""
    return np.ones_like(u)


@dataclass(frozen=True)
class Kind:
    """A kind of pad and of what lies on it.

    Lengths are in cm, loads in grams, voltages in volts.
    """

    rows: int = 16
    columns: int = 16
    element_cm: float = 1.0
    gap_cm: float = 0.3
    exponent: float = math.log(80.0) / math.log(20.0)
    """Of R ~ 1 / F**exponent, through 80 kOhm at 100 g; the thesis' two points give 1.46."""
    turn_on_g: float = 10.0
    saturation_g: float = 10e3
    noise_v: float = 0.2e-3
    """Standard deviation of a reading."""
    step_v: float = 0.0
    """Of the converter; 0 where the mean of many samples has washed it out."""
    offset_v: float = 0.0
    """Largest drift of an element's zero."""
    sigma: float = 0.5
    """Of the logarithm of gains."""
    fixed: float = 0.0
    """Share of the gains' variance that stays from frame to frame."""
    correlation_cells: float = 0.0
    """Width over which gains are alike; 0 for none."""
    line_sigma: float = 0.0
    """Of a gain that all elements of a row share."""
    voids: float = 0.15
    strays: float = 0.0
    """Share of all elements that read a load of their own."""
    dead_rows: int = 0
    dead_columns: int = 0
    dead_elements: int = 0
    stuck_elements: int = 0
    foam_cells: float = 0.0
    foam: Carry | None = None
    own_gains: bool = False
    """Whether gains and voids are the elements' own, under the foam, and not the contact's."""
    """How it carries loads on; as a Gaussian if not given."""
    pressure: Pressure = even
    discs: tuple[tuple[float, float], ...] = DISCS
    rectangles: tuple[tuple[float, float, float], ...] = RECTANGLES
    over_edge: bool = False
    """Whether objects may lie partly beyond the pad, their centre on it."""
    reads: str = "volt"
    """Quantity that is read: volts of the divider, those in counts of 12 bits, or, of calibrated
    pads, grams or kilopascals."""
    noise_g: float = 0.0
    """Standard deviation of a reading of a calibrated pad, rounded to as much and cut off at 0."""

    @property
    def pitch_cm(self) -> float:
        """Distance of neighbouring elements' centres."""
        return self.element_cm + self.gap_cm


class Bench:
    """One pad of a kind as built, on which objects are put down and read."""

    def __init__(self, kind: Kind, rng: np.random.Generator) -> None:
        self.kind, self.rng = kind, rng
        shape = (kind.rows, kind.columns)
        self.own = self._field()
        self.lines = rng.normal(0.0, kind.line_sigma, (kind.rows, 1))
        self.zero_v = kind.offset_v * rng.uniform(-1.0, 1.0, shape)
        self.dead = np.zeros(shape, bool)
        self.dead[rng.choice(kind.rows, kind.dead_rows, replace=False)] = True
        self.dead[:, rng.choice(kind.columns, kind.dead_columns, replace=False)] = True
        self.dead.flat[rng.choice(self.dead.size, kind.dead_elements, replace=False)] = True
        self.stuck = np.zeros(shape, bool)
        self.stuck.flat[rng.choice(self.dead.size, kind.stuck_elements, replace=False)] = True
        sown = (np.arange(SOWN) + 0.5) / SOWN
        along = np.arange(max(shape))[:, None] * kind.pitch_cm + sown * kind.element_cm
        self.x = along[: kind.columns].ravel()
        self.y = along[: kind.rows].ravel()

    def _field(self) -> Values:
        """Return standard normal numbers, alike over the width of correlation."""
        shape, width = (self.kind.rows, self.kind.columns), self.kind.correlation_cells
        white = self.rng.standard_normal(shape)
        return blurred(white, width, unit_variance=True) if width else white

    def frames(self, n: int, shape: str = "disc") -> Iterator[Frame]:
        """Yield frames of discs or rectangles put down one after another."""
        objects = self.kind.discs if shape == "disc" else self.kind.rectangles
        for index in range(n):
            weight_g, *sizes = objects[index % len(objects)]
            yield self.frame([TrueObject(self._put_down(*sizes), weight_g)], index)

    def frame(self, objects: Sequence[TrueObject], index: int = 0) -> Frame:
        """Return a frame of discs and rectangles that lie on the pad all at once."""
        load_g = sum(self._load_g(it.shape, it.weight_g) for it in objects)
        kind, load = self.kind, np.asarray(load_g)
        volts = self._calibrated(load) if kind.noise_g else self._read(load)
        pitch, truth = kind.pitch_cm, tuple(objects)
        return Frame.of(volts, pitch, self._origin_cm, kind.reads, index=index, truth=truth)

    @property
    def _origin_cm(self) -> tuple[float, float]:
        # Of a cell, its pitch wide; elements begin half a gap further in.
        return (-self.kind.gap_cm / 2, -self.kind.gap_cm / 2)

    def _put_down(self, *sizes_cm: float) -> Outline:
        """Return a disc of a radius, or a rectangle of a length and breadth at any angle."""
        kind, angle = self.kind, 0.0
        wide = high = sizes_cm[0]
        if len(sizes_cm) == 2:
            angle = self.rng.uniform(-0.5, 0.5) * math.pi
            cos, sin = abs(math.cos(angle)), math.sin(abs(angle))
            length, breadth = (0.5 * size for size in sizes_cm)
            wide, high = length * cos + breadth * sin, length * sin + breadth * cos
        width, height = (n * kind.pitch_cm - kind.gap_cm for n in (kind.columns, kind.rows))
        if kind.over_edge:
            wide = high = 0.0
        x = self.rng.uniform(wide, width - wide)
        y = self.rng.uniform(high, height - high)
        if len(sizes_cm) == 1:
            return Circle(x, y, sizes_cm[0])
        return Rectangle(x, y, *sizes_cm, angle)

    def _places(self, outline: Outline) -> tuple[Values, Values]:
        """Return each sown point's place in an object."""
        x, y = self.x[None, :] - outline.x_cm, self.y[:, None] - outline.y_cm
        if isinstance(outline, Circle):
            u, v = np.broadcast_arrays(x / outline.radius_cm, y / outline.radius_cm)
            return u, v
        cos, sin = math.cos(outline.angle_rad), math.sin(outline.angle_rad)
        u = 2.0 * (x * cos - y * sin) / outline.length_cm
        v = 2.0 * (x * sin + y * cos) / outline.breadth_cm
        far = np.hypot(u, v)
        to_rim = np.maximum(np.abs(u), np.abs(v)) / np.where(far > 0.0, far, 1.0)
        return u * to_rim, v * to_rim

    def _load_g(self, outline: Outline, weight_g: float) -> Values:
        kind, rng = self.kind, self.rng
        u, v = self._places(outline)
        pressed = np.where(u * u + v * v <= 1.0, np.maximum(kind.pressure(u, v), 0.0), 0.0)
        share = pressed.reshape(kind.rows, SOWN, kind.columns, SOWN).mean(axis=(1, 3))
        if kind.own_gains:
            share = (kind.foam or blurred)(share, kind.foam_cells)
        mixed = math.sqrt(kind.fixed) * self.own + math.sqrt(1.0 - kind.fixed) * self._field()
        share = share * np.exp(kind.sigma * mixed + self.lines)
        share[rng.random(share.shape) < kind.voids] = 0.0
        if kind.foam_cells and not kind.own_gains:
            share = (kind.foam or blurred)(share, kind.foam_cells)
        total = share.sum()
        load = share * (weight_g / total) if total > 0.0 else share
        stray = rng.random(load.shape) < kind.strays
        load[stray] = rng.uniform(kind.turn_on_g, 20.0 * kind.turn_on_g, int(stray.sum()))
        return load

    def _read(self, load_g: Values) -> Values:
        kind = self.kind
        felt = np.minimum(load_g, kind.saturation_g)
        conductance_s = np.zeros_like(felt)
        on = felt >= kind.turn_on_g
        conductance_s[on] = (felt[on] / 100.0) ** kind.exponent / 80e3
        conductance_s[self.dead] = 0.0
        conductance_s[self.stuck] = 1.0 / STUCK_OHM
        volts = SUPPLY_V * conductance_s / (1.0 / BIAS_OHM + conductance_s.sum(axis=0))
        volts += self.zero_v + kind.noise_v * self.rng.standard_normal(volts.shape)
        if kind.reads == "counts":
            return np.clip(np.round(volts / SUPPLY_V * COUNTS), 0.0, COUNTS)
        return np.round(volts / kind.step_v) * kind.step_v if kind.step_v else volts

    def _calibrated(self, load_g: Values) -> Values:
        """Return grams or kilopascals as read: with noise, in steps, none below 0."""
        kind = self.kind
        felt = np.minimum(load_g, kind.saturation_g)
        felt = felt + kind.noise_g * self.rng.standard_normal(felt.shape)
        felt = np.maximum(np.round(felt / kind.noise_g) * kind.noise_g, 0.0)
        return felt * (KPA_CM2_PER_G / kind.pitch_cm**2) if kind.reads == "kilopascal" else felt


def blurred(values: Values, width: float, unit_variance: bool = False) -> Values:
    """Return values blurred by a Gaussian of ``width`` cells, borders reflected."""
    reach = max(1, math.ceil(4 * width))
    taps = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    taps /= taps.sum()
    for axis in (0, 1):
        padded = np.pad(
            values, [(reach, reach) if a == axis else (0, 0) for a in (0, 1)], "reflect"
        )
        values = np.apply_along_axis(np.convolve, axis, padded, taps, "valid")
    return values / float((taps**2).sum()) if unit_variance else values


def with_tails(values: Values, width: float) -> Values:
    """Return values of which each falls to a part in e over a width in cells, along both axes."""
    reach = 5
    taps = np.exp(-np.abs(np.arange(-reach, reach + 1)) / width)
    for axis in (0, 1):
        padded = np.pad(values, [(reach, reach) if a == axis else (0, 0) for a in (0, 1)])
        values = np.apply_along_axis(np.convolve, axis, padded, taps / taps.sum(), "valid")
    return values


def deep(values: Values, depth: float) -> Values:
    """Return values as felt so many cells down in a thick elastic layer (J. Boussinesq 1885)."""
    reach, fine = 8, (np.arange(-2, 3) / 5.0)
    far = (np.arange(-reach, reach + 1)[:, None] + fine).ravel()
    felt = depth**3 / (far[:, None] ** 2 + far**2 + depth**2) ** 2.5
    taps = felt.reshape(2 * reach + 1, 5, 2 * reach + 1, 5).sum(axis=(1, 3))
    padded, (rows, columns) = np.pad(values, reach), values.shape
    found = np.zeros_like(values)
    for i in range(2 * reach + 1):
        for j in range(2 * reach + 1):
            found += taps[i, j] / taps.sum() * padded[i : i + rows, j : j + columns]
    return found


def to_neighbours(values: Values, share: float) -> Values:
    """Return values that give a share to each of their four neighbours."""
    padded = np.pad(values, 1)
    beside = padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]
    return (1.0 - 4.0 * share) * values + share * beside


def leaning(u: Values, v: Values) -> Values:
    """A face that leans: 1.7 times the mean pressure at one side, 0.3 at the other."""
    return 1.0 + 0.7 * (0.8 * u + 0.6 * v)


def round_face(u: Values, v: Values) -> Values:
    """A ball's pressure, falling to nothing at the rim."""
    return np.sqrt(np.maximum(1.0 - u * u - v * v, 0.0))


def hollow(u: Values, v: Values) -> Values:
    """A ring of half the radius inside: a cup put down."""
    return (u * u + v * v >= 0.36).astype(float)


def ring(inside: float) -> Pressure:
    """A cup put down, whose rim is wide from a share of the radius on."""
    return lambda u, v: (u * u + v * v >= inside * inside).astype(float)


BASE = Kind()
SMALL = ((300.0, 1.6), (500.0, 2.0), (800.0, 2.4))
SMALL_RECTANGLES = ((500.0, 5.0, 3.0), (800.0, 6.5, 4.0))

KINDS: dict[str, Kind] = {
    "noise 0": replace(BASE, noise_v=0.0),
    "noise 0.2 mV": BASE,
    "noise 1 mV": replace(BASE, noise_v=1e-3),
    "noise 1.6 mV": replace(BASE, noise_v=1.6e-3),
    "noise 3 mV": replace(BASE, noise_v=3e-3),
    "noise 5 mV": replace(BASE, noise_v=5e-3),
    "law 1/F": replace(BASE, exponent=1.0),
    "law 1/F^2": replace(BASE, exponent=2.0),
    "turn-on 2 g": replace(BASE, turn_on_g=2.0),
    "turn-on 40 g": replace(BASE, turn_on_g=40.0),
    "saturation 60 g": replace(BASE, saturation_g=60.0),
    "gains 0.2": replace(BASE, sigma=0.2),
    "gains 0.9": replace(BASE, sigma=0.9),
    "gains fixed": replace(BASE, fixed=1.0),
    "gains correlated": replace(BASE, correlation_cells=1.5),
    "gains by row": replace(BASE, sigma=0.3, line_sigma=0.5),
    "voids 0": replace(BASE, voids=0.0),
    "voids 0.4": replace(BASE, voids=0.4),
    "strays 1 %": replace(BASE, strays=0.01),
    "strays 4 %": replace(BASE, strays=0.04),
    "dead row": replace(BASE, dead_rows=1),
    "dead column": replace(BASE, dead_columns=1),
    "12 dead elements": replace(BASE, dead_elements=12),
    "3 stuck elements": replace(BASE, stuck_elements=3),
    "leaning face": replace(BASE, pressure=leaning),
    "round face": replace(BASE, pressure=round_face),
    "hollow face": replace(BASE, pressure=hollow),
    "foam 0.6 cells": replace(BASE, foam_cells=0.6),
    "small objects": replace(BASE, discs=SMALL, rectangles=SMALL_RECTANGLES),
    "over the edge": replace(BASE, over_edge=True),
    "drift 5 mV": replace(BASE, offset_v=5e-3),
    "8 bits": replace(BASE, noise_v=1.6e-3, step_v=10.0 / 256),
}
"""Name -> kind; all but the one thing named are as in `BASE`."""

FINGERS = replace(KINDS["small objects"], strays=0.01)

FOAM = KINDS["foam 0.6 cells"]
OVER = replace(FOAM, own_gains=True)
"""Foam over elements that are uneven themselves."""

EVEN = replace(
    BASE, element_cm=0.716, sigma=0.03, voids=0.0, noise_g=0.5, reads="kilopascal",
    discs=((580.0, 2.5), (1500.0, 4.0), (2800.0, 5.5)),
    rectangles=((1900.0, 9.0, 7.0), (760.0, 9.5, 2.6)),
)  # fmt: skip
"""A calibrated pad of the pitch 1.016 cm, its elements nearly alike."""

MORE_KINDS: dict[str, Kind] = {
    "fingertips and strays": FINGERS,
    "light fingertips and strays": replace(FINGERS, discs=((150.0, 1.2), (200.0, 1.5))),
    "law 1/F^1.2": replace(BASE, exponent=1.2),
    "law 1/F^1.75": replace(BASE, exponent=1.75),
    "law 1/F, noise 3 mV": replace(BASE, exponent=1.0, noise_v=3e-3),
    "law 1/F, gains 0.3": replace(BASE, exponent=1.0, sigma=0.3),
    "law 1/F^1.2, turn-on 20 g": replace(BASE, exponent=1.2, turn_on_g=20.0),
    "law 1/F^1.75, turn-on 5 g, gains 0.7": replace(BASE, exponent=1.75, turn_on_g=5.0, sigma=0.7),
    "turn-on 4 g": replace(BASE, turn_on_g=4.0),
    "turn-on 20 g": replace(BASE, turn_on_g=20.0),
    "turn-on 20 g, gains 0.3": replace(BASE, turn_on_g=20.0, sigma=0.3),
    "gains 0.3": replace(BASE, sigma=0.3),
    "gains 0.7": replace(BASE, sigma=0.7),
    "ring of 0.4": replace(BASE, pressure=ring(0.4)),
    "ring of 0.8": replace(BASE, pressure=ring(0.8)),
    "ring of 0.6, voids 0.3": replace(BASE, pressure=ring(0.6), voids=0.3),
    "ring of 0.6, noise 1.6 mV": replace(BASE, pressure=ring(0.6), noise_v=1.6e-3),
    "foam 0.5 cells": replace(BASE, foam_cells=0.5),
    "foam 0.7 cells": replace(BASE, foam_cells=0.7),
    "foam 0.9 cells": replace(BASE, foam_cells=0.9),
    "foam 1.2 cells": replace(BASE, foam_cells=1.2),
    "foam, noise 3 mV": replace(FOAM, noise_v=3e-3),
    "foam, 8 bits": replace(FOAM, noise_v=1.6e-3, step_v=10.0 / 256),
    "foam, voids 0": replace(FOAM, voids=0.0),
    "foam, gains 0.2": replace(FOAM, sigma=0.2),
    "foam, turn-on 2 g": replace(FOAM, turn_on_g=2.0),
    "foam, law 1/F": replace(FOAM, exponent=1.0),
    "foam, law 1/F^2": replace(FOAM, exponent=2.0),
    "foam, leaning face": replace(FOAM, pressure=leaning),
    "foam, round face": replace(FOAM, pressure=round_face),
    "foam, small objects": replace(FOAM, discs=SMALL, rectangles=SMALL_RECTANGLES),
    "foam, over the edge": replace(FOAM, over_edge=True),
    "foam, strays 1 %": replace(FOAM, strays=0.01),
    "foam 0.4 cells, own gains": replace(OVER, foam_cells=0.4),
    "foam 0.6 cells, own gains": OVER,
    "foam 0.9 cells, own gains": replace(OVER, foam_cells=0.9),
    "foam 0.4 cells, own gains 0.2": replace(OVER, foam_cells=0.4, sigma=0.2, voids=0.0),
    "foam 0.6 cells, own gains 0.2": replace(OVER, sigma=0.2, voids=0.0),
    "foam 0.9 cells, own gains 0.2": replace(OVER, foam_cells=0.9, sigma=0.2, voids=0.0),
    "foam, own gains, noise 3 mV": replace(OVER, noise_v=3e-3),
    "foam, own gains, small objects": replace(OVER, discs=SMALL, rectangles=SMALL_RECTANGLES),
    "foam, own gains, round face": replace(OVER, pressure=round_face),
    "deep foam 0.5 cells, own gains": replace(OVER, foam_cells=0.5, foam=deep),
    "deep foam 1 cell, own gains": replace(OVER, foam_cells=1.0, foam=deep),
    "deep foam 1 cell, own gains 0.2": replace(
        OVER, foam_cells=1.0, foam=deep, sigma=0.2, voids=0.0
    ),
    "deep foam 1 cell": replace(BASE, foam_cells=1.0, foam=deep),
    "round face, gains 0.2": replace(KINDS["round face"], sigma=0.2, voids=0.0),
    "foam with tails": replace(BASE, foam_cells=0.8, foam=with_tails),
    "to neighbours": replace(BASE, foam_cells=0.15, foam=to_neighbours),
    "even": EVEN,
    "even, gap 0": replace(EVEN, element_cm=1.016, gap_cm=0.0),
    "even, gap 0.12 cm": replace(EVEN, element_cm=0.896, gap_cm=0.12),
    "even to 1 %": replace(EVEN, sigma=0.01),
    "even to 10 %": replace(EVEN, sigma=0.1),
    "even, grams": replace(EVEN, reads="gram"),
    "even, pitch 1.3 cm": replace(EVEN, element_cm=1.0),
    "even, little noise": replace(EVEN, noise_g=0.05),
    "even, saturated": replace(EVEN, saturation_g=6.0, noise_g=0.05),
    "even, volts": replace(BASE, sigma=0.03, voids=0.0),
    "calibrated": replace(EVEN, sigma=0.5, voids=0.15),
    "calibrated, gap 0": replace(EVEN, sigma=0.5, voids=0.15, element_cm=1.016, gap_cm=0.0),
    "counts": replace(BASE, reads="counts", sigma=0.3, turn_on_g=5.0),
    "counts, gap 0.12 cm": replace(
        BASE,
        reads="counts",
        sigma=0.3,
        turn_on_g=5.0,
        element_cm=0.896,
        gap_cm=0.12,
        discs=EVEN.discs,
        rectangles=EVEN.rectangles,
    ),
}
"""Kinds that are looked at by name only."""
