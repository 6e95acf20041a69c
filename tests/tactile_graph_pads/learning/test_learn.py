"""All of it together on odd recordings: full scale, counts, silence of the converter, lines."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from helpers_ghosts import DIAGONAL, alone, network, read, share
from helpers_learning import MadeUpPad
from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_pads.circuits import Floating
from tactile_graph_pads.learning.learn import LearnedPad, learn_pad
from tactile_graph_pads.learning.recordings import Stack, off_pad, read_places, read_stack
from tactile_graph_pads.learning.summary import summary
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.writers.write_npz import write_npz


def stack(path: Path, frames: list[Frame]) -> Stack:
    write_npz(path, frames)
    return read_stack([(path, None)])


def changed(frames: list[Frame], by: object) -> list[Frame]:
    """Return frames whose values went through a function."""
    return [
        Frame.of(by(f.image.values), f.image.pitch_cm, quantity="raw", index=k, truth=f.truth)  # type: ignore[operator]
        for k, f in enumerate(frames)
    ]


def learned(folder: Path, pad: MadeUpPad, by: object, n: int = 120) -> LearnedPad:
    empty = stack(folder / "e.npz", changed(list(pad.empty(40)), by))
    return learn_pad(empty, stack(folder / "o.npz", changed(list(pad.objects(n)), by)))


def refused(empty: np.ndarray, objects: np.ndarray, match: str, folder: Path) -> None:
    stacks = [
        stack(folder / name, [Frame.of(v.copy(), quantity="counts") for v in values])
        for name, values in (("e.npz", empty), ("o.npz", objects))
    ]
    with pytest.raises(DataError, match=match):
        learn_pad(*stacks)


def test_readings_below_the_empty_pads_are_not_called_nothing(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    empty, objects = rng.normal(3000.0, 2.0, (2, 40, 8, 8))
    refused(empty, objects, r"^o.npz: nothing lies on the pad in any frame", tmp_path)
    fallen = objects.copy()
    fallen[:30, 3:6, 3:6] -= 1500.0
    below = (
        r"^o.npz: no reading is above the empty pad's, and in 30 of 40 frames readings are below "
        r"it, by up to 150\d counts, 7\d\d times its noise: were the two recordings swapped.*fall"
    )
    refused(empty, fallen, below, tmp_path)
    full = np.full((40, 8, 8), 4095.0)
    at_full = r"below it, by up to 26\d\d counts: the empty pad reads 4095 counts without any noise"
    refused(full, fallen, at_full, tmp_path)


def refused_alone(values: np.ndarray, match: str, folder: Path) -> None:
    objects = stack(folder / "o.npz", [Frame.of(v.copy(), quantity="counts") for v in values])
    with pytest.raises(DataError, match=match):
        learn_pad(None, objects)


FALL = r"^o.npz: in {} of {} frames readings fall under pressure, by up to {} counts, .*invert_from"


def test_readings_that_fall_under_pressure_are_refused_without_an_empty_recording_too(
    tmp_path: Path,
) -> None:
    rng = np.random.default_rng(0)
    values = rng.normal(220.0, 1.0, (30, 5, 12))
    values[5:, 1, :8] -= [12, 22, 9, 48, 44, 7, 21, 42]
    refused_alone(values, FALL.format(25, 30, r"5\d(\.\d+)?"), tmp_path)
    values = rng.normal(220.0, 1.0, (60, 10, 10))
    for k in range(60):
        row, column = rng.integers(1, 8, 2)
        values[k, row : row + 2, column : column + 2] -= 60.0 * (k % 3 > 0)
    refused_alone(values, FALL.format(40, 60, r"6\d(\.\d+)?"), tmp_path)


def test_readings_that_fall_farther_than_those_beside_them_rise_are_refused(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    empty, objects = rng.normal(3000.0, 2.0, (2, 40, 8, 8))
    objects[:30, 2:7, 2:7] += 100.0
    objects[:30, 3:6, 3:6] -= 1500.0
    refused(empty, objects, FALL.format(30, 40, r"14\d\d"), tmp_path)


def test_elements_pressed_in_most_frames_are_not_called_nothing(tmp_path: Path) -> None:
    values = np.random.default_rng(0).normal(0.0, 1.0, (30, 5, 12))
    values[5:, 1, :8] += [12, 22, 9, 48, 44, 7, 21, 42]
    match = r"^o.npz: 7 elements around row 1, column 3 are pressed in more than half of the frames"
    refused_alone(values, match, tmp_path)


def test_a_recording_without_a_valid_reading_is_told(tmp_path: Path) -> None:
    empty = np.random.default_rng(0).normal(3000.0, 2.0, (40, 8, 8))
    none = np.full((50, 8, 8), np.nan)
    refused(empty, none, r"^o.npz: no reading is valid in any of its 50 frames", tmp_path)


@pytest.mark.slow
def test_readings_that_stop_at_full_scale_are_told(tmp_path: Path) -> None:
    found = learned(tmp_path, MadeUpPad(), lambda v: np.minimum(np.round(v), 255.0))
    assert found.learned.saturated_from == 255.0
    assert ("full scale", "255 raw, was reached") in list(summary(found))
    free = learned(tmp_path, MadeUpPad(), np.round)
    assert free.learned.saturated_from is None


@pytest.mark.slow
def test_a_converter_without_any_noise_is_touched_from_its_first_step(tmp_path: Path) -> None:
    pad = MadeUpPad(noise=0.0)
    pad.offset[:] = 100.0
    found = learned(tmp_path, pad, lambda v: 20.0 * np.round(v / 20.0))
    assert found.learned.noise == pytest.approx(20.0 / np.sqrt(12.0))
    assert 0.0 < found.learned.touched_from <= 20.0
    assert found.counted_right == 1.0


@pytest.mark.slow
def test_an_object_at_rest_for_long_is_one_placement(tmp_path: Path) -> None:
    pad = MadeUpPad()
    frames = [pad.frame(((8.0, 7.0, 300.0),), k) for k in range(80)]
    found = learn_pad(
        stack(tmp_path / "e.npz", list(pad.empty())), stack(tmp_path / "o.npz", frames)
    )
    counted = "not told by 1 placements (80 frames, of which those that touch nearly what another"
    assert any(counted in note and "at least 20 are needed" in note for note in found.notes)
    assert found.learned.gain_of is None


@pytest.mark.slow
def test_where_halves_of_the_frames_are_unlike_nothing_is_said_of_the_pads_own_unevenness(
    tmp_path: Path,
) -> None:
    found = learned(tmp_path, MadeUpPad(), lambda v: v)
    assert found.gains is not None
    unlike = replace(found, gains=found.gains._replace(alike=0.57, fixed=0.0))
    told = dict(summary(unlike))["unevenness"]
    assert "how much of it is the pad's own is not told" in told
    assert "0%" not in told.partition(";")[0]


@pytest.mark.slow
def test_on_how_many_elements_halves_of_the_frames_agree_is_told(tmp_path: Path) -> None:
    found = learned(tmp_path, MadeUpPad(gain_sigma=0.4), lambda v: v, n=300)
    assert found.gains is not None
    compared = int(np.isfinite(found.gains.halves[0]).sum())
    assert 0 < compared < 280
    assert f"of the {compared} of 280 elements that both compare" in dict(summary(found))["gains"]


@pytest.mark.slow
def test_missing_elements_stay_missing(tmp_path: Path) -> None:
    def hole(values: np.ndarray) -> np.ndarray:
        out = values.copy()
        out[2, 3] = np.nan
        return out

    found = learned(tmp_path, MadeUpPad(), hole, n=40)
    assert found.elements.state[2, 3] == "missing"
    assert not found.elements.good[2, 3]
    assert np.isfinite(found.elements.offset).all()


def test_places_are_read_by_name_and_frame(tmp_path: Path) -> None:
    path = tmp_path / "p.csv"
    path.write_text("recording;x_cm;y_cm;frame\na.npz;1.5;2;\nb.npz;3;4;0\nb.npz;5;6;0\n")
    found = read_places(path, ["a.npz", "b.npz"])
    assert found == {"a.npz": {None: ((1.5, 2.0),)}, "b.npz": {0: ((3.0, 4.0), (5.0, 6.0))}}
    path.write_text("recording,x,y\na.npz,1,2\n")
    with pytest.raises(DataError, match=r"needs the columns recording, x_cm and y_cm, got"):
        read_places(path, ["a.npz"])
    path.write_text("recording,x_cm,y_cm\na.npz,one,2\n")
    with pytest.raises(DataError, match=r"p.csv:2: is no place"):
        read_places(path, ["a.npz"])
    path.write_text("recording,x_cm,y_cm\na.npz,nan,2\n")
    with pytest.raises(DataError, match=r"p.csv:2: is no place: x_cm and y_cm must be numbers"):
        read_places(path, ["a.npz"])


def test_places_off_the_pad_are_counted_and_the_first_named(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    write_npz(path, [Frame.of(np.ones((4, 4)), quantity="raw", index=k) for k in range(3)])
    told = {"a.npz": {0: ((1.0, 2.0),), 1: ((30.0, 20.0), (-9.0, 1.0))}}
    said = off_pad(read_stack([(path, None)], told))
    assert said.startswith(
        "2 of 3 known places lie off the pad of 4 by 4 cm, first x 30, y 20 cm in "
    )
    assert said.endswith("are these mm?")
    assert off_pad(read_stack([(path, None)])) == ""


def test_a_matrix_without_isolation_is_told_of(tmp_path: Path) -> None:
    """Unless the pad that is told takes the ghosts out."""

    def recorded(name: str, shares: np.ndarray, circuit: object) -> Stack:
        values = [read(shares, seed=k, circuit=circuit).values for k in range(20)]  # type: ignore[arg-type]
        return stack(tmp_path / name, [Frame.of(v, quantity="raw") for v in values])

    for circuit, is_told in ((network, True), (alone, False)):
        empty, objects = (
            recorded(f"{circuit.__name__}{k}.npz", share(lying), circuit)
            for k, lying in enumerate(([], DIAGONAL))
        )
        notes = [n for n in learn_pad(empty, objects).notes if "without isolation" in n]
        assert len(notes) == is_told
        assert all("20 of 20 frames" in n and "kind: floating" in n for n in notes)
    base = replace(load_pad("plain"), circuit=Floating())
    empty, objects = (
        recorded("e.npz", share([]), network),
        recorded("o.npz", share(DIAGONAL), network),
    )
    told = replace(base, geometry=replace(base.geometry, element_cm=1.0, gap_cm=0.0))
    assert not [n for n in learn_pad(empty, objects, told).notes if "without isolation" in n]
