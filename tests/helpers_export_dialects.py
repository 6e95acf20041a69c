"""Small recordings as vendors' programs, LabVIEW, loggers and consoles of languages write them."""

from __future__ import annotations

import gzip
import io
import json
import tarfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from helpers_dialects import Array, Dialect, film, npy, npz

SQUARE, OBLONG, MAT = film(20, 8, 8, 3), film(14, 5, 7, 3), film(10, 12, 9, 3)
WIDE, SMALL = film(8, 6, 16, 3), film(9, 6, 5, 3)
TIMES = 0.05 * np.arange(20)
PSI, MMHG = 6.894757293168, 0.133322387415


def _line(values: Array, separator: str = ",", form: str = "{:.0f}") -> str:
    return separator.join(form.format(v) for v in np.ravel(values))


def _block(frame: Array, separator: str = ",", form: str = "{:.0f}") -> str:
    return "".join(_line(row, separator, form) + "\n" for row in frame)


def _comma(value: float, decimals: int = 1) -> str:
    return f"{value:.{decimals}f}".replace(".", ",")


def _names(form: str, separator: str = ",", first: int = 0) -> str:
    return separator.join(form.format(r + first, c + first) for r in range(5) for c in range(7))


def _read(name: str, content: str | bytes, values: Array, **rest: Any) -> Dialect:
    return Dialect(name, content.encode() if isinstance(content, str) else content, values, **rest)


def _refused(name: str, content: str | bytes, words: str, **rest: Any) -> Dialect:
    return _read(name, content, rest.pop("values", SQUARE), refused=words, **rest)


# -- LabVIEW -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _LabView:
    """How a measurement file is written."""

    x_columns: str = "One"
    separator: str = "\t"
    decimal: str = "."
    unit: str = "Volts"
    n_segments: int = 1
    start_s: float = 0.0
    comment: bool = True

    def text(self, frames: Array, names: Sequence[str] = ()) -> str:
        """Return the file of such frames, 0.05 s from one to the next."""
        n = frames[0].size
        join, cells = self.separator.join, [*names] or ["Voltage", *self._numbered(n)]
        word = {"\t": "Tab", ",": "Comma"}[self.separator]
        lines = [
            join(("LabVIEW Measurement", "")), join(("Separator", word)),
            join(("Decimal_Separator", self.decimal)), join(("X_Columns", self.x_columns)),
            join(("Time", f"10:00:00{self.decimal}1234567")), "***End_of_Header***", "",
        ]  # fmt: skip
        header = ["X_Value", *cells] + ["Comment"] * self.comment
        if self.x_columns == "Multi":
            header = [x for name in cells for x in ("X_Value", name)]
        for part in np.split(np.arange(len(frames)), self.n_segments):
            lines += [
                join(("Channels", str(n))), join(("Samples", *[str(len(part))] * n)),
                join(("Y_Unit_Label", *[self.unit] * n)), join(("X_Dimension", *["Time"] * n)),
                join(("Delta_X", *[self._number(0.05)] * n)), "***End_of_Header***",
            ]  # fmt: skip
            lines += [join(header), *(join(self._row(k, frames[k])) for k in part), ""]
        return "\r\n".join(lines)

    def _numbered(self, n: int) -> list[str]:
        return [f"Voltage {k}" for k in range(1, n)]

    def _number(self, value: float) -> str:
        return f"{value:.6f}".replace(".", self.decimal)

    def _row(self, k: int, frame: Array) -> list[str]:
        time, cells = self._number(self.start_s + 0.05 * k), [*map(self._number, frame.ravel())]
        if self.x_columns == "Multi":
            return [x for cell in cells for x in (time, cell)]
        return [time if self.x_columns == "One" else "", *cells]


def _labview() -> Iterator[Dialect]:
    forms = {
        "times and unit": _LabView(), "decimal commas": _LabView(decimal=","),
        "no times, a step": _LabView(x_columns="No"), "times before each channel":
        _LabView(x_columns="Multi"), "commas": _LabView(separator=","), "segments with headers":
        _LabView(n_segments=4), "times since 1904": _LabView(start_s=3793000000.0),
        "no column of comments": _LabView(comment=False),
    }  # fmt: skip
    for name, form in forms.items():
        yield _read(f"LabVIEW, {name}", form.text(SQUARE), SQUARE, times_s=TIMES, quantity="volt")
    yield _read("LabVIEW, kilopascals", _LabView(unit="kPa").text(SQUARE), SQUARE, times_s=TIMES,
                quantity="kilopascal")  # fmt: skip
    yield _read("LabVIEW, cells named", _LabView().text(OBLONG, _names("r{}c{}").split(",")),
                OBLONG, times_s=TIMES[:14], quantity="volt")  # fmt: skip
    yield _refused("LabVIEW, no word of 5 x 7", _LabView().text(OBLONG), "give rows and columns",
                   values=OBLONG, times_s=TIMES[:14], quantity="volt",
                   told={"rows": 5, "columns": 7})  # fmt: skip


# -- vendors -------------------------------------------------------------------------------------


def _vendors() -> Iterator[Dialect]:
    seat = "".join(f"Frame {k + 1},Time {0.05 * k:.2f} s\n{_block(f, ',', '{:.2f}')}\n"
                   for k, f in enumerate(MAT))  # fmt: skip
    yield _read("Tactilus, time behind the frame's number",
                "Tactilus Export\nDate,03/12/2024\nRows,12\nColumns,9\nUnits,psi\n\n" + seat,
                MAT * PSI, times_s=TIMES[:10], quantity="kilopascal")  # fmt: skip
    bed = "".join(f"2024-03-12 10:00:0{0.05 * k:.3f}\n{_block(f, ';', '{:.1f}')}\n"
                  for k, f in enumerate(MAT))  # fmt: skip
    yield _read("BodiTrak, a date and time before each matrix",
                "BodiTrak Pressure Data\nRows;12\nCols;9\nUnit;mmHg\n\n" + bed, MAT * MMHG,
                times_s=TIMES[:10], quantity="kilopascal")  # fmt: skip
    yield _read("PPS, times, numbers and sensors",
                "Time(ms)\tFrame\t" + "\t".join(f"Sensor {k}" for k in range(1, 65)) + "\n"
                + "".join(f"{50 * k}\t{k}\t{_line(f, chr(9), '{:.3f}')}\n"
                          for k, f in enumerate(SQUARE)), SQUARE, times_s=TIMES)  # fmt: skip
    german = "".join(
        f"FRAME;{k + 1}\nTime;10:00:0{_comma(0.05 * k, 3)}\nSENSOR;PX100\nRows;12\nColumns;9\n"
        "Sensel Width (cm);1,270\nSensel Height (cm);1,270\n"
        f"Peak Pressure (mmHg);{_comma(f.max())}\nSENSELS\n"
        + _block(f, ";", "{:.2f}").replace(".", ",") + "\n" for k, f in enumerate(MAT)
    )  # fmt: skip
    yield _read("XSENSOR, German", f"FILE;C:\\seat.xsn\n{german}", MAT * MMHG,
                times_s=TIMES[:10], quantity="kilopascal", pitch_cm=(1.27, 1.27))  # fmt: skip
    asf = "".join(f"Frame {k + 1}\n{_block(f, ';', '{:.1f}').replace('.', ',')}\n"
                  for k, f in enumerate(MAT))  # fmt: skip
    yield _read("Tekscan, German",
                "DATA_TYPE MOVIE\nROWS 12\nCOLS 9\nROW_SPACING 5,08 mm\nCOL_SPACING 5,08 mm\n"
                f"SECONDS_PER_FRAME 0,05\nUNITS kPa\nASCII_DATA @@\n\n{asf}@@\n", MAT,
                times_s=TIMES[:10], quantity="kilopascal", pitch_cm=(0.508, 0.508))  # fmt: skip


# -- spreadsheets --------------------------------------------------------------------------------


def _stamped(stamps: Sequence[str], header: str, separator: str = ",", ends: str = "\n") -> str:
    form = (lambda v: _comma(v)) if separator == ";" else "{:.0f}".format
    rows = (f"{at}{separator}" + separator.join(map(form, f.ravel())) + ends
            for at, f in zip(stamps, OBLONG, strict=True))  # fmt: skip
    cells = _names("Z{}S{}", separator, 1)
    return f"{header}{separator}{cells}{ends}" + "".join(rows)


def _sheets() -> Iterator[Dialect]:
    n, times = range(14), TIMES[:14]
    yield _read("UTF-16 without a byte-order mark",
                _stamped([_comma(0.05 * k, 2) for k in n], "Zeit", ";", "\r\n").encode("utf-16-be"),
                OBLONG, times_s=times)  # fmt: skip
    yield _read("French, date and time",
                _stamped([f"12/03/2024 10:00:0{_comma(0.05 * k, 3)}" for k in n],
                         "\ufeffDate et heure", ";", "\r\n"), OBLONG, times_s=times)  # fmt: skip
    days = [45363.4166666667 + 0.05 * k / 86400 for k in n]
    yield _read("days since 1900, German",
                _stamped([_comma(d, 10) for d in days], "Datum", ";"), OBLONG,
                times_s=times)  # fmt: skip
    yield _read("days since 1900, named as time", _stamped([f"{d:.10f}" for d in days], "Time"),
                OBLONG, times_s=times)  # fmt: skip
    noon = [f"3/12/2024 12:59:{53 + k} PM" if k < 7 else f"3/12/2024 1:00:{k - 7:02d} PM"
            for k in n]  # fmt: skip
    yield _read("American, clocks of twelve hours", _stamped(noon, "Timestamp"), OBLONG,
                times_s=1.0 * np.arange(14))  # fmt: skip
    yield _read("American, the month first",
                _stamped([f"3/13/2024 10:00:0{0.05 * k:.2f}" for k in n], "Timestamp"), OBLONG,
                times_s=times)  # fmt: skip
    below = OBLONG - 30.0
    books = "".join(",".join(f"({-v:.0f})" if v < 0 else f"{v:.0f}" for v in f.ravel()) + "\n"
                    for f in below)  # fmt: skip
    yield _refused("brackets for numbers below 0", books, "write it as -", values=below)
    yield _refused("brackets for numbers below 0, behind names",
                   _names("r{}c{}") + "\n" + books, "write it as -", values=below)  # fmt: skip
    halves = "".join(",".join(map(_comma, f.ravel())) + "\n" for f in WIDE[:, :2] + 0.5)
    yield _refused("decimal commas between commas", halves, "semicolons between the numbers")
    yield _refused("decimal commas between commas, matrices",
                   "\n".join("".join(",".join(map(_comma, r)) + "\n" for r in f + 0.5)
                             for f in SMALL), "semicolons between the numbers")  # fmt: skip
    percent = "".join(f"{0.05 * k:.2f};" + ";".join(f"{v / 10:.1f}%" for v in f.ravel()) + "\n"
                      for k, f in enumerate(OBLONG))  # fmt: skip
    yield _refused("percent behind each number", "t;" + _names("r{}c{}", ";") + "\n" + percent,
                   "leave them out")  # fmt: skip
    places = [",".join(str(p[k]) for p in np.ndindex(8, 8)) for k in (0, 1)]
    frames = "".join(f"{k},{_line(f)}\n" for k, f in enumerate(SQUARE))
    yield _refused("pandas, rows and columns on lines of their own",
                   f",{places[0]}\n,{places[1]}\n{frames}", "frame.columns =")  # fmt: skip
    yield _refused("pandas, rows and columns on lines of their own, named",
                   f"row,{places[0]}\ncol,{places[1]}\n{frames}", "frame.columns =")  # fmt: skip
    holes = SQUARE.copy()
    holes[:, 2, 3] = holes[5, 0] = np.nan
    for fill in ("NaN", "", "-999", "-9999"):
        text = "".join(f"{0.05 * k:.2f},{_line(f)}\n".replace("nan", fill)
                       for k, f in enumerate(holes))  # fmt: skip
        header = "t," + ",".join(f"c{k}" for k in range(64))
        yield _read(f"missing cells as {fill or 'nothing'}", f"{header}\n{text}", holes,
                    times_s=TIMES)  # fmt: skip


# -- loggers and consoles ------------------------------------------------------------------------


def _logs() -> Iterator[Dialect]:
    boot = ("ets Jun  8 2016 00:22:57\r\n\r\nrst:0x1 (POWERON_RESET),boot:0x13 (SPI_FAST)\r\n"
            "clk_drv:0x00,q_drv:0x00,d_drv:0x00\r\nmode:DIO, clock div:1\r\n"
            "load:0x3fff0030,len:1184\r\nentry 0x400805e4\r\n")  # fmt: skip
    lines = [f"{50 * k};{_line(f, ';')}\r\n" for k, f in enumerate(SQUARE)]
    yield _read("ESP32, words of its start", boot + "".join(lines), SQUARE, times_s=TIMES)
    again = boot + "".join(lines[:11]) + boot + "".join(lines[:9])
    yield _read("ESP32, started anew half way", again,
                np.concatenate([SQUARE[:11], SQUARE[:9]]),
                times_s=np.concatenate([TIMES[:11], TIMES[:9]]))  # fmt: skip
    yield _read("ESP32, milliseconds in brackets",
                "".join(f"[{50 * k} ms] adc: {_line(f, ' ')}\n" for k, f in enumerate(SQUARE)),
                SQUARE, times_s=TIMES)  # fmt: skip
    yield _refused("R's print", "".join(
        f", , {k + 1}\n\n     " + " ".join(f"[,{c}]" for c in range(1, 8)) + "\n"
        + "".join(f"[{r + 1},] {_line(row, ' ', '{:4.0f}')}\n" for r, row in enumerate(f))
        for k, f in enumerate(OBLONG)), "write.csv(")  # fmt: skip
    for cut in (8, 9):
        parts = "".join(f"  Columns {a + 1} through {b}\n\n{_block(WIDE[0][:, a:b], '   ')}\n"
                        for a, b in ((0, cut), (cut, 16)))  # fmt: skip
        yield _refused(f"MATLAB's print in parts of {cut}", parts, "writematrix(")
    with np.printoptions(linewidth=60):
        yield _refused("NumPy's print, rows on several lines", "\n".join(map(str, WIDE)),
                       "numpy.save(")  # fmt: skip
    with np.printoptions(threshold=50, edgeitems=2):
        yield _refused("NumPy's print, shortened", "\n".join(map(str, WIDE)), "numpy.save(")
    braces = json.dumps(SMALL.tolist()).replace("[", "{").replace("]", "}")
    yield _refused("Mathematica's lists", braces, "then it is JSON")
    yield _refused("Octave's text",
                   "# Created by Octave 8.4.0\n# name: x\n# type: matrix\n# ndims: 3\n 5 7 14\n"
                   + "".join(f" {v:.0f}\n" for v in np.moveaxis(OBLONG, 0, 2).ravel(order="F")),
                   "save('-v7'")  # fmt: skip
    yield _refused("Fortran's exponents",
                   "".join(_line(f, " ", "{:.3e}").replace("e", "D") + "\n" for f in SQUARE),
                   "as 1.2E+03")  # fmt: skip


# -- messages, arrays, archives ------------------------------------------------------------------


def _messages() -> Iterator[Dialect]:
    for names in (("secs", "nsecs"), ("sec", "nanosec")):
        messages = [
            {"header": {"seq": k, "stamp": dict(zip(names, (1700000000, 50_000_000 * k),
                                                    strict=True)), "frame_id": "pad"},
             "layout": {"dim": [{"label": "rows", "size": 5, "stride": 35},
                                {"label": "cols", "size": 7, "stride": 7}], "data_offset": 0},
             "data": f.ravel().tolist()} for k, f in enumerate(OBLONG)
        ]  # fmt: skip
        yield _read(f"JSON of ROS, {names[0]}", "\n".join(map(json.dumps, messages)), OBLONG,
                    times_s=TIMES[:14])  # fmt: skip
    objects = [json.dumps({"t": 0.05 * k, "p": f.tolist()}) for k, f in enumerate(OBLONG)]
    words = "".join(f"INFO connected\n{x}\n" if k % 5 == 0 else f"{x}\n"
                    for k, x in enumerate(objects))  # fmt: skip
    yield _read("JSON lines among words", words, OBLONG, times_s=TIMES[:14])
    texts = [{"t": f"{0.05 * k:.2f}", "p": [[str(v) for v in r] for r in f]}
             for k, f in enumerate(OBLONG)]  # fmt: skip
    yield _read("JSON, numbers as texts", json.dumps(texts), OBLONG, times_s=TIMES[:14])
    filled = np.where(np.arange(35).reshape(5, 7) == 7, -1e20, OBLONG)
    yield _read("NumPy, missing cells as -1e20", npy(filled), np.where(filled < 0, np.nan, filled))
    frames = np.empty(14, dtype=object)
    frames[:] = list(OBLONG)
    yield _refused("NumPy, an array of objects", npz(frames=frames), "numpy.stack(frames)")
    yield _read("NumPy, the last byte first", npy(OBLONG.astype(">u2")), OBLONG)
    archive, table = io.BytesIO(), _block(SQUARE[0]).encode()
    with tarfile.open(fileobj=archive, mode="w") as tar:
        member = tarfile.TarInfo("frame.csv")
        member.size = len(table)
        tar.addfile(member, io.BytesIO(table))
    yield _refused("a tar archive", archive.getvalue(), "tar -xf")
    yield _refused("a packed table", gzip.compress(table), "gunzip")


def _matlab(hdf5: bool) -> Iterator[Dialect]:
    from helpers_dialects import matlab

    flat = {"time": TIMES[:14], "cells": OBLONG.reshape(14, 35)}
    yield _refused("MATLAB, a line of cells for each time", matlab(rec=flat),
                   "14 frames of 35 cells", values=OBLONG, times_s=TIMES[:14],
                   told={"rows": 5, "columns": 7})  # fmt: skip
    if not hdf5:
        return
    import h5py

    buffer = io.BytesIO()
    with h5py.File(buffer, "w", userblock_size=512) as file:
        items = [file.create_dataset(f"#refs#/a{k}", data=f.T).ref for k, f in enumerate(OBLONG)]
        file.create_dataset("frames", data=np.array(items, dtype=h5py.ref_dtype)[:, None])
    mark = b"MATLAB 7.3 MAT-file".ljust(126) + b"IM"
    yield _read("MATLAB 7.3, a cell array", mark + buffer.getvalue()[len(mark) :], OBLONG)


def export_dialects(hdf5: bool = True) -> list[Dialect]:
    """Return all files; without ``hdf5`` those that take no h5py."""
    parts = (_labview, _vendors, _sheets, _logs, _messages)
    return [*(d for part in parts for d in part()), *_matlab(hdf5)]
