"""More small recordings, in dialects that the readers had not seen when these were written."""

from __future__ import annotations

import gzip
import io
import json
import pickle
import zipfile
from collections.abc import Iterator
from typing import Any

import numpy as np

from helpers_dialects import Array, Dialect, film, npy, npz, picture, zipped

SQUARE, OBLONG, TALL = film(20, 8, 8, 1), film(14, 5, 7, 1), film(12, 7, 9, 1)
MAT, LARGE = film(10, 16, 16, 1), 7.0 * film(9, 6, 5, 1)
T = {n: 0.05 * np.arange(n) for n in (9, 10, 12, 14, 20)}


def _line(frame: Array, separator: str = ",", form: str = "{:.0f}") -> str:
    return separator.join(form.format(v) for v in np.ravel(frame))


def _block(frame: Array, separator: str = ",", form: str = "{:.0f}") -> str:
    return "".join(_line(row, separator, form) + "\n" for row in frame)


def _blocks(frames: Array) -> str:
    return "".join(map(_block, frames))


def _names(form: str, frame: Array, separator: str = ",", first: int = 0) -> str:
    rows, columns = frame.shape
    places = ((r + first, c + first) for r in range(rows) for c in range(columns))
    return separator.join(form.format(*place) for place in places)


def _german(value: float, decimals: int = 1) -> str:
    return f"{value:,.{decimals}f}".replace(",", "#").replace(".", ",").replace("#", ".")


def _text(name: str, text: str, values: Array, **rest: Any) -> Dialect:
    return Dialect(name, text.encode(), values, **rest)


def _refused(name: str, content: bytes | str, words: str, **rest: Any) -> Dialect:
    content = content.encode() if isinstance(content, str) else content
    return Dialect(name, content, rest.pop("values", SQUARE), refused=words, **rest)


def _sheets() -> Iterator[Dialect]:
    """Of spreadsheets in several languages."""
    comma = lambda v, n=1: f"{v:.{n}f}".replace(".", ",")  # noqa: E731
    yield _text(
        "German, Zeile and Spalte in the names",
        "\ufeffsep=;\r\nZeit [s];" + _names("Z{}S{}", TALL[0], ";", 1) + "\r\n" + "".join(
            f"{comma(0.05 * k, 2)};{_line(f, ';', '{:.1f}').replace('.', ',')}\r\n"
            for k, f in enumerate(TALL)), TALL, times_s=T[12],
    )  # fmt: skip
    yield _text(
        "French, ligne and colonne in the names",
        "Temps (ms);" + _names("L{}C{}", TALL[0], ";", 1) + "\r\n" + "".join(
            f"{50 * k};{_line(f, ';')}\r\n" for k, f in enumerate(TALL)), TALL, times_s=T[12],
    )  # fmt: skip
    long = [(k, r, c, v) for (k, r, c), v in np.ndenumerate(OBLONG)]
    yield Dialect(
        "French in Latin-1, a sensor's name, words for values",
        ("Date;Capteur;Ligne;Colonne;Pression relevée\r\n" + "".join(
            f"2024-03-12 10:00:{0.05 * k:06.3f};T1;{r + 1};{c + 1};{comma(v)}\r\n"
            for k, r, c, v in long)).encode("latin-1"), OBLONG, times_s=T[14],
    )  # fmt: skip
    yield _text(
        "German, Zeitpunkt",
        "Zeitpunkt;Zeile;Spalte;Druck (kPa)\n" + "".join(
            f"{comma(0.05 * k, 2)};{r + 1};{c + 1};{comma(v)}\n" for k, r, c, v in long),
        OBLONG, times_s=T[14], quantity="kilopascal",
    )  # fmt: skip
    for name, header in (("Portuguese", "quadro;linha;coluna;pressão"),
                         ("Dutch", "frame;rij;kolom;waarde")):  # fmt: skip
        rows = "".join(f"{k};{r};{c};{v:.0f}\n" for k, r, c, v in long)
        yield _text(name, f"{header}\n{rows}", OBLONG)
    yield _text(
        "German, points between thousands",
        "Nr.;" + _names("R{}_C{}", LARGE[0], ";") + "\n" + "".join(
            f"{k + 1};" + ";".join(map(_german, f.ravel())) + "\n" for k, f in enumerate(LARGE)),
        LARGE,
    )  # fmt: skip
    quoted = ["".join(f'"{v:,.0f}",' for v in f.ravel())[:-1] for f in LARGE]
    yield _text("commas between thousands, quoted",
                "frame," + _names("cell_{}_{}", LARGE[0]) + "\n"
                + "".join(f"{k},{x}\n" for k, x in enumerate(quoted)), LARGE)  # fmt: skip
    decimals = "".join(
        f'"{comma(0.05 * k, 2)}",' + ",".join(f'"{comma(v, 2)}"' for v in f.ravel()) + "\n"
        for k, f in enumerate(OBLONG)
    )
    yield _text("decimal commas, quoted", '"t",' + _names("r{}c{}", OBLONG[0]) + "\n" + decimals,
                OBLONG, times_s=T[14])  # fmt: skip
    yield _text(
        "comma in the clock, points in the values",
        "Zeit;" + _names("c{}_{}", OBLONG[0], ";") + "\n" + "".join(
            f"10:00:00,{50 * k:03d};{_line(f, ';', '{:.3f}')}\n" for k, f in enumerate(OBLONG)),
        OBLONG, times_s=T[14],
    )  # fmt: skip
    yield _text(
        "units below the names",
        "t," + _names("r{}c{}", OBLONG[0]) + "\nms," + ",".join(["kPa"] * 35) + "\n" + "".join(
            f"{50 * k},{_line(f)}\n" for k, f in enumerate(OBLONG)),
        OBLONG, times_s=T[14], quantity="kilopascal",
    )  # fmt: skip
    pivot = [f"{r + 1},{_line(x)}" for f in OBLONG for r, x in enumerate(f)]
    head = "," + ",".join(str(c) for c in range(1, 8))
    blocks = ["\n".join([head, *pivot[5 * k : 5 * k + 5]]) for k in range(14)]
    yield _text("numbers of columns above each matrix", "\n\n".join(blocks) + "\n", OBLONG)
    sheet = "".join(f"| {r + 1} | {_line(x, ' | ')} |\n" for r, x in enumerate(OBLONG[0]))
    yield _text("a table of Markdown", f"| | {' | '.join('ABCDEFG')} |\n{'|---' * 8}|\n{sheet}",
                OBLONG[:1])  # fmt: skip
    numbered = "".join(f"{0.05 * k:.2f},{i},{v:.0f}\n" for k, f in enumerate(SQUARE)
                       for i, v in enumerate(f.ravel()))  # fmt: skip
    yield _refused("a cell a line, by its number", f"time,cell,value\n{numbered}", "pivot(")
    cells = "".join(
        f"S{r + 1}-{c + 1}," + _line(OBLONG[:, r, c]) + "\n" for r in range(5) for c in range(7)
    )
    times = ",".join(f"t{k}" for k in range(14))
    yield _refused("a cell a line, a frame a column", f"sensor,{times}\n{cells}", "exchange them")
    yield _refused("x, y, z of points that are no cells",
                   "x,y,z\n" + "".join(f"{97 * k % 389},{31 * k},{k}\n" for k in range(12)),
                   "are they values")  # fmt: skip
    over = [np.where(np.arange(30).reshape(6, 5) == 7, np.nan, f) for f in LARGE]
    marked = [f"{k},{_line(f)}\n".replace("nan", "OVL") for k, f in enumerate(over)]
    header = "t," + _names("r{}c{}", LARGE[0])
    yield _refused("words for overload", f"{header}\n{''.join(marked)}", "is left empty")
    loaded = np.where(SQUARE > 60, SQUARE, 0.0)
    listed = "".join(f"{k},{r},{c},{v:.0f}\n" for (k, r, c), v in np.ndenumerate(loaded) if v)
    kept = loaded[:, : 1 + np.argwhere(loaded)[:, 1].max(), : 1 + np.argwhere(loaded)[:, 2].max()]
    yield _text("only loaded cells", f"frame,row,col,value\n{listed}", kept)


def _logs() -> Iterator[Dialect]:
    """Of microcontrollers and terminals."""
    yield _text("names beside numbers, a cell a line",
                "".join(f"x: {c}, y: {r}, p: {v:.0f}\n" for (_, r, c), v in np.ndenumerate(OBLONG)),
                OBLONG)  # fmt: skip
    yield _text(
        "names beside numbers, for a plotter",
        "".join("\t".join(f"s{i}:{v:.0f}" for i, v in enumerate(f.ravel())) + "\n" for f in SQUARE),
        SQUARE,
    )
    rows = [f"Row {i}: {_line(r, ' ')}\n" for f in OBLONG for i, r in enumerate(f)]
    yield _text("named rows", "".join(rows), OBLONG)
    ruled = "".join("----------\n" + "".join(rows[5 * k : 5 * k + 5]) for k in range(14))
    yield _text("named rows between rules", ruled, OBLONG)
    yield _text("rows that are lettered",
                "".join(f"{'ABCDE'[i]} = {_line(r)}\n" for f in OBLONG for i, r in enumerate(f)),
                OBLONG)  # fmt: skip
    yield _text("NumPy's print", "".join(f"{f.astype(int)}\n" for f in OBLONG), OBLONG)
    for name, mark in {
        "a time alone": "{1} ms\n", "t = and a time": "t={0:.2f}\n", "a comment": "# t = {0:.2f}\n",
        "a number and a time": "Frame {2}, time: {0:.2f} s\n",
        "keys": "Frame:,{2}\nDate:,03/12/2024\nTime:,10:00:{0:06.3f}\nPeak:,{1}\n",
    }.items():  # fmt: skip
        text = "".join(mark.format(0.05 * k, 50 * k, k) + _block(f) for k, f in enumerate(OBLONG))
        yield _text(f"before each matrix {name}", text, OBLONG, times_s=T[14])
    yield _text("a total behind each matrix",
                "".join(_block(f) + f"Total: {f.sum():.0f}\n" for f in OBLONG), OBLONG)  # fmt: skip
    yield _text("words now and then", "".join(
        _line(f) + "\n" + ("ERR: timeout 3\n" if k in (3, 11) else "")
        for k, f in enumerate(SQUARE)), SQUARE)  # fmt: skip
    yield _text("the header again and again", "".join(
        (",".join(f"v{i}" for i in range(64)) + "\n" if k % 5 == 0 else "") + _line(f) + "\n"
        for k, f in enumerate(SQUARE)), SQUARE)  # fmt: skip
    beats = "".join(_line(f) + "\n" + "fps: 20.1\n" * (k % 5 == 4) for k, f in enumerate(SQUARE))
    yield _refused("words after every fifth frame", beats, "frames of 8 x 8",
                   told={"rows": 8, "columns": 8})  # fmt: skip
    yield _text("row numbers that start anew", "frame,row," + ",".join(f"c{c}" for c in range(9))
                + "\n" + "".join(f"{k},{r},{_line(x)}\n" for k, f in enumerate(TALL)
                                 for r, x in enumerate(f)), TALL)  # fmt: skip
    yield _refused("row numbers that do not", "row," + ",".join(f"c{c}" for c in range(7)) + "\n"
                   + "".join(f"{r},{_line(x)}\n" for r, x in enumerate(OBLONG[0])),
                   "give rows and columns", values=OBLONG[:1],
                   told={"rows": 5, "columns": 7})  # fmt: skip
    yield _refused("rows of 16 and nothing between", _blocks(MAT), "a row of 16 cells",
                   values=MAT, told={"rows": 16, "columns": 16})  # fmt: skip
    mat = _slow(20, 12, 32)
    yield _refused("rows of 32 and nothing between", _blocks(mat), "each 12th is alike",
                   values=mat, told={"rows": 12, "columns": 32})  # fmt: skip
    yield _refused(
        "hexadecimal",
        "".join(" ".join(f"0x{int(v):02X}" for v in f.ravel()) + "\n" for f in SQUARE),
        "hexadecimal",
    )
    yield _refused(
        "a unit behind each number",
        "".join(",".join(f"{v:.1f}kPa" for v in f.ravel()) + "\n" for f in OBLONG),
        "leave them out",
    )
    yield _refused("another minus sign", "".join(_block(f - 300.0) for f in OBLONG).replace(
        "-", "\u2212"), "write them as '-'")  # fmt: skip


def _instruments() -> Iterator[Dialect]:
    """As programs of instruments export."""
    head = "Sensor:,PX100\nSensel width (cm):,0.5\nUnits:,kPa\n\n"
    keys = "Frame:,{0}\nTime:,10:00:{1:06.3f}\n"
    frames = [keys.format(k + 1, 0.05 * k) + _block(f) + "\n" for k, f in enumerate(OBLONG)]
    yield _text("keys before each matrix, the pitch among them", head + "".join(frames), OBLONG,
         times_s=T[14], quantity="kilopascal", pitch_cm=(0.5, 0.5))  # fmt: skip
    yield _text("sections, the pitch's unit in its name",
                "[Header]\nRows=5\nCols=7\nPitch_mm=4\n[Data]\n"
                + "\n".join(_block(f, " ") for f in OBLONG), OBLONG,
                pitch_cm=(0.4, 0.4))  # fmt: skip
    yield _text("comments, the rate as fs",
                "% rows: 5\n% cols: 7\n% unit: kPa\n% fs: 20\n"
                + "".join(_line(f, " ") + "\n" for f in OBLONG), OBLONG,
                times_s=T[14], quantity="kilopascal")  # fmt: skip
    numbered = "time[secs]\t" + "\t".join(str(i) for i in range(1, 36)) + "\n"
    timed = [f"{0.05 * k:.2f}\t{_line(f, chr(9))}\n" for k, f in enumerate(OBLONG)]
    yield _refused("columns that are numbered behind a time",
                   "scanning rate [Hz]: 20\n\n" + numbered + "".join(timed),
                   "give rows and columns", values=OBLONG, times_s=T[14],
                   told={"rows": 5, "columns": 7})  # fmt: skip


def _stacks() -> Iterator[Dialect]:
    """JSON, NumPy and what is none of the formats that are read."""
    meta = {"rows": 5, "cols": 7, "unit": "kPa", "pitch_mm": 5}
    frames = [{"ts": 0.05 * k, "values": f.ravel().tolist()} for k, f in enumerate(OBLONG)]
    yield _text("JSON, an object about the frames", json.dumps({"meta": meta, "frames": frames}),
                OBLONG, times_s=T[14], quantity="kilopascal", pitch_cm=(0.5, 0.5))  # fmt: skip
    yield _text("JSON of a database", "".join(json.dumps(
        {"_id": {"$oid": f"65f{k}"}, "payload": {"time": f"2024-03-12T10:00:{0.05 * k:06.3f}Z",
                                                 "grid": f.tolist()}}) + "\n"
        for k, f in enumerate(OBLONG)), OBLONG, times_s=T[14])  # fmt: skip
    yield _text("JSON, a key a row", "".join(
        json.dumps({"ms": 50 * k, **{f"r{i}": r.tolist() for i, r in enumerate(f)}}) + "\n"
        for k, f in enumerate(OBLONG)), OBLONG, times_s=T[14])  # fmt: skip
    keyed = {str(k): f.tolist() for k, f in enumerate(OBLONG)}
    yield _text("JSON, a key a frame", json.dumps(keyed), OBLONG)
    tall = film(1, 12, 8, 1)
    sized = {"width": 8, "height": 12, "data": tall[0].ravel().tolist()}
    yield _text("JSON, width and height", json.dumps(sized), tall)
    yield _refused(
        "JSON, an object a cell",
        json.dumps([{"row": r, "col": c, "value": v} for (r, c), v in np.ndenumerate(OBLONG[0])]),
        "read_json",
    )
    yield Dialect("NumPy, an array a frame", npz(**{f"frame_{k}": f for k, f in enumerate(OBLONG)}),
                  OBLONG)  # fmt: skip
    nameless = {f"arr_{k}": f for k, f in enumerate(OBLONG)}
    yield Dialect("NumPy, arrays without names", npz(**nameless), OBLONG)
    yield Dialect("NumPy, one channel", npz(x=OBLONG[..., None]), OBLONG)
    yield Dialect("NumPy, times beside", npz(X=OBLONG, t=T[14], y=np.arange(14) % 3), OBLONG,
                  times_s=T[14])  # fmt: skip
    yield _refused("NumPy, an array a finger", npz(finger0=OBLONG[0], finger1=OBLONG[1]),
                   "name one with sensor", values=OBLONG[1:2],
                   told={"sensor": "finger1"})  # fmt: skip
    yield _refused("NumPy, frames along the last axis by how neighbours differ",
                   npy(np.moveaxis(_slow(40, 10, 7), 0, -1)), "along the last axis",
                   values=_slow(40, 10, 7), told={"rows": 10, "columns": 7})  # fmt: skip
    fields = np.zeros(3, dtype=[("t", "f8"), ("p", "u2", (8, 8))])
    yield _refused("NumPy, an array of fields", npy(fields), "array['p']")
    yield _refused(
        "NumPy, channels along the last axis", npy(np.zeros((5, 8, 8, 2))), "[..., channel]"
    )
    yield _refused("NumPy, cells down a column", npy(SQUARE.reshape(20, 64).T),
                   "20 frames of 8 x 8 with their cells in a column",
                   told={"rows": 8, "columns": 8})  # fmt: skip
    rows = film(30, 12, 8, 1)
    yield _refused("NumPy, cells in a row, no square", npy(rows.reshape(30, 96)),
                   "30 frames of 12 x 8 with their cells in a row", values=rows,
                   told={"rows": 12, "columns": 8})  # fmt: skip
    yield _refused("NumPy, four axes", npy(np.zeros((2, 5, 8, 8))), "reshape(-1, 8, 8)")
    yield _refused("packed", gzip.compress(_block(SQUARE[0]).encode(), mtime=0), "gunzip")
    yield _refused("a pickle", pickle.dumps(SQUARE), "may run any program")
    yield _refused("Parquet", b"PAR1\x15\x04\x15\xf0", "read_parquet")
    yield _refused("bytes without a header", SQUARE.astype("<u2").tobytes(), "numpy.fromfile")
    book = io.BytesIO()
    with zipfile.ZipFile(book, "w") as archive:
        archive.writestr("xl/workbook.xml", "<x/>")
    yield _refused("an Excel workbook", book.getvalue(), "CSV")


def _slow(n: int, rows: int, columns: int) -> Array:
    """Return frames that differ little from one to the next: a patch that moves slowly."""
    y, x = np.mgrid[:rows, :columns]
    at = [(rows * (0.3 + 0.3 * k / n), columns * (0.65 - 0.3 * k / n)) for k in range(n)]
    return np.array([np.round(900.0 * np.exp(-((y - a) ** 2 + (x - b) ** 2) / 3.0)) for a, b in at])


def _newcomers() -> Iterator[Dialect]:
    """As found on the disks of people who had never heard of the readers."""
    cells = _names("Z{}S{} [kPa]", OBLONG[0], ";", 1)
    lines = (f"{_german(0.05 * k, 3)};{_line(f, ';')}\n" for k, f in enumerate(OBLONG))
    yield _text("German, unit behind each cell's name, time 'in s'",
                f"Bediener: M\u00fcller;;;\n;;;\nZeit in s;{cells}\n" + "".join(lines), OBLONG,
                times_s=T[14], quantity="kilopascal")  # fmt: skip
    rows = [[f"Zeile {i + 1};" + ";".join(map(_german, r)) for i, r in enumerate(f)]
            for f in OBLONG]  # fmt: skip
    head = ";" + ";".join(f"Spalte {c + 1}" for c in range(7))
    yield _text("German, rows and columns named",
                "".join(f"Bild {k + 1}\n{head}\n" + "\n".join(r) + "\n\n"
                        for k, r in enumerate(rows)), OBLONG)  # fmt: skip
    labview = ("LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\t\nChannels\t64\n"
               "Samples\t" + "\t".join(["20"] * 64) + "\n***End_of_Header***\nX_Value\t"
               + "\t".join(f"Voltage_{k}" for k in range(64)) + "\tComment\n")  # fmt: skip
    yield _text(
        "LabVIEW",
        labview
        + "".join(f"{0.05 * k:.6f}\t{_line(f, chr(9), '{:.6f}')}\n" for k, f in enumerate(SQUARE)),
        SQUARE,
    )
    flat = [{"t_us": 50000 * k, "shape": [5, 7], "values": f.ravel().tolist()}
            for k, f in enumerate(OBLONG)]  # fmt: skip
    yield _text("JSON, the shape in each line", "\n".join(map(json.dumps, flat)), OBLONG,
                times_s=T[14])  # fmt: skip
    named = [{"ms": 50 * k, "cells": {f"r{r}c{c}": v for (r, c), v in np.ndenumerate(f)}}
             for k, f in enumerate(OBLONG)]  # fmt: skip
    yield _text("JSON, a key a cell", json.dumps(named), OBLONG, times_s=T[14])
    yield _text("lists of rows, a frame a line", "".join(f"{f.tolist()}\n" for f in OBLONG), OBLONG)
    yield _refused("lists of rows behind words",
                   "".join(f"frame {k}: {f.tolist()}\n" for k, f in enumerate(OBLONG)),
                   "leave them out")  # fmt: skip
    events = (
        f"{1700000000000 + 50 * k},{c},{r},{v:.0f}\n" for (k, r, c), v in np.ndenumerate(OBLONG)
    )
    since_1970 = "epoch_ms,x,y,force_N\n" + "".join(events)
    yield _text("a cell a line, time since 1970", since_1970, OBLONG, times_s=T[14])
    columns = "cell," + ",".join(f"t={0.1 * k:.1f}s" for k in range(14)) + "\n"
    across = (f"cell{n},{_line(r)}\n" for n, r in enumerate(OBLONG.reshape(14, 35).T))
    yield _refused("a frame a column, named as times", columns + "".join(across), "transposed")
    noise = np.random.default_rng(1).normal(0.0, 5.0, (12, 10, 7))
    yield _refused("NumPy, noisy frames along the last axis",
                   npy(np.moveaxis(_slow(12, 10, 7) + noise, 0, -1)), "along the last axis",
                   values=_slow(12, 10, 7) + noise, told={"rows": 10, "columns": 7})  # fmt: skip
    yield _refused("ROS, a value a line", "".join(
        "header:\n  frame_id: palm\ndata:\n" + "".join(f"- {v:.3f}\n" for v in f.ravel()) + "---\n"
        for f in OBLONG), "on one line")  # fmt: skip
    tables = {f"f{k}.csv": _block(f).encode() for k, f in enumerate(OBLONG)}
    yield _refused("a zip of tables", zipped(tables), "unpack it")
    yield _refused("HTML", f"<table><tr><td>{_line(SQUARE[0], '</td><td>')}</td></tr></table>",
                   "spreadsheet")  # fmt: skip
    yield _refused(
        "hexadecimal without 0x",
        "".join(" ".join(f"{int(v) % 256:02X}" for v in f.ravel()) + "\n" for f in SQUARE),
        "decimal",
    )
    yield _refused("a header alone", "time,c0,c1,c2,c3\n", "line for each frame is missing")
    yield _refused("Influx", "".join(
        f"mat,dev=a {','.join(f'c{n}={v:.0f}' for n, v in enumerate(f.ravel()))} 17\n"
        for f in SQUARE), "separated by commas")  # fmt: skip


def _hdf5() -> Iterator[Dialect]:
    """As other laboratories keep HDF5."""
    import h5py

    def packed(**sets: Any) -> bytes:
        buffer = io.BytesIO()
        with h5py.File(buffer, "w") as file:
            for name, values in sets.items():
                file[name.replace("__", "/")] = values
        return buffer.getvalue()

    yield Dialect("HDF5, one matrix", packed(map=OBLONG[0]), OBLONG[:1])
    yield Dialect("HDF5, a dataset a frame",
                  packed(**{f"scan{k}": f for k, f in enumerate(OBLONG)}), OBLONG)  # fmt: skip
    grouped = {f"frames__{k:03d}__data": f for k, f in enumerate(OBLONG)}
    yield Dialect("HDF5, a group a frame", packed(**grouped), OBLONG)
    slow = _slow(40, 10, 7)
    yield _refused("HDF5, frames along the last axis", packed(data=np.moveaxis(slow, 0, -1)),
                   "along the last axis", values=slow,
                   told={"rows": 10, "columns": 7})  # fmt: skip
    yield _refused("HDF5 of a robot", packed(
        observations__qpos=np.random.default_rng(0).normal(size=(14, 7)), timestamps=T[14],
        observations__tactile=OBLONG.reshape(14, 35)), "name one with sensor", values=OBLONG,
        times_s=T[14],
        told={"sensor": "observations/tactile", "rows": 5, "columns": 7})  # fmt: skip


def _pictures() -> Iterator[Dialect]:
    grey = SQUARE[0].clip(0, 255).astype(np.uint8)
    both = np.stack([grey, np.full_like(grey, 255)], axis=-1)
    yield Dialect("PNG of grey and how much shines through", picture(both, "png"),
                  grey[None].astype(float))  # fmt: skip


def more_dialects(hdf5: bool = True) -> list[Dialect]:
    """Return all files; those of HDF5 take h5py, those of pictures imageio."""
    texts = [_sheets, _logs, _instruments, _stacks, _newcomers]
    parts = [*texts, _pictures, *([_hdf5] if hdf5 else [])]
    return [d for part in parts for d in part()]
