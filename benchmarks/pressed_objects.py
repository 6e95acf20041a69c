"""Everyday objects pressed on foreign pads, without a line of the project's own pad physics.

An object is a relief: how far each point of its face lies behind the foremost one. Pressed into a
cover of a few millimetres that gives way like a bed of springs, it touches over more of its face
the harder it is pressed, as a ball, a key or a finger does. Pads differ in grid, pitch, blur, law,
gains, zero and converter; each frame holds raw counts. Catalogues of objects, pads and presses are
drawn from seeded generators, so that what is reported can be of other objects, on another pad, than
what settings were tuned on.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame

Values = NDArray[np.float64]
Relief = Callable[[Values, Values], Values]
"""Of u and v in cm from the object's middle: depth in cm behind the face, infinite beside it."""
BORNE = 0.06
"""Share of a pad's elements that a force of 1 would bring to full scale."""
SOWN = 3
"""Points along each side of an element."""


@dataclass(frozen=True)
class Thing:
    """An object: its name, face, and the force it is usually pressed with, of a full scale of 1."""

    name: str
    relief: Relief
    force: float


@dataclass(frozen=True)
class Instrument:
    """A pad as sold, and how it is used."""

    rows: int
    columns: int
    pitch_cm: float
    blur_cells: float
    full_scale: float
    """Counts at which the converter ends."""
    law: float
    """Counts go with the load to this power."""
    threshold: float
    """Load below which an element reads nothing, of the load that reads full scale."""
    gain_spread: float
    noise_counts: float
    zero_counts: float
    """Largest zero of an element that drifts from session to session."""
    cover_cm: float = 0.15
    """How far the cover gives way under a pressure that reads full scale."""
    force_spread: float = 0.4
    """Of the logarithm of the force from press to press."""
    tilt: float = 0.035
    """Largest slope of a face to the pad."""


CAPACITIVE = Instrument(32, 32, 0.4, 0.7, 4095.0, 1.0, 0.004, 0.08, 4.0, 10.0)
RESISTIVE = Instrument(28, 50, 0.19, 0.35, 255.0, 0.8, 0.02, 0.12, 0.6, 0.0, cover_cm=0.1)
STRIP = Instrument(12, 40, 0.5, 0.5, 1023.0, 0.9, 0.01, 0.1, 1.0, 2.0)
INSTRUMENTS = {"capacitive": CAPACITIVE, "resistive": RESISTIVE, "strip": STRIP}


# -- faces -----------------------------------------------------------------------------------


def behind(inside: Values, depth: Values | float = 0.0) -> Values:
    """Return the relief of a face whose inside is where ``inside`` is below 0; its rim is round."""
    rim = np.maximum(inside, 0.0)
    return np.where(rim < 0.05, depth + 40.0 * rim * rim, np.inf)


def disc(radius: float, dome: float = 0.0) -> Relief:
    """A disc, flat or domed."""
    return lambda u, v: behind(np.hypot(u, v) - radius, dome * (u * u + v * v))


def ring(radius: float, breadth: float) -> Relief:
    """A rim: a cup, a tape, a can."""
    return lambda u, v: behind(np.abs(np.hypot(u, v) - radius + breadth / 2) - breadth / 2)


def box(length: float, breadth: float, dome: float = 0.0) -> Relief:
    """A box, or with a dome along one axis a pipe."""
    return lambda u, v: behind(
        np.maximum(np.abs(u) - length / 2, np.abs(v) - breadth / 2), dome * v * v
    )


def frame(length: float, breadth: float, rim: float) -> Relief:
    """The rim of a box."""

    def relief(u: Values, v: Values) -> Values:
        out = np.maximum(np.abs(u) - length / 2, np.abs(v) - breadth / 2)
        return behind(np.abs(out + rim / 2) - rim / 2)

    return relief


def ellipse(length: float, breadth: float, dome: float) -> Relief:
    """An ellipse, flat or domed: a mouse, a pebble, a palm."""
    return lambda u, v: behind(
        (np.hypot(2 * u / length, 2 * v / breadth) - 1.0) * breadth / 2,
        dome * (u * u + (length / breadth) ** 2 * v * v),
    )


def both(*parts: Relief) -> Relief:
    """What is of several parts."""
    return lambda u, v: np.minimum.reduce([part(u, v) for part in parts])


def moved(part: Relief, u_cm: float, v_cm: float, turn: float = 0.0, back: float = 0.0) -> Relief:
    """A part at another place, turned, and further back."""
    cos, sin = math.cos(turn), math.sin(turn)

    def relief(u: Values, v: Values) -> Values:
        du, dv = u - u_cm, v - v_cm
        return part(du * cos + dv * sin, dv * cos - du * sin) + back

    return relief


def feet(n: int, apart: float, foot: Relief) -> Relief:
    """So many feet around the middle."""
    turns = 2.0 * math.pi * np.arange(n) / n
    return both(*(moved(foot, apart * math.cos(t), apart * math.sin(t), t) for t in turns))


def pebble(size: float, dome: float, rng: np.random.Generator) -> Relief:
    """An irregular outline, and bumps on the face."""
    k = np.arange(2, 6)
    amplitudes, phases = rng.normal(0.0, 0.22, 4) / np.sqrt(k - 1), rng.uniform(0, 2 * math.pi, 4)
    waves, slopes = rng.uniform(0, 2 * math.pi, 3), rng.normal(0.0, 3.0 / size, (3, 2))

    def relief(u: Values, v: Values) -> Values:
        angle = np.arctan2(v, u)[..., None]
        rim = size * (1.0 + (amplitudes * np.cos(k * angle - phases)).sum(axis=-1))
        bumps = np.cos(u[..., None] * slopes[:, 0] + v[..., None] * slopes[:, 1] + waves)
        return behind(np.hypot(u, v) - rim, dome * (u * u + v * v) + 0.02 * (1 - bumps).sum(-1))

    return relief


def catalogue(instrument: Instrument, rng: np.random.Generator, prefix: str = "") -> list[Thing]:
    """Return 22 objects that suit a pad, four of them a little larger or flatter than another."""
    room = min(instrument.rows, instrument.columns) * instrument.pitch_cm
    some = lambda low, high: room * rng.uniform(low, high)  # noqa: E731
    r, r2, r3, s = some(0.1, 0.2), some(0.2, 0.35), some(0.22, 0.36), some(0.14, 0.28)
    length, breadth = some(0.5, 0.75), some(0.2, 0.35)
    pipe, bar, mouse = some(0.8, 1.4), some(0.8, 1.2), some(0.4, 0.7)
    fine, head = some(0.04, 0.08), some(0.08, 0.16)
    width = some(0.05, 0.09)
    faces: dict[str, Relief] = {
        "coin": disc(r), "larger coin": disc(1.15 * r), "lid": disc(r2),
        "ball": disc(r2, 1.2 / room), "flatter ball": disc(r2, 0.6 / room),
        "tape": ring(r3, width), "cup": ring(r3, 0.6 * width), "can": ring(0.8 * r3, width),
        "box": box(length, breadth), "longer box": box(1.15 * length, breadth),
        "cube": box(s, s), "tray": frame(length, 1.4 * breadth, width),
        "pipe": box(pipe, 0.4 * room, 3.0 / room), "bar": box(bar, fine),
        "mouse": ellipse(mouse, 0.6 * mouse, 0.5 / room),
        "palm": pebble(some(0.25, 0.4), 0.4 / room, rng),
        "stone": pebble(some(0.15, 0.3), 1.0 / room, rng),
        "plug": feet(2, some(0.12, 0.2), disc(fine)),
        "stool": feet(3, some(0.2, 0.3), disc(0.8 * fine)),
        "pliers": both(moved(box(length, fine), 0, fine, 0.12), moved(box(length, fine), 0, -fine,
                                                                       -0.12)),
        "key": both(disc(head), moved(box(3 * head, 0.8 * fine), 2.2 * head, 0.0, 0.0, 0.01)),
        "comb": both(box(length, fine), *(moved(box(fine / 1.5, 3 * fine), x * length / 2, fine * 2)
                                          for x in (-0.8, -0.4, 0.0, 0.4, 0.8))),
    }  # fmt: skip
    return [Thing(prefix + name, face, rng.uniform(0.35, 1.0)) for name, face in faces.items()]


# -- pads ------------------------------------------------------------------------------------


class Pad:
    """One pad as built: on it things are pressed, in sessions between which it drifts."""

    def __init__(self, instrument: Instrument, rng: np.random.Generator) -> None:
        self.instrument, self.rng = instrument, rng
        shape = (instrument.rows, instrument.columns)
        self.gains = np.exp(instrument.gain_spread * rng.standard_normal(shape))
        self.begin_session()
        at = lambda n: ((np.arange(n * SOWN) + 0.5) / SOWN) * instrument.pitch_cm  # noqa: E731
        self.x, self.y = np.meshgrid(at(instrument.columns), at(instrument.rows))
        reach = max(1, math.ceil(3 * instrument.blur_cells * SOWN))
        self.taps = np.exp(-0.5 * (np.arange(-reach, reach + 1)
                                   / (instrument.blur_cells * SOWN)) ** 2)  # fmt: skip
        self.taps /= self.taps.sum()

    def begin_session(self) -> None:
        """Let zeros and gains drift."""
        shape = self.gains.shape
        self.zero = self.instrument.zero_counts * self.rng.uniform(0.0, 1.0, shape)
        self.drift = math.exp(0.04 * self.rng.standard_normal())

    def press(self, thing: Thing, index: int = 0) -> Frame:
        """Return the raw counts of a thing pressed somewhere, any way round, leaning a little."""
        it, rng = self.instrument, self.rng
        width, height = it.columns * it.pitch_cm, it.rows * it.pitch_cm
        x, y = width * rng.uniform(0.25, 0.75), height * rng.uniform(0.25, 0.75)
        turn = rng.uniform(0.0, 2.0 * math.pi)
        cos, sin = math.cos(turn), math.sin(turn)
        du, dv = self.x - x, self.y - y
        u, v = du * cos + dv * sin, dv * cos - du * sin
        lean = rng.uniform(0.0, it.tilt) * np.array([math.cos(turn * 7.0), math.sin(turn * 7.0)])
        depth = thing.relief(u, v)
        depth = np.where(np.isfinite(depth), depth + lean[0] * u + lean[1] * v, np.inf)
        total = thing.force * math.exp(it.force_spread * rng.standard_normal())
        pressure = self._pressed(depth, total)
        return Frame.of(self._read(pressure), it.pitch_cm, quantity="raw", index=index,
                        label=thing.name)  # fmt: skip

    def _pressed(self, depth: Values, total: float) -> Values:
        """Return the pressure at the sown points, of full scale, that makes up the force."""
        cover = self.instrument.cover_cm
        wanted = BORNE * depth.size * total  # points times full scale
        low = float(depth.min())
        high = low + cover * 50.0
        for _ in range(40):
            middle = 0.5 * (low + high)
            enough = np.maximum(middle - depth, 0.0).sum() / cover > wanted
            low, high = (low, middle) if enough else (middle, high)
        return np.asarray(np.maximum(high - depth, 0.0) / cover)

    def _read(self, pressure: Values) -> Values:
        it, rng = self.instrument, self.rng
        for axis in (0, 1):
            pressure = np.apply_along_axis(np.convolve, axis, pressure, self.taps, "same")
        load = pressure.reshape(it.rows, SOWN, it.columns, SOWN).mean(axis=(1, 3))
        felt = np.maximum(load * self.gains * self.drift - it.threshold, 0.0) ** it.law
        counts = (
            it.full_scale * felt + self.zero + it.noise_counts * rng.standard_normal(load.shape)
        )
        return np.asarray(np.clip(np.round(counts), 0.0, it.full_scale))
