"""Section 2.2.3, study ``samples``: the error of a reading against how many samples it averages."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.pad import Pad
from tactile_graph_pads.scan import Converter, Scan
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
SAMPLES_TRIED = (1, 2, 5, 10, 20, 50, 100, 200)
NOISES_V = (0.0002, 0.002, 0.01)
LOAD_G = 100.0
N_FRAMES = 20


def scan_error_v(
    samples: ArrayLike,
    volts: Array,
    rng: np.random.Generator,
    noise_v: float = 0.002,
    converter: Converter | None = None,
    n_scans: int = 20,
) -> Array:
    """Return the root mean square error of a scan against its number of samples, in volts.

    Thesis section 2.2.3 averages 100 samples and finds 10 as good.

    Parameters
    ----------
    samples : array_like of int, shape (n,)
        Numbers of samples to try.
    volts : ndarray of float64, shape (rows, columns)
        What truly stands at the converter's input.
    rng : numpy.random.Generator
    noise_v : float
        Standard deviation of one sample.
    converter : Converter, optional
        The thesis' 12 bits over -5 to 5 V by default.
    n_scans : int
        How many scans are averaged over.
    """
    reader = converter or Converter()
    errors = np.empty(np.atleast_1d(samples).size)
    for k, n in enumerate(np.atleast_1d(samples)):
        scan = Scan(samples=int(n), noise_v=noise_v)
        squares = [
            np.mean((reader.volts(scan.counts(volts, reader, rng)) - volts) ** 2)
            for _ in range(n_scans)
        ]
        errors[k] = np.sqrt(np.mean(squares))
    return errors


class SampleErrors(NamedTuple):
    """Errors against the number of samples averaged.

    Parameters
    ----------
    samples : ndarray, shape (n,)
    noise_v : ndarray, shape (m,)
        Noise of one sample.
    error_v : ndarray, shape (m, n)
        Root mean square error of a reading, before the pad's own repeatability.
    repeatability_v : float
        What the pad's repeatability alone makes of a reading of 100 g.
    step_v : float
        One count of the converter.
    frame_s : ndarray, shape (n,)
        Time a whole scan takes.
    """

    samples: Array
    noise_v: Array
    error_v: Array
    repeatability_v: float
    step_v: float
    frame_s: Array

    @property
    def total_v(self) -> Array:
        """Error of a reading of 100 g, repeatability included, shape (m, n)."""
        return np.hypot(self.error_v, self.repeatability_v)


def sample_errors(pad: Pad, rng: np.random.Generator) -> SampleErrors:
    """Return the error of a reading against the number of samples, at several noises.

    Parameters
    ----------
    pad : Pad
        Its converter, circuit, law and sample time are meant.
    rng : numpy.random.Generator
    """
    tried = np.array(SAMPLES_TRIED, dtype=np.float64)
    volts = rng.uniform(0.0, 2.0, (16, 16))
    error = [
        scan_error_v(SAMPLES_TRIED, volts, rng, noise, pad.converter, N_FRAMES)
        for noise in NOISES_V
    ]
    step = pad.converter.step_v if pad.converter.bits else 0.0
    seconds = pad.scan.sample_s * pad.geometry.rows * pad.geometry.columns * tried
    return SampleErrors(
        tried, np.array(NOISES_V), np.array(error), _repeatability_v(pad, rng), step, seconds
    )


def _repeatability_v(pad: Pad, rng: np.random.Generator) -> float:
    """Return the scatter of one lone element under 100 g, in volts."""
    siemens = 1.0 / pad.law.resistance_at(LOAD_G)
    scattered = siemens * np.exp(pad.law.repeatability * rng.standard_normal((1, 4000)))
    # one element a column: nothing couples, so the scatter is the element's own
    return float(replace(pad, defects=type(pad.defects)()).volts_of(scattered).std())


def _table(found: SampleErrors) -> Table:
    names = [f"error_mV at {1e3 * n:g} mV" for n in found.noise_v]
    columns = ("samples", "frame_s", *names, "with repeatability_mV")
    rows = [
        (int(n), round(float(s), 3), *(1e3 * found.error_v[:, k]), 1e3 * found.total_v[1, k])
        for k, (n, s) in enumerate(zip(found.samples, found.frame_s, strict=True))
    ]
    return Table(columns, rows)


def _findings(found: SampleErrors) -> tuple[Finding, ...]:
    ten, hundred = (int(np.flatnonzero(found.samples == n)[0]) for n in (10, 100))
    error, total = 1e3 * found.error_v[1], 1e3 * found.total_v[1]
    ratio = total[ten] / total[hundred]
    quiet = found.error_v[0]
    return (
        Finding(
            "10 samples work as well as 100 (2.2.3)",
            f"reading error {error[ten]:.2f} mV with 10, {error[hundred]:.2f} mV with 100, of a "
            f"step of {1e3 * found.step_v:.2f} mV; with the pad's repeatability "
            f"({1e3 * found.repeatability_v:.0f} mV at 100 g) {ratio:.4f} times as large",
            "an error with 10 that is a twentieth larger than with 100",
            bool(ratio < 1.05),
        ),
        Finding(
            "a whole scan takes less than one minute (2.2.3)",
            f"{found.frame_s[hundred]:.1f} s with 100 samples, {found.frame_s[ten]:.1f} s with 10",
            "a minute or more with 100 samples",
            bool(found.frame_s[hundred] < 60.0),
        ),
        Finding(
            "(not in the thesis) 100 samples gain a factor of ten only where the noise reaches a "
            "converter step: less noise leaves the rounding in",
            f"at {1e3 * found.noise_v[0]:g} mV of noise 1 sample errs by {1e3 * quiet[0]:.2f} mV, "
            f"100 by {1e3 * quiet[hundred]:.2f} mV",
            "at the least noise an error halved by 100 samples, or at the pad's own less than a "
            "sevenfold gain",
            bool(quiet[hundred] > 0.5 * quiet[0] and error[hundred] < 0.15 * error[0]),
        ),
    )


def _figure(found: SampleErrors) -> Figure:
    figure = new_figure()
    axes = figure.subplots()
    for noise, error in zip(found.noise_v, found.error_v, strict=True):
        axes.loglog(found.samples, 1e3 * error, "o-", label=f"noise {1e3 * noise:g} mV a sample")
    axes.loglog(
        found.samples, 1e3 * found.total_v[1], "k--", label="2 mV, with repeatability at 100 g"
    )
    if found.step_v:
        rounding = 1e3 * found.step_v / np.sqrt(12.0)
        axes.axhline(rounding, color="0.6", ls=":", label="one step, rounded")
    axes.set(xlabel="samples averaged", ylabel="rms error of a reading / mV")
    axes.set_title("Error of a reading against samples averaged")
    figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    axes.grid(alpha=0.3, which="both")
    return figure


def _samples(work: Work) -> Made:
    found = work.on_pad(sample_errors)
    return Made(findings=_findings(found), table=_table(found), figure=_figure(found))


ITEMS = (
    Item(
        "samples",
        "How many samples a reading averages",
        "Error of a reading against how many samples are averaged, 100 against 10.",
        _samples,
        "The noise of a single sample is not given; three are tried.",
        after="2.2.3",
    ),
)
