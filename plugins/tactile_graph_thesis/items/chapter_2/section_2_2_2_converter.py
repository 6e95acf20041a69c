"""Section 2.2.2, study ``converter``: counts to grams against bits, noise and load."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.pad import Pad
from tactile_graph_pads.scan import Converter, Scan
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
LOAD_G = np.geomspace(10.0, 20_000.0, 34)
N_LOADED = 8
"""Elements of each column under the load: a large disc's column."""
BITS = (8, 10, 12, 14, 16)
NOISES_V = (0.0, 0.0005, 0.002, 0.01)
N_FRAMES = 12


class ConverterErrors(NamedTuple):
    """How far grams are off after counts, volts, decoupling and the inverse force law.

    Parameters
    ----------
    load_g : ndarray, shape (n,)
        On each of the loaded elements.
    column_sum : ndarray, shape (n,)
        T, the sum of a column's readings over the supply; at 1 the divider has no answer.
    bits : ndarray, shape (b,)
    of_bits_percent : ndarray, shape (b, n)
        Rms error over the elements that have an answer, without noise; 0 where there is none.
    of_bits_lost : ndarray, shape (b, n)
        Share of the loaded elements without an answer.
    noise_v : ndarray, shape (m,)
        Of the mean over the scan's samples.
    of_noise_percent, of_noise_lost : ndarray, shape (m, n)
        The same for the pad's own converter.
    """

    load_g: Array
    column_sum: Array
    bits: Array
    of_bits_percent: Array
    of_bits_lost: Array
    noise_v: Array
    of_noise_percent: Array
    of_noise_lost: Array


def converter_errors(pad: Pad, rng: np.random.Generator) -> ConverterErrors:
    """Return the error of grams against bits, noise and load.

    Parameters
    ----------
    pad : Pad
        Its law, circuit and range are meant; unevenness and defects are left out.
    rng : numpy.random.Generator

    Notes
    -----
    Eight elements of each column bear a load drawn within 10 % of the nominal one, so that the
    rounding is not everywhere the same.
    """
    even = replace(pad, defects=type(pad.defects)())
    own = pad.converter.bits
    by_bits = [_errors(even, _with_bits(pad, bits), 0.0, rng) for bits in BITS]
    by_noise = [_errors(even, _with_bits(pad, own), noise, rng) for noise in NOISES_V]
    return ConverterErrors(
        LOAD_G,
        np.array([_column_sum(even, float(g)) for g in LOAD_G]),
        np.array(BITS, dtype=np.float64),
        np.array([percent for percent, _ in by_bits]),
        np.array([lost for _, lost in by_bits]),
        np.array(NOISES_V),
        np.array([percent for percent, _ in by_noise]),
        np.array([lost for _, lost in by_noise]),
    )


def _with_bits(pad: Pad, bits: int | None) -> Converter:
    return replace(pad.converter, bits=bits)


def _loaded(pad: Pad, load_g: float, rng: np.random.Generator) -> Array:
    bears = np.zeros(pad.geometry.shape)
    part = bears[:N_LOADED]
    part[...] = load_g * rng.uniform(0.9, 1.1, part.shape)
    return bears


def _column_sum(pad: Pad, load_g: float) -> float:
    bears = np.zeros(pad.geometry.shape)
    bears[:N_LOADED] = load_g
    return float(pad.forward(bears)[:, 0].sum() / pad.circuit.supply_v)


def _errors(
    pad: Pad, reader: Converter, noise_v: float, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Return rms error in percent and share of lost elements for each load."""
    scan = Scan(samples=1, noise_v=noise_v)
    percent, lost = np.zeros(len(LOAD_G)), np.zeros(len(LOAD_G))
    for k, grams in enumerate(LOAD_G):
        off = []
        n = 0
        for _ in range(N_FRAMES):
            bears = _loaded(pad, float(grams), rng)
            counts = scan.counts(pad.forward(bears), reader, rng)
            found = pad.backward(reader.volts(counts))
            good = found.valid[:N_LOADED]
            n += good.size
            off.append((found.load_g[:N_LOADED] / bears[:N_LOADED] - 1.0)[good])
        all_off = np.concatenate(off)
        lost[k] = 1.0 - all_off.size / n
        percent[k] = 100.0 * np.sqrt((all_off**2).mean()) if all_off.size else 0.0
    return percent, lost


def _table(found: ConverterErrors) -> Table:
    bits = [f"{b:.0f} bits {w}%" for b in found.bits for w in ("", "lost ")]
    noise = [f"{1e3 * v:g} mV {w}%" for v in found.noise_v for w in ("", "lost ")]
    pairs = [
        np.stack([percent, 100.0 * lost], axis=1).reshape(-1, len(found.load_g))
        for percent, lost in (
            (found.of_bits_percent, found.of_bits_lost),
            (found.of_noise_percent, found.of_noise_lost),
        )
    ]
    values = np.column_stack([found.load_g, found.column_sum, *(p.T for p in pairs)])
    columns = ("load_g", "T", *bits, *noise)
    return Table(columns, [tuple(map(float, row)) for row in values])


def usable_g(
    load_g: Array, percent: Array, lost: Array, within: float = 5.0
) -> tuple[float, float]:
    """Return the lightest and heaviest load of the stretch read within a share; 0 if none.

    Parameters
    ----------
    load_g, percent, lost : ndarray, shape (n,)
    within : float
        Rms error in percent.
    """
    good = (percent <= within) & (lost == 0.0)
    if not good.any():
        return 0.0, 0.0
    return float(load_g[good].min()), float(load_g[good].max())


def _findings(found: ConverterErrors) -> tuple[Finding, ...]:
    by_bits, by_noise = (
        [usable_g(found.load_g, p, n) for p, n in zip(percent, lost, strict=True)]
        for percent, lost in (
            (found.of_bits_percent, found.of_bits_lost),
            (found.of_noise_percent, found.of_noise_lost),
        )
    )
    twelve = int(np.flatnonzero(found.bits == 12)[0])
    top_g = by_bits[twelve][1]
    at = int(np.argmin(abs(found.load_g - top_g)))
    wider = all(more[1] >= fewer[1] for fewer, more in pairwise(by_bits))
    narrower = all(more[1] <= fewer[1] for fewer, more in pairwise(by_noise))
    return (
        Finding(
            "(not in the thesis) with eight loaded elements a column, grams are within 5 % rms",
            _ranges([f"{bits:.0f} bits" for bits in found.bits], by_bits),
            "an end at 200 g or less, or more bits with a narrower range",
            bool(top_g > 200.0 and wider),
        ),
        Finding(
            "(not in the thesis) the edge is where a column's readings add up to the supply",
            f"at 12 bits the 5 % end at {top_g:.0f} g an element, T = "
            f"{found.column_sum[at]:.4f}; the first lost elements at T = "
            f"{_first_lost(found, twelve)}",
            "an end where the readings add up to nine tenths of the supply or less",
            bool(found.column_sum[at] > 0.9),
        ),
        Finding(
            "(not in the thesis) noise of the mean reading narrows it from both ends",
            _ranges([f"{1e3 * v:g} mV" for v in found.noise_v], by_noise),
            "more noise with a wider range",
            narrower,
        ),
    )


def _ranges(names: list[str], usable: list[tuple[float, float]]) -> str:
    """Return in words from which to which load each is usable."""
    return ", ".join(
        f"{name} {low:.0f} to {high:.0f} g" if high else f"{name} nowhere"
        for name, (low, high) in zip(names, usable, strict=True)
    )


def _first_lost(found: ConverterErrors, which: int) -> str:
    some = np.flatnonzero(found.of_bits_lost[which])
    if not some.size:
        return "none"
    return f"{found.column_sum[some[0]]:.4f} ({found.load_g[some[0]]:.0f} g)"


def _figure(found: ConverterErrors) -> Figure:
    figure = new_figure(12.0, 5.0)
    both = figure.subplots(1, 2, sharey=True)
    families = (
        (both[0], found.of_bits_percent, found.of_bits_lost,
         [f"{b:.0f} bits" for b in found.bits], "rounding alone"),
        (both[1], found.of_noise_percent, found.of_noise_lost,
         [f"{1e3 * v:g} mV" for v in found.noise_v], "noise of the mean, the pad's converter"),
    )  # fmt: skip
    for axes, percent, lost, names, title in families:
        for k, name in enumerate(names):
            whole = (lost[k] < 0.5) & (percent[k] > 0.0)
            axes.loglog(found.load_g[whole], percent[k][whole], color=f"C{k}", label=name)
            some = whole & (lost[k] > 0.0)
            axes.loglog(found.load_g[some], percent[k][some], "x", color=f"C{k}")
        axes.set(title=title, xlabel="load on 8 elements a column / g each")
        axes.grid(alpha=0.3, which="both")
        axes.legend(title="× some without an answer")
    both[0].set_ylabel("rms error of grams / %")
    both[0].set_ylim(1e-3, 3e2)
    return figure


def _converter(work: Work) -> Made:
    found = work.on_pad(converter_errors)
    return Made(findings=_findings(found), table=_table(found), figure=_figure(found))


ITEMS = (
    Item(
        "converter",
        "From counts to grams",
        "Error of grams against bits, noise and load, up to the edge of saturation.",
        _converter,
        "The thesis has no such numbers: it gives the converter's bits and range only.",
        after="2.2.2",
    ),
)
