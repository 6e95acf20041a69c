"""Recordings of known loads on groups of four elements, for the tests of calibration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Frame, Rectangle, TrueObject
from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_sources.writers.write_npz import write_npz

GRAMS = (60.0, 120.0, 200.0, 320.0, 480.0, 700.0, 1000.0, 1500.0)


def on_four(pad: Pad, weight_g: float, corner: tuple[int, int] = (3, 4)) -> NDArray[np.float64]:
    """Loads of a weight shared evenly by four neighbours."""
    load = np.zeros(pad.geometry.shape)
    row, column = corner
    load[row : row + 2, column : column + 2] = weight_g / 4.0
    return load


def frame(
    pad: Pad,
    weight_g: float,
    index: int = 0,
    corner: tuple[int, int] = (3, 4),
    truth: bool = False,
    quantity: str = "volt",
) -> Frame:
    """One reading of a weight on four elements."""
    volts = pad.forward(on_four(pad, weight_g, corner))
    values = pad.converter.counts(volts) if quantity == "counts" else volts
    shape = Rectangle(5.0 + corner[1], 4.0 + corner[0], 2.3, 2.3, 0.0)
    known = (TrueObject(shape, weight_g),) if weight_g else ()
    return Frame(pad.image(values, quantity), index, truth=known if truth else None)


def one_file(path: Path, grams: Sequence[float] = GRAMS, pad: Pad | None = None) -> Path:
    """A recording whose frames hold the truth of many loads, after one of the empty pad."""
    pad = pad or load_pad("plain")
    write_npz(path, [frame(pad, g, k, truth=True) for k, g in enumerate((0.0, *grams))])
    return path


def many_files(
    folder: Path, grams: Sequence[float] = GRAMS, quantity: str = "volt", pad: Pad | None = None
) -> list[str]:
    """A recording for each load, as ``FILE=GRAMS``."""
    pad = pad or load_pad("plain")
    given = []
    for g in grams:
        path = folder / f"load-{g:g}.npz"
        write_npz(path, [frame(pad, g, k, quantity=quantity) for k in range(3)])
        given.append(f"{path}={g:g}")
    return given


def counting_pad() -> Pad:
    """The even pad with the thesis' converter."""
    return replace(load_pad("plain"), converter=load_pad("thesis").converter)
