"""What is learned of volts whose circuit and law are told, and how the file says it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tactile_graph.wires import Circle, Frame, TrueObject
from tactile_graph_pads.learning.learn import LearnedPad, learn_pad
from tactile_graph_pads.learning.pad_file import Making, pad_text, write_pad
from tactile_graph_pads.learning.recordings import Stack, read_stack
from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_sources.writers.write_npz import write_npz

PLAIN = load_pad("plain")
MAKING = Making(
    "tactile-graph learn-pad x.npz", "tactile-graph 0", "2026-01-01", {"x.npz": "ab" * 32}
)
NOISE_V = 2e-3


def stacks(
    folder: Path, log_gain: np.ndarray | float = 0.0, turn_on_g: float = 0.0
) -> tuple[Stack, Stack]:
    """Record the even pad, empty and under discs, with gains of the load and noise."""
    rng = np.random.default_rng(0)
    row, column = np.mgrid[:16, :16]

    def frame(load_g: np.ndarray, index: int, truth: tuple[TrueObject, ...] = ()) -> Frame:
        volts = PLAIN.forward(load_g) + NOISE_V * rng.standard_normal((16, 16))
        return Frame(PLAIN.image(volts), index, truth=truth)

    write_npz(folder / "empty.npz", [frame(np.zeros((16, 16)), k) for k in range(80)])
    discs = []
    for k in range(150):
        x, y = rng.uniform(3.0, 12.0, 2)
        on = np.hypot(column - x, row - y) < 4.0
        scatter = np.exp(log_gain + 0.2 * rng.standard_normal((16, 16)))
        load = np.where(on, rng.uniform(15.0, 60.0) * scatter, 0.0)
        load[load < turn_on_g] = 0.0
        there = Circle(0.5 + 1.3 * x, 0.5 + 1.3 * y, 5.2)
        discs.append(frame(load, k, (TrueObject(there, float(load.sum())),)))
    write_npz(folder / "discs.npz", discs)
    return read_stack([(folder / "empty.npz", None)]), read_stack([(folder / "discs.npz", None)])


@pytest.fixture(scope="module")
def even(tmp_path_factory: pytest.TempPathFactory) -> LearnedPad:
    """Return what is learned of the even pad by itself."""
    return learn_pad(*stacks(tmp_path_factory.mktemp("even")))


@pytest.mark.slow
def test_noise_goes_where_localisers_look_for_it(even: LearnedPad, tmp_path: Path) -> None:
    paths = write_pad(tmp_path / "pad.yaml", even, None, MAKING)
    assert [p.name for p in paths[:2]] == ["pad.yaml", "pad.elements.csv"]
    pad = load_pad(tmp_path / "pad.yaml")
    assert pad.scan.noise_v == pytest.approx(NOISE_V, rel=0.05)
    assert (pad.scan.samples, pad.converter.bits) == (1, None)
    assert pad.geometry.shape == (16, 16)
    assert pad.unevenness == Pad().unevenness
    assert "The unevenness is that of V, not of the loads" in "".join(even.notes)


@pytest.mark.slow
@pytest.mark.parametrize("quantity", ["raw", "gram"])
def test_readings_that_steps_take_as_loads_have_the_unevenness_of_loads(
    quantity: str, tmp_path: Path
) -> None:
    rng = np.random.default_rng(2)
    row, column = np.mgrid[:16, :16]

    def frame(load: np.ndarray, index: int) -> Frame:
        values = load + 0.5 * rng.standard_normal((16, 16))
        return Frame.of(values, 1.0, quantity=quantity, index=index)

    write_npz(tmp_path / "empty.npz", [frame(np.zeros((16, 16)), k) for k in range(60)])
    discs = []
    for k in range(120):
        x, y = rng.uniform(2.0, 13.0, 2)
        scatter = np.exp(0.15 * rng.standard_normal((16, 16)))
        discs.append(frame(np.where(np.hypot(column - x, row - y) < 4.0, 50.0 * scatter, 0.0), k))
    write_npz(tmp_path / "discs.npz", discs)
    paths = tmp_path / "empty.npz", tmp_path / "discs.npz"
    found = learn_pad(*(read_stack([(path, None)]) for path in paths))
    write_pad(tmp_path / "pad.yaml", found, None, MAKING)
    pad = load_pad(tmp_path / "pad.yaml")
    assert pad.learned is not None
    assert pad.learned.turn_on is not None
    assert pad.unevenness.sigma == pytest.approx(0.15, rel=0.1)
    assert (pad.unevenness.voids, pad.unevenness.fixed) == (0.0, 0.0)


@pytest.mark.slow
def test_with_a_pad_told_gains_turn_on_and_unevenness_are_of_grams(tmp_path: Path) -> None:
    log_gain = 0.3 * np.random.default_rng(3).standard_normal((16, 16))
    found = learn_pad(*stacks(tmp_path, log_gain, turn_on_g=12.0), PLAIN)
    write_pad(tmp_path / "pad.yaml", found, PLAIN, replace(MAKING, pad="plain"))
    pad = load_pad(tmp_path / "pad.yaml")
    assert pad.learned is not None
    assert pad.learned.gain_of == "gram"
    assert pad.law.turn_on_g == pytest.approx(12.0, rel=0.1)
    assert pad.circuit == PLAIN.circuit
    assert pad.unevenness.sigma == pytest.approx(np.hypot(0.3, 0.2), rel=0.25)
    assert pad.unevenness.fixed == pytest.approx(0.09 / 0.13, abs=0.2)
    gain = pad.learned.table.gain
    told = gain != 1.0
    assert np.corrcoef(np.log(gain[told]), log_gain[told])[0, 1] > 0.9


@pytest.mark.slow
def test_the_head_says_what_was_told_and_what_was_not(even: LearnedPad) -> None:
    alone = pad_text(even, None, MAKING)
    assert "Told beforehand: no pad." in alone
    assert "Nobody said its law and circuit: a step that asks for them takes the thesis'." in alone
    assert "SHA-256 of x.npz: abababababababab…" in alone
    told = pad_text(even, PLAIN, replace(MAKING, pad="plain"))
    assert "Told beforehand: plain." in told
    assert "Nobody said" not in told


@pytest.mark.slow
def test_many_recordings_are_named_by_one_digest(even: LearnedPad) -> None:
    many = {f"r{k}.npz": f"{k:064x}" for k in range(90)}
    text = pad_text(even, None, replace(MAKING, recordings=many, command="x" * 9000))
    head = [line for line in text.splitlines() if line.startswith("#")]
    assert len(head) < 12
    assert max(map(len, head)) < 600
    assert "digests of all 90 recordings" in text
