"""What a recording's frames tell: how they follow each other."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from helpers_ghosts import DIAGONAL, alone, network, read, share
from tactile_graph.wires import Frame
from tactile_graph_sources.inspection import measure as measuring
from tactile_graph_sources.inspection.measure import measure

BURST, STEP_S = 10, 0.01


def bursts(by_device: bool) -> list[Frame]:
    """Return frames that came ten at a time, of a hundred a second."""
    values = np.random.default_rng(0).integers(0, 9, (100, 4, 4)).astype(float)
    frames = [
        Frame.of(v, index=k, time_s=BURST * STEP_S * (k // BURST)) for k, v in enumerate(values)
    ]
    if by_device:
        return [replace(f, device_time_s=3.0 + STEP_S * f.index) for f in frames]
    return frames


def test_the_rate_is_that_of_the_devices_clock() -> None:
    found = measure(bursts(by_device=True))
    assert found.rate_hz == pytest.approx(100.0)
    assert found.jitter == pytest.approx(0.0, abs=1e-6)
    assert found.duration_s == pytest.approx(0.99)


def test_frames_that_come_in_bursts_have_no_even_step() -> None:
    found = measure(bursts(by_device=False))
    assert found.rate_hz == pytest.approx(99.0 / 0.9)
    assert found.jitter is None


def pressed(kind: str, n: int = 60) -> np.ndarray:
    """Return frames of noise around 10 in which nine cells are pressed ever harder."""
    rng = np.random.default_rng(0)
    values = rng.normal(10.0, 1.0, (n, 12, 17))
    values[:, 2:5, 2:5] += np.linspace(0.0, 50.0, n)[:, None, None]
    if kind == "whole numbers":
        values = np.round(values)
    if kind == "missing cells":
        values[rng.random(values.shape) < 0.05] = np.nan
        values[:, 0, 0] = np.nan
    return values


@pytest.mark.parametrize("kind", ["continuous", "whole numbers", "missing cells"])
def test_a_few_rows_at_once_tell_the_same_to_the_digit(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    values = pressed(kind)
    found = []
    for together in (1, 5000, 10**9):
        monkeypatch.setattr(measuring, "TOGETHER", together)
        found.append(measure([Frame.of(v, index=k) for k, v in enumerate(values)]))
    assert found[0] == found[1] == found[2]
    if kind != "missing cells":
        assert found[0].offset == np.median(np.quantile(values, 0.1, axis=0))
        step = found[0].step or 0.0
        change = np.diff(values, axis=0)
        change += step * np.random.default_rng(0).uniform(-0.5, 0.5, change.shape)
        sigma = 1.4826 * np.median(np.abs(change), axis=0) / np.sqrt(2.0)
        added = 1.4826 * 0.25 * step / np.sqrt(2.0)
        assert found[0].noise == np.quantile(np.sqrt(sigma**2 - added**2), 0.25)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "most"), [("continuous", 2.0), ("whole numbers", 3.0)])
def test_frames_are_measured_in_little_more_memory_than_they_take(kind: str, most: float) -> None:
    values = np.tile(pressed(kind, 200), (1, 8, 8))
    frames = [Frame.of(v, index=k) for k, v in enumerate(values)]
    tracemalloc.start()
    try:
        measure(frames)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < most * values.nbytes


@pytest.mark.parametrize("still", [False, True])
def test_frames_of_a_matrix_without_isolation_are_counted(still: bool) -> None:
    """Whether objects come and go, or lie there from first to last."""
    bare, lying = share([]), share(DIAGONAL)
    for circuit, n_ghosts in ((network, 8), (alone, 0)):
        order = [lying] * 8 if still else [bare] * 12 + [lying] * 8
        films = [read(its, seed=k, circuit=circuit) for k, its in enumerate(order)]
        found = measure([Frame.of(its.values, index=k) for k, its in enumerate(films)])
        assert (found.n_ghosts, found.n_telling) == (n_ghosts, 8)


def test_signed_numbers_written_without_their_sign_are_noticed() -> None:
    counts = np.random.default_rng(0).normal(0, 4, (20, 8, 8)).round()
    counts[5:, 2:4, 2:4] += 800
    wrapped, clipped = counts.astype("i2").view("u2"), counts + 10
    clipped[5:, 5, 5] = 65535
    for values, lost in ((wrapped, True), (counts, False), (clipped, False), (wrapped / 7, False)):
        assert measure([Frame.of(v.astype(float)) for v in values]).sign_lost == lost


def touched(by: float, around: float, first: int, n: int = 10) -> list[Frame]:
    """Return frames of a disc from one frame on, and of what its ring reads."""
    values = np.random.default_rng(0).normal(0.0, 2.0, (n, 20, 20))
    far = np.hypot(*(np.mgrid[:20, :20] - np.array([8, 12])[:, None, None]))
    values[first:] += np.where(far < 2.5, by, np.where(far < 8.0, around, 0.0))
    return [Frame.of(np.rint(v), index=k) for k, v in enumerate(values)]


@pytest.mark.parametrize("first", [3, 4, 8])
def test_what_reads_less_beside_a_touch_is_no_rest_and_empties_no_frame(first: int) -> None:
    found = measure(touched(300.0, -80.0, first))
    assert found.n_contacts == (0,) * first + (1,) * (10 - first)
    assert found.fullest >= first
    assert found.offset_spread < 10.0
    assert found.falls is None


@pytest.mark.parametrize("first", [3, 8])
def test_readings_that_fall_are_contacts_too_and_told(first: int) -> None:
    found = measure(touched(-300.0, 80.0, first))
    assert found.n_contacts == (0,) * first + (1,) * (10 - first)
    assert found.fullest >= first
    assert found.falls is not None
    assert found.falls.frames == 10 - first
    assert found.falls.most == pytest.approx(304.0, abs=6.0)
