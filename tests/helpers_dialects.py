"""Small recordings in the many ways people and programs write them, with what they truly hold."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph_sources.recording import recording

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Dialect:
    """One file: its content, its frames in truth, and what must be said where it is refused.

    ``times_s`` are those of the frames counted from the first. ``refused`` are words of the
    remedy; empty where the file must be read. ``told`` are settings that the refusal asks for.
    """

    name: str
    content: bytes
    values: Array
    times_s: Array | None = None
    refused: str = ""
    told: dict[str, Any] = field(default_factory=dict)
    quantity: str = "raw"
    pitch_cm: tuple[float, float] | None = None


def film(n: int, rows: int, columns: int, seed: int = 0) -> Array:
    """Return frames of whole counts: a pad at rest near 12 on which two patches move about."""
    rng = np.random.default_rng([seed, n, rows, columns])
    y, x = np.mgrid[:rows, :columns]
    frames = rng.integers(10, 15, (n, rows, columns)).astype(float)
    for k, frame in enumerate(frames):
        for phase in (0.0, 2.6):
            cy = (rows - 1) * (0.5 + 0.3 * np.sin(0.7 * k + phase))
            cx = (columns - 1) * (0.5 + 0.3 * np.cos(0.5 * k + phase))
            frame += np.round(600.0 * np.exp(-((y - cy) ** 2 + (x - cx) ** 2) / 2.5))
    return frames


def rows_of(frame: Array, separator: str = ",", form: str = "{:.0f}") -> list[str]:
    return [separator.join(form.format(v) for v in row) for row in frame]


def flat(
    values: Array,
    stamps: Iterable[str] | None = None,
    header: str = "",
    separator: str = ",",
    form: str = "{:.0f}",
    order: str = "C",
) -> str:
    """Return a table of one frame a line, each behind its stamp."""
    lines = [header] if header else []
    cells = [separator.join(form.format(v) for v in f.ravel(order=order)) for f in values]  # type: ignore[call-overload]
    if stamps is not None:
        cells = [f"{s}{separator}{line}" for s, line in zip(stamps, cells, strict=True)]
    return "\n".join([*lines, *cells]) + "\n"


def long(values: Array, header: str, columns: str = "krcv", separator: str = ",") -> str:
    """Return a table of one cell a line; ``columns`` says which is what (k frame, t time)."""
    lines = [header] if header else []
    for (k, r, c), v in np.ndenumerate(values):
        at = {"k": k, "r": r, "c": c, "v": f"{v:.0f}", "t": f"{0.02 * k:.2f}", "R": r + 1}
        at |= {"C": c + 1, "K": k + 1, "u": 4000 * k + 3 * (r * values.shape[2] + c)}
        lines.append(separator.join(str(at[x]) for x in columns))
    return "\n".join(lines) + "\n"


def stacked(values: Array, between: str = "", separator: str = ",", form: str = "{:.0f}") -> str:
    """Return matrices with a blank line, or one of ``between``, after each."""
    blocks = ["\n".join(rows_of(f, separator, form)) for f in values]
    if not between:
        return "\n\n".join(blocks) + "\n"
    return "".join(f"{between.format(k)}\n{b}\n" for k, b in enumerate(blocks))


def npy(array: NDArray[Any]) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array)
    return buffer.getvalue()


def npz(**arrays: NDArray[Any]) -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


def picture(array: NDArray[Any], kind: str) -> bytes:
    import imageio.v3 as iio

    return bytes(iio.imwrite("<bytes>", array, extension=f".{kind}"))


def zipped(files: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return buffer.getvalue()


SQUARE, OBLONG, SMALL, PRIME = film(20, 8, 8), film(12, 6, 10), film(15, 3, 5), film(10, 12, 32)
TIMES = 0.02 * np.arange(20)
SHAPE = {"rows": 6, "columns": 10}


def _text(name: str, text: str, values: Array, **rest: Any) -> Dialect:
    return Dialect(name, text.encode(), values, **rest)


def _serial() -> Iterator[Dialect]:
    """What microcontrollers print."""
    ms = [f"{1000 + 20 * k}" for k in range(20)]
    clock = [f"12:00:{k // 50:02d}.{20 * k % 1000:03d}" for k in range(20)]
    yield _text("Arduino, bare lines of 64", flat(SQUARE), SQUARE)
    yield _text("Arduino, millis in front, no header", flat(SQUARE, ms), SQUARE, times_s=TIMES)
    yield _text(
        "Arduino, header millis,v0…", flat(SQUARE, ms, "millis," + _names("v{}", 64)), SQUARE,
        times_s=TIMES,
    )  # fmt: skip
    yield _text(
        "Arduino, boot words first",
        "Booting...\nCalibrating sensor\nReady.\n" + flat(SQUARE), SQUARE,
    )  # fmt: skip
    yield _text(
        "Arduino, serial monitor's clock and arrow",
        "".join(f"{t} -> {x}\n" for t, x in zip(clock, flat(SQUARE).split("\n"), strict=False)),
        SQUARE, times_s=TIMES,
    )  # fmt: skip
    yield _text(
        "Arduino, matrices between ruled lines",
        stacked(OBLONG, separator="\t").replace("\n\n", "\n--------\n"), OBLONG,
    )  # fmt: skip
    yield _text("Arduino, matrices between blank lines", stacked(OBLONG, separator=" "), OBLONG)
    yield _text(
        "Arduino, F before each line", "".join(f"F,{x}\n" for x in flat(SQUARE).split()), SQUARE
    )
    yield _text(
        "Arduino, F and micros", flat(SQUARE, [f"F,{5000000 + 20000 * k}" for k in range(20)]),
        SQUARE, times_s=TIMES,
    )  # fmt: skip
    yield _text("Arduino, trailing commas", flat(SQUARE).replace("\n", ",\n"), SQUARE)
    spaced = flat(SQUARE, separator=", ").splitlines()
    yield _text("Python print, lists", "".join(f"[{x}]\n" for x in spaced), SQUARE)
    yield _text("numpy print of one matrix", str(OBLONG[0].astype(int)) + "\n", OBLONG[:1])
    yield _text(
        "15 values behind a time, 16 in all", flat(SMALL, [f"{0.02 * k:.2f}" for k in range(15)]),
        SMALL, refused="give rows and columns, or a header", told={"rows": 3, "columns": 5},
    )  # fmt: skip
    yield _text(
        "64 values and their sum",
        "".join(f"{x},{f.sum():.0f}\n" for x, f in zip(flat(SQUARE).split(), SQUARE, strict=True)),
        SQUARE,
    )
    yield _text(
        "384 values a line, no word of 12 x 32", flat(PRIME), PRIME,
        refused="12 x 32 cells, as they lie", told={"rows": 12, "columns": 32},
    )  # fmt: skip
    yield _text(
        "a line cut off in the middle",
        flat(SQUARE).replace(flat(SQUARE[5:6]), flat(SQUARE[5:6])[:40] + "\n"),
        np.delete(SQUARE, 5, axis=0),
    )


def _names(form: str, n: int, separator: str = ",") -> str:
    return separator.join(form.format(k) for k in range(n))


def _pairs(form: str, rows: int, columns: int, by_column: bool = False, first: int = 0) -> str:
    pairs = [(r + first, c + first) for r in range(rows) for c in range(columns)]
    if by_column:
        pairs.sort(key=lambda p: (p[1], p[0]))
    return ",".join(form.format(*p) for p in pairs)


def _named() -> Iterator[Dialect]:
    """Tables whose headers name the cells."""
    yield _text(
        "S0_0,S1_0,… column by column",
        flat(SQUARE, header=_pairs("S{}_{}", 8, 8, by_column=True), order="F"), SQUARE,
    )  # fmt: skip
    yield _text("r1c1,r1c2,…", flat(OBLONG, header=_pairs("r{}c{}", 6, 10, first=1)), OBLONG)
    yield _text(
        "x0y0,x1y0,…", flat(OBLONG, header=_pairs("x{1}y{0}", 6, 10)), OBLONG,
    )  # fmt: skip
    yield _text("(0;0) in brackets", flat(SMALL, header=_pairs("p[{}][{}]", 3, 5)), SMALL)
    letters = ",".join(f"{'ABC'[r]}{c + 1}" for r in range(3) for c in range(5))
    yield _text("A1,A2,…,C5", flat(SMALL, header=letters), SMALL)
    yield _text(
        "pandas to_csv with an index, cells named",
        flat(OBLONG, range(12), "," + _pairs("r{}c{}", 6, 10)), OBLONG,
    )  # fmt: skip
    yield _text(
        "cells named backwards",
        flat(SQUARE[:, ::-1, ::-1], header=",".join(f"ch{k}" for k in range(63, -1, -1))), SQUARE,
    )  # fmt: skip
    yield _text(
        "time, 60 numbered cells, battery",
        flat(OBLONG, (f"{0.02 * k:.2f}" for k in range(12)), "time_s," + _names("v{}", 60) + ",bat")
        .replace("\n", ",3.7\n").replace("bat,3.7", "bat"),
        OBLONG, refused="give rows and columns", told=SHAPE,
    )  # fmt: skip
    yield _text(
        "pandas to_csv of a matrix",
        "," + _names("{}", 10) + "\n" + "\n".join(
            f"{k},{x}" for k, x in enumerate(rows_of(OBLONG[0]))
        ) + "\n",
        OBLONG[:1],
    )  # fmt: skip
    yield _text(
        "numpy savetxt with a header",
        "# " + _pairs("r{}c{}", 6, 10).replace(",", " ") + "\n"
        + flat(OBLONG, separator=" ", form="{:.18e}"), OBLONG,
    )  # fmt: skip


def _longs() -> Iterator[Dialect]:
    """Tables with one cell a line."""
    yield _text("row,column,adc of one frame", long(OBLONG[:1], "row,column,adc", "rcv"),
                OBLONG[:1], quantity="counts")  # fmt: skip
    yield _text("row,column,adc of a film", long(OBLONG, "row,column,adc", "rcv"), OBLONG,
                quantity="counts")  # fmt: skip
    yield _text("x,y,z of one frame", long(OBLONG[:1], "x,y,z", "crv"), OBLONG[:1])
    yield _text("X;Y;Z of a film", long(OBLONG, "X;Y;Z", "crv", ";"), OBLONG)
    yield _text("frame,row,col,value", long(OBLONG, "frame,row,col,value"), OBLONG)
    german = long(OBLONG, "Bild;Zeile;Spalte;Wert", "KRCv", ";")
    yield _text("Bild;Zeile;Spalte;Wert from 1", german,
                OBLONG)  # fmt: skip
    yield _text("trame,ligne,colonne,valeur", long(OBLONG, "trame,ligne,colonne,valeur"), OBLONG)
    yield _text("cuadro,fila,columna,valor", long(OBLONG, "cuadro,fila,columna,valor"), OBLONG)
    yield _text("time_s,row,col,pressure", long(OBLONG, "time_s,row,col,pressure", "trcv"), OBLONG,
                times_s=TIMES[:12])  # fmt: skip
    yield _text("micros of each cell", long(OBLONG, "micros,row,col,adc", "urcv"), OBLONG,
                quantity="counts")  # fmt: skip
    yield _text("row, col and two values", long(OBLONG, "row,col,left,right", "rcvv"), OBLONG,
                refused="give value_column", told={"value_column": "right"})  # fmt: skip
    yield _text("row, column, value without a header", long(OBLONG[:1], "", "rcv"), OBLONG[:1],
                refused="put a header")  # fmt: skip


def _spreadsheets() -> Iterator[Dialect]:
    """What spreadsheets save, in three languages."""
    comma = "{:.2f}"
    german = flat(
        SQUARE, (f"{0.02 * k:.2f}" for k in range(20)), "Zeit [s];" + _names("Zelle {}", 64, ";"),
        ";", comma,
    ).replace(".", ",")  # fmt: skip
    yield _text("Zeit [s];Zelle 0;… decimal commas", german, SQUARE, times_s=TIMES)
    yield Dialect(
        "the same with a byte-order mark", b"\xef\xbb\xbf" + german.encode(), SQUARE, TIMES
    )
    yield Dialect("the same in UTF-16", german.encode("utf-16"), SQUARE, TIMES)
    yield _text("Zeit before 15 values", flat(
        SMALL, (f"{0.02 * k:.2f}" for k in range(15)), "Zeit,a,b,c,d,e,f,g,h,i,j,k,l,m,n,o"
    ), SMALL, refused="give rows and columns", told={"rows": 3, "columns": 5})  # fmt: skip
    yield _text(
        "sep=; and Uhrzeit",
        "sep=;\n" + flat(
            SQUARE, (f"01.02.2024 23:59:{59 + k // 50:02d},{20 * k % 1000:03d}" for k in range(20)),
            "Uhrzeit;" + _names("K{}", 64, ";"), ";",
        ), SQUARE, times_s=TIMES,
    )  # fmt: skip
    yield _text(
        "Temps (ms), French",
        flat(SQUARE, (f"{20 * k}" for k in range(20)), "Temps (ms);" + _names("c{}", 64, ";"), ";"),
        SQUARE, times_s=TIMES,
    )  # fmt: skip
    yield _text(
        "words in front: rows, columns, unit, pitch",
        "Device: mat 7\nRows: 6\nColumns: 10\nUnit: kPa\nPitch: 5 mm\nRate: 50 Hz\n\n"
        + flat(OBLONG), OBLONG, times_s=TIMES[:12], quantity="kilopascal", pitch_cm=(0.5, 0.5),
    )  # fmt: skip
    yield _text(
        "German words in front",
        "Gerät;Matte 7\nZeilen;6\nSpalten;10\nEinheit;mV\nRaster;1,3 cm\nAbtastrate;50 Hz\n"
        + flat(OBLONG, separator=";"), OBLONG / 1000.0, times_s=TIMES[:12], quantity="volt",
        pitch_cm=(1.3, 1.3),
    )  # fmt: skip
    yield _text(
        "Spanish words in front",
        "Filas: 6\nColumnas: 10\n" + flat(OBLONG, separator="\t"), OBLONG,
    )  # fmt: skip
    yield _text(
        "words that say another shape", "Size: 7 x 9\n" + flat(OBLONG), OBLONG,
        refused="give rows and columns whose product", told=SHAPE,
    )  # fmt: skip
    yield _text("numbers of columns for a header", _names("{}", 64) + "\n" + flat(SQUARE), SQUARE)
    yield _text("thousands in quotes", flat(SQUARE).replace(",12,", ',"1,012",', 1),
                SQUARE[1:])  # fmt: skip
    yield _text("ISO dates", flat(
        SQUARE, (f"2024-05-01T10:00:{k // 50:02d}.{20 * k % 1000:03d}Z" for k in range(20)),
        "timestamp," + _names("v{}", 64),
    ), SQUARE, times_s=TIMES)  # fmt: skip
    yield _text("epoch in milliseconds", flat(
        SQUARE, (f"{1700000000000 + 20 * k}" for k in range(20)), "timestamp," + _names("v{}", 64)
    ), SQUARE, times_s=TIMES)  # fmt: skip


def _matrices() -> Iterator[Dialect]:
    """Matrices, alone and stacked."""
    yield _text("one matrix, tabs", "\n".join(rows_of(OBLONG[0], "\t")) + "\n", OBLONG[:1])
    yield _text("one 27 x 16 matrix", "\n".join(rows_of(film(1, 27, 16)[0])) + "\n",
                film(1, 27, 16), refused="one matrix or a frame a line",
                told={"rows": 27, "columns": 16})  # fmt: skip
    yield _text("Frame 0: before each matrix", stacked(OBLONG, "Frame {}:"), OBLONG)
    yield _text("Bild 0 before each matrix", stacked(OBLONG, "Bild {}", ";"), OBLONG)
    noted = (f"# frame {k}\n{stacked(OBLONG[k : k + 1])}" for k in range(12))
    yield _text("# frame 0 as a comment, blank lines", "\n".join(noted), OBLONG)
    yield _text("frames of 5 x 20 in rows of 100", flat(film(30, 5, 20)), film(30, 5, 20),
                refused="5 x 20", told={"rows": 5, "columns": 20})  # fmt: skip
    yield _text("6 x 10 frames, 60 values a line", flat(OBLONG), OBLONG,
                refused="rows and columns", told=SHAPE)  # fmt: skip
    yield _text("matrices with numbered rows", stacked(
        np.concatenate([np.tile(np.arange(6.0)[None, :, None], (12, 1, 1)), OBLONG], axis=2)
    ), OBLONG)  # fmt: skip


def _arrays() -> Iterator[Dialect]:
    """Arrays, JSON and pictures."""
    yield Dialect(".npy of a film", npy(OBLONG), OBLONG)
    yield Dialect(".npy, frames on the last axis", npy(np.moveaxis(SQUARE, 0, -1)), SQUARE,
                  refused="give rows and columns", told={"rows": 8, "columns": 8})  # fmt: skip
    yield Dialect(".npy of 20 x 64", npy(SQUARE.reshape(20, 64)), SQUARE,
                  refused="give rows and columns", told={"rows": 8, "columns": 8})  # fmt: skip
    yield Dialect(".npz of two films", npz(left=OBLONG, right=OBLONG + 1), OBLONG + 1,
                  refused="name one with sensor", told={"sensor": "right"})  # fmt: skip
    yield Dialect("JSON, a list of matrices", json.dumps(OBLONG.tolist()).encode(), OBLONG)
    yield Dialect("JSON, frames and times", json.dumps(
        {"device": "mat", "timestamps": TIMES[:12].tolist(), "frames": OBLONG.tolist()}
    ).encode(), OBLONG, times_s=TIMES[:12])  # fmt: skip
    yield Dialect("JSON, an object a frame", json.dumps(
        [{"t": t, "data": f.tolist()} for t, f in zip(TIMES, OBLONG, strict=False)]
    ).encode(), OBLONG, times_s=TIMES[:12])  # fmt: skip
    yield Dialect("JSON lines", "".join(
        json.dumps({"time_s": t, "values": f.ravel().tolist()}) + "\n"
        for t, f in zip(TIMES, SQUARE, strict=True)
    ).encode(), SQUARE, times_s=TIMES)  # fmt: skip
    yield Dialect("JSON, rows and columns said", json.dumps(
        {"rows": 6, "columns": 10, "frames": OBLONG.reshape(12, 60).tolist()}
    ).encode(), OBLONG)  # fmt: skip
    in_rows = json.dumps(OBLONG.reshape(12, 60).tolist()).encode()
    yield Dialect("JSON, frames of 60 numbers", in_rows, OBLONG, refused="give rows and columns",
                  told=SHAPE)  # fmt: skip


def matlab(packed: bool = False, **variables: Any) -> bytes:
    """Return a MATLAB file of version 5; packed it is what MATLAB 7 writes."""
    from scipy.io import savemat

    buffer = io.BytesIO()
    savemat(buffer, variables, do_compression=packed)
    return buffer.getvalue()


def cell_array(values: Iterable[Any]) -> NDArray[Any]:
    """Return a cell array."""
    items = list(values)
    found = np.empty((1, len(items)), dtype=object)
    found[0] = items
    return found


def _matlab() -> Iterator[Dialect]:
    last = np.moveaxis(OBLONG, 0, -1)
    yield Dialect("MATLAB, square frames on the last axis",
                  matlab(mat=np.moveaxis(SQUARE, 0, -1), n=3.0), SQUARE)  # fmt: skip
    yield Dialect("MATLAB 7, square frames on the first axis", matlab(True, mat=SQUARE), SQUARE)
    yield Dialect("MATLAB, times beside", matlab(p=last, time_ms=1000.0 * TIMES[:12]), OBLONG,
                  times_s=TIMES[:12])  # fmt: skip
    yield Dialect("MATLAB, nothing tells the frames' axis", matlab(p=last), OBLONG,
                  refused="give rows and columns", told=SHAPE)  # fmt: skip
    yield Dialect("MATLAB 7, a long film", matlab(True, p=np.moveaxis(film(60, 6, 10), 0, -1)),
                  film(60, 6, 10))  # fmt: skip
    rec = {"pressure": last, "t": TIMES[:12], "unit": "kPa", "pitch": "8 mm"}
    yield Dialect("MATLAB, a struct with its unit and pitch", matlab(rec=rec), OBLONG,
                  times_s=TIMES[:12], quantity="kilopascal", pitch_cm=(0.8, 0.8))  # fmt: skip
    yield Dialect("MATLAB, a cell array", matlab(True, frames=cell_array(OBLONG)), OBLONG)
    structs = np.array([[(f, t) for f, t in zip(OBLONG, TIMES, strict=False)]],
                       dtype=[("data", object), ("time", float)])  # fmt: skip
    yield Dialect("MATLAB, a struct a frame", matlab(frames=structs), OBLONG, times_s=TIMES[:12])
    yield Dialect("MATLAB, two films", matlab(left=OBLONG[0], right=OBLONG[1]), OBLONG[1:2],
                  refused="name one with sensor", told={"sensor": "right"})  # fmt: skip
    yield Dialect("MATLAB, one matrix", matlab(p=OBLONG[0]), OBLONG[:1])


def _pictures() -> Iterator[Dialect]:
    grey = np.clip(OBLONG, 0, 255).astype(np.uint8)
    deep = OBLONG.astype(np.uint16)
    yield Dialect("PNG of 8 bits", picture(grey[0], "png"), grey[:1].astype(float))
    yield Dialect("PNG of 16 bits", picture(deep[0], "png"), OBLONG[:1])
    yield Dialect("TIFF of many pages", picture(deep, "tiff"), OBLONG)
    yield Dialect("TIFF of floats", picture(OBLONG.astype(np.float32), "tiff"), OBLONG)
    yield Dialect("PNG of equal colours",
                  picture(np.repeat(grey[0][..., None], 3, axis=2), "png"),
                  grey[:1].astype(float))  # fmt: skip
    colours = np.stack([grey[0], grey[0][::-1], 255 - grey[0]], axis=2)
    yield Dialect("PNG of a coloured heat map", picture(colours, "png"), grey[:1].astype(float),
                  refused="save the values")  # fmt: skip
    pages = {f"f{k}.png": picture(f, "png") for k, f in enumerate(deep)}
    yield Dialect("a zip of PNGs", zipped(pages), OBLONG)


def dialects(pictures: bool = True) -> list[Dialect]:
    """Return all files; those of pictures take imageio."""
    plain = [_serial, _named, _longs, _spreadsheets, _matrices, _arrays, _matlab]
    return [d for part in [*plain, *([_pictures] if pictures else [])] for d in part()]


# -- what became of them -----------------------------------------------------------------------


@dataclass(frozen=True)
class Became:
    """What reading a file came to: ``read``, ``refused`` or ``WRONG``, and in words."""

    outcome: str
    words: str
    report: Report

    def fits(self, dialect: Dialect) -> bool:
        """Return whether that is what was to come of the file."""
        if dialect.refused:
            return self.outcome == "refused" and dialect.refused in self.words
        return self.outcome == "read"


def became(dialect: Dialect, folder: Path, told: Mapping[str, Any] | None = None) -> Became:
    """Return what comes of reading a file, with the settings ``told``, against what it holds."""
    path = folder / "recording"
    path.write_bytes(dialect.content)
    report = Report()
    try:
        frames = list(recording(path=path, report=report, **(told or {})))
    except DataError as error:
        return Became("refused", error.what, report)
    values = [f.image.filled(np.nan) for f in frames]
    if len(values) != len(dialect.values) or values[0].shape != dialect.values[0].shape:
        return Became("WRONG", f"{len(values)} frames of {values[0].shape}", report)
    if not np.allclose(values, dialect.values, equal_nan=True):
        return Became("WRONG", "other values", report)
    image = frames[0].image
    pitch = tuple(round(p, 9) for p in image.pitch_cm)
    if (image.quantity, pitch) != (dialect.quantity, dialect.pitch_cm or (1.0, 1.0)):
        return Became("WRONG", f"{image.quantity}, pitch {pitch} cm", report)
    times = [np.nan if f.time_s is None else f.time_s for f in frames]
    truth = dialect.times_s
    if truth is not None and not np.allclose(np.subtract(times, times[0]), truth - truth[0]):
        return Became("WRONG", f"times {times[:3]} …", report)
    return Became("read", "; ".join(report.counts), report)


def mutated(content: bytes, rng: np.random.Generator) -> bytes:
    """Return a file with one to six places of it changed, lost, doubled or cut off."""
    data = bytearray(content)
    for _ in range(int(rng.integers(1, 7))):
        if not data:
            break
        at = int(rng.integers(len(data)))
        length = int(rng.integers(1, 40))
        kind = int(rng.integers(7))
        if kind == 0:
            data[at] = int(rng.integers(256))
        elif kind == 1:
            data[at] = int(rng.choice(list(b'-]0129BeE,;.\n\r\t "\x00\xff|[{:')))
        elif kind == 2:
            del data[at : at + length]
        elif kind == 3:
            data[at:at] = data[at : at + length]
        elif kind == 4:
            data[at:at] = bytes(rng.integers(0, 256, length, dtype=np.uint8))
        elif kind == 5:
            del data[at:]
        else:
            line_end = data.find(b"\n", at)
            del data[at : line_end if line_end > 0 else len(data)]
    return bytes(data)
