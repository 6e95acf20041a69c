"""Lines of numbers: what is read, what is a cell without a value, what is refused and why."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tactile_graph_sources.devices.decoder import Decoded, Decoder
from tactile_graph_sources.devices.inbox import Arrived
from tactile_graph_sources.devices.preset import Preset
from tactile_graph_sources.devices.preset_file import load_preset
from tactile_graph_sources.serial_port import _frame

SHIPPED = ("velostat-43x14", "fsr-8x8", "bnl-16x16")


def kit(assembler: str = "full", valid_range: Any = None, **framer: Any) -> Preset:
    """Return the preset of a pad of 2 x 3 cells that sends lines."""
    return Preset.model_validate({
        "preset": "mine", "transport": {"baud": 115200}, "assembler": assembler,
        "framer": {"kind": "text", **framer},
        "geometry": {"rows": 2, "columns": 3, "valid_range": valid_range},
    })  # fmt: skip


def read(preset: Preset, *lines: str) -> list[Decoded]:
    """Return the frames of lines; the first one may lack its beginning, so it goes before."""
    return Decoder(preset).feed("".join(f"{line}\n" for line in ("0", *lines)).encode())


@pytest.mark.parametrize(
    ("line", "framer"),
    [
        ("2.00,2.01,2.02,2.03,2.04,2.05", {}),
        ("-1,-2,-3,4,+5,0", {}),
        (" 1.5, -2 ,.5,3.,1e-05,-2E+3", {}),
        ("-1;2.5;3;4;5;6;", {"separator": ";", "trailing_separator": True}),
        ("F1 -1 2.5 3 4 5 6", {"separator": " ", "prefix": "F1"}),
        ("neat,-1,2.5,3,4,5,6", {"prefix": "neat"}),
    ],
)
def test_numbers_may_have_a_sign_a_point_and_an_exponent(line: str, framer: Any) -> None:
    (got,) = read(kit(**framer), line)
    between = framer.get("separator", ",")
    fields = line.removeprefix(framer.get("prefix", "")).strip(between).split(between)
    assert got.values.reshape(-1).tolist() == [float(field) for field in fields]


def test_lines_with_and_without_a_point_are_frames_alike() -> None:
    got = read(kit(), "1,2,3,4,5,6", "1.5,2,3,4,5,6", "2,2,3,4,5,6")
    assert [d.values[0, 0] for d in got] == [1.0, 1.5, 2.0]
    assert not any(d.gap for d in got)


def test_rows_may_be_tared() -> None:
    decoder = Decoder(kit("rows"))
    decoder.boundary()
    assert decoder.feed(b"-1,2.5,3\n4,5,-6\n") == []
    (got,) = decoder.boundary()
    assert got.values.tolist() == [[-1.0, 2.5, 3.0], [4.0, 5.0, -6.0]]


def test_a_time_may_be_a_fraction_of_a_second() -> None:
    got = read(kit(time_unit_s=1.0), "0.25,1,2,3,4,5,-6", "0.5,1,2,3,4,5,6", "-1,1,2,3,4,5,6")
    assert [d.device_time_s for d in got] == [0.25, 0.5]


def test_nan_is_a_cell_without_a_value() -> None:
    preset = kit(valid_range=(-5.0, 10.0))
    first, second = read(preset, "1,nan,3,4,-5,NAN", "1,nan,3,4,-5,11", "1,2,3,4,5,6")
    assert second.gap
    frame = _frame(Arrived(first, 0.0), 0, preset, "port")
    assert frame.image.valid is not None
    assert frame.image.valid.tolist() == [[True, False, True], [True, True, False]]
    assert frame.image.values.tolist() == [[1.0, 0.0, 3.0], [4.0, -5.0, 0.0]]
    assert _frame(Arrived(second, 0.0), 0, preset, "port").image.valid is None


def test_what_is_out_of_range_beside_a_missing_value_is_told() -> None:
    decoder = Decoder(kit(valid_range=(0.0, 10.0)))
    decoder.feed(b"0\n1,nan,3,4,5,11\n")
    assert decoder.hint() == "values of 1 to 11 came, the preset allows (0.0, 10.0)"


BEGINS = "a line begins with 'ready', the preset expects it to begin with a number"


@pytest.mark.parametrize(
    ("line", "framer", "hint"),
    [
        ("2.0,1,2,3,4,5", {"numbers": "whole"}, "value 1 of a line is '2.0', the preset expects "
         "whole numbers from 0 on (key 'numbers')"),
        ("1,-1,2,3,4,5", {"numbers": "whole"}, "value 2 of a line is '-1', the preset expects "
         "whole numbers from 0 on (key 'numbers')"),
        ("1,2,,4,5,6", {}, "value 3 of a line is '', which is empty"),
        ("1,2,,4,5,6", {"numbers": "whole"}, "value 3 of a line is '', which is empty"),
        ("1,2,3,4,5,", {}, "value 6 of a line is '', which is empty"),
        ("1,2,ovf,4,5,6", {}, "value 3 of a line is 'ovf', which is no number"),
        ("1,2,1.2.3,4,5,6", {}, "value 3 of a line is '1.2.3', which is no number"),
        ("1,2,inf,4,5,6", {}, "value 3 of a line is 'inf', which is not finite"),
        ("1,2,1e999,4,5,6", {}, "value 3 of a line is '1e999', which is not finite"),
        ("nan,1,2,3,4,5,6", {"time_unit_s": 1.0}, "value 1 of a line is 'nan', which is no time"),
        ("0;1;2;3;4;5", {}, "the numbers of a line stand between ';', the preset expects ',' "
         "(key 'separator')"),
        ("0 1 -2 3 4 5", {"separator": ";"}, "the numbers of a line stand between ' ', the preset "
         "expects ';' (key 'separator')"),
        ("1,2,3,4,5,6,", {}, "a line ends with ',' (key 'trailing_separator')"),
        ("1,2,3,4,5,-6", {"trailing_separator": True},
         "a line does not end with ',' (key 'trailing_separator')"),
        ("1,2,3.5", {}, "lines come with 3 numbers, the preset expects 6"),
        ("ready", {}, BEGINS),
    ],
)  # fmt: skip
def test_a_hint_names_separator_value_and_place(line: str, framer: Any, hint: str) -> None:
    decoder = Decoder(kit(**framer))
    assert decoder.feed(f"0\n{line}\n{line}\n".encode()) == []
    assert decoder.hint() == hint


@pytest.mark.parametrize("name", SHIPPED)
def test_kits_that_send_whole_numbers_are_held_to_it(name: str) -> None:
    """A byte that became a sign, a point or an exponent is found out by it."""
    framer = load_preset(name).framer
    assert framer.kind == "text"
    assert framer.numbers == "whole"


LINES = ["-1.5,2.25,3,-4,0.5,6", "7,-8.5,9.75,1,2.5,-3", "4.5,5,-6.25,7,8.5,9"]


@pytest.mark.parametrize("how", ["lost", "doubled", "-", ".", ",", "e", "\n"])
def test_damage_costs_a_frame_or_hurts_one_value_and_shifts_none(how: str) -> None:
    whole = "\n".join(LINES) + "\n"
    sent = [np.array(line.split(","), float).reshape(2, 3) for line in LINES]
    for at in range(len(whole)):
        new = {"lost": "", "doubled": 2 * whole[at]}.get(how, how)
        decoder = Decoder(kit())
        for decoded in decoder.feed(f"0\n{whole[:at]}{new}{whole[at + 1 :]}1,2".encode()):
            differ = [np.count_nonzero(decoded.values != pad) for pad in sent]
            assert min(differ) <= 1, (at, decoded.values)
