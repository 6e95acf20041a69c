"""More recordings in dialects: counters, clocks, units, cells and files of strangers."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from helpers_dialects import (
    OBLONG,
    SHAPE,
    SMALL,
    SQUARE,
    Array,
    Dialect,
    film,
    npz,
    picture,
    zipped,
)

CENT = 0.02 * np.arange(20)
NAMES = ",".join(f"r{r}c{c}" for r in range(8) for c in range(8))
NUMBERED = ",".join(f"v{k}" for k in range(64))
LOST = np.where(np.arange(64).reshape(8, 8) == 20, np.nan, SQUARE)
LARGE = 100.0 * SQUARE


def _line(frame: Array, separator: str = ",", form: str = "{:.0f}") -> str:
    return separator.join(form.format(v) for v in frame.ravel())


def _read(name: str, content: str | bytes, values: Array = SQUARE, **rest: object) -> Dialect:
    data = content if isinstance(content, bytes) else content.encode()
    return Dialect(name, data, values, **rest)  # type: ignore[arg-type]


def _refused(name: str, content: str | bytes, words: str, **rest: object) -> Dialect:
    return _read(name, content, **{"values": SQUARE, **rest}, refused=words)


def _led(stamps: Iterable[object], header: str = "", frames: Array = SQUARE) -> str:
    """Return a table of frames behind their stamps."""
    lines = [f"{s},{_line(f)}\n" for s, f in zip(stamps, frames, strict=False)]
    return (f"{header}\n" if header else "") + "".join(lines)


def _written(texts: Sequence[str], header: str = NAMES, at: int = 20) -> str:
    """Return a table in which one cell is written as each of the texts in turn."""
    lines = []
    for k, frame in enumerate(SQUARE):
        cells = _line(frame).split(",")
        cells[at] = texts[k % len(texts)]
        lines.append(f"{0.02 * k:.2f},{','.join(cells)}\n")
    return f"t,{header}\n{''.join(lines)}"


def _mapped(values: Array, write: object) -> str:
    head = ";".join(f"R{r}C{c}" for r in range(8) for c in range(8))
    lines = [";".join(map(write, f.ravel())) for f in values]  # type: ignore[call-overload]
    return "\n".join([head, *lines]) + "\n"


def _counters() -> Iterator[Dialect]:
    n = range(20)
    yield _read("a number before unnamed cells", _led(n))
    yield _read(
        "R, write.table",
        " ".join(f'"V{k + 1}"' for k in range(64))
        + "\n"
        + "".join(f'"{k + 1}" {_line(f, " ")}\n' for k, f in enumerate(SQUARE)),
    )
    bytes_ = [(250 + k) % 256 for k in n]
    yield _read("a counter of a byte runs over", _led(bytes_, f"seq,{NUMBERED}"))
    many = film(700, 3, 5)
    head = ",".join(f"r{r}c{c}" for r in range(3) for c in range(5))
    yield _read(
        "a counter runs over late", _led((k % 500 for k in range(700)), f"seq,{head}", many), many
    )
    cells = [f"{k % 256},{r},{c},{v:.0f}\n" for (k, r, c), v in np.ndenumerate(many)]
    yield _read("a cell a line, a counter runs over", f"seq,row,col,value\n{''.join(cells)}", many)
    mixed = [f"{k},{r},{c},{v:.0f}\n" for (k, r, c), v in np.ndenumerate(OBLONG)]
    np.random.default_rng(3).shuffle(mixed)
    yield _read("a cell a line, mixed", f"frame,row,col,value\n{''.join(mixed)}", OBLONG)


def _clocks() -> Iterator[Dialect]:
    n, ns = range(20), [20_000_000 * k for k in range(20)]
    over = [(2**32 - 100_000 + 20_000 * k) % 2**32 for k in n]
    timed = {"times_s": CENT}
    yield _read("micros() runs over", _led(over, f"us,{NUMBERED}"), **timed)
    yield _read(
        "nanoseconds called stamp", _led((10**9 + x for x in ns), f"stamp_ns,{NUMBERED}"), **timed
    )
    parts = [f"1709287200,{x}" for x in ns]
    yield _read("ROS, seconds and nanoseconds", _led(parts, f"sec,nanosec,{NAMES}"), **timed)
    days = [f"{1 + k // 2:02d}.03.2024,{10 + k % 2}:00:00" for k in n]
    yield _read(
        "a column of dates beside one of times",
        _led(days, f"Datum,Uhrzeit,{NUMBERED}"),
        times_s=86400.0 * (np.arange(20) // 2) + 3600.0 * (np.arange(20) % 2),
    )
    yield _read(
        "minutes and seconds of a spreadsheet",
        _led((f"00:{k:02d}.0" for k in n), f"time,{NAMES}"),
        times_s=1.0 * np.arange(20),
    )
    yield _read(
        "MATLAB, a timetable", _led((f"{x:.2f} sec" for x in CENT), f"Time,{NAMES}"), **timed
    )
    yield _read("milliseconds with their unit", _led(f"{20 * k}ms" for k in n), **timed)
    scope = [f"{x:.6f}" for x in CENT]
    yield _read(
        "an oscilloscope's X(s) and line of units",
        _led(scope, f"X(s),{NUMBERED}\nSecond,{','.join(['Volt'] * 64)}"),
        quantity="volt",
        **timed,
    )
    monitor = "".join(f"10:02:00.{20 * k:03d} > {_line(f)}\n" for k, f in enumerate(SQUARE))
    yield _read("PlatformIO, a filter for time", monitor, **timed)
    yield _read("NumPy, a rate beside", npz(frames=SQUARE, fps=50.0), **timed)
    dates = np.datetime64("2024-03-01T10:00") + (20 * np.arange(20)).astype("timedelta64[ms]")
    yield _read("NumPy, dates beside", npz(frames=SQUARE, time=dates), **timed)


def _cells() -> Iterator[Dialect]:
    missing = ["NaN", "", "-", "Inf", "1.#QNAN", "#N/A", "None", "#DIV/0!", "-1.#IND", "#NV", "."]
    yield _read("missing cells as spreadsheets and loggers write them", _written(missing), LOST)
    first = "".join(f"#N/A,{_line(f.ravel()[1:])}\n" for f in SQUARE)
    yield _read(
        "the first cell of each line is #N/A",
        f"{NAMES}\n{first}",
        np.where(np.arange(64).reshape(8, 8) == 0, np.nan, SQUARE),
    )
    for name, mark in (("French, narrow blanks", "\u202f"), ("Swiss, apostrophes", "'")):
        yield _read(
            f"{name} between thousands",
            _mapped(LARGE, lambda v, m=mark: f"{v:,.1f}".replace(",", m)),
            LARGE,
        )
    yield _read(
        "Spanish, points between thousands alone",
        _mapped(1000 * LARGE, lambda v: f"{v:,.0f}".replace(",", ".")),
        1000 * LARGE,
    )
    once = 3.0 * SQUARE
    yield _refused(
        "points between thousands, or decimal ones",
        _mapped(once, lambda v: f"{v:,.0f}".replace(",", ".")),
        "without marks between thousands",
        values=once,
    )
    cells = [[f"{v:,.0f}".replace(",", ".") for v in f.ravel()] for f in once]
    timed = "".join(f"{0.04167 * k:.5f};{';'.join(c)}\n" for k, c in enumerate(cells))
    yield _read(
        "points before three decimals or none, and before five of the times",
        f"t;{';'.join(f'R{r}C{c}' for r in range(8) for c in range(8))}\n{timed}",
        np.array(cells, float).reshape(once.shape),
    )
    pairs = ",".join(f'"({r}, {c})"' for r in range(8) for c in range(8))
    yield _read(
        "pandas, names that are pairs", _led((f"{x:.2f}" for x in CENT), f"t,{pairs}"), times_s=CENT
    )
    rows = [f"{k},{r},{_line(x)}\n" for k, f in enumerate(OBLONG) for r, x in enumerate(f)]
    yield _read(
        "pandas, frames and rows numbered",
        f"frame,row,{','.join(map(str, range(10)))}\n{''.join(rows)}",
        OBLONG,
    )
    sums = [
        "\n".join([*(f"{_line(r)},{r.sum():.0f}" for r in f), f"{_line(f.sum(0))},{f.sum():.0f}"])
        for f in OBLONG
    ]
    yield _read("matrices with sums of rows and columns", "\n\n".join(sums) + "\n", OBLONG)
    volts = ",".join(f"Dev1/ai{k} (V)" for k in range(64))
    yield _read(
        "a card's channels",
        _led((f"{x:.3f}" for x in CENT), f"Time (s),{volts}"),
        quantity="volt",
        times_s=CENT,
    )
    mixed = ",".join(f"r{k // 8}c{k % 8} [{'kPa' if k % 2 else 'psi'}]" for k in range(64))
    yield _refused("cells in two units", _led(range(20), f"t,{mixed}"), "in several units")
    melted = [f"{0.02 * k:.2f},r{r}c{c},{v:.0f}\n" for (k, r, c), v in np.ndenumerate(SMALL)]
    yield _refused(
        "pandas, melted",
        f"time,variable,value\n{''.join(melted)}",
        "pivot(index='time', columns='variable', values='value')",
    )


def _others() -> Iterator[Dialect]:
    pads = [
        json.dumps({"sensor": s, "t": 0.02 * k, "data": (f + i).tolist()})
        for k, f in enumerate(SQUARE)
        for i, s in enumerate(("left", "right"))
    ]
    yield _refused(
        "JSON lines of two sensors",
        "\n".join(pads),
        "name one with sensor",
        told={"sensor": "left"},
        times_s=CENT,
    )
    packed = [
        json.dumps({"data": base64.b64encode(f.astype("<u2").tobytes()).decode()}) for f in SQUARE
    ]
    yield _refused("JSON, cells in base64", "\n".join(packed), "b64decode")
    yield _refused("JSON cut off", json.dumps(OBLONG.tolist())[:-50], "is cut off")
    yield _refused(
        "pandas, JSON by columns", json.dumps({"a": {"0": 1}, "b": {"0": 2}}), "pandas.read_json"
    )
    yield _refused("a film", b"\0\0\0\x18ftypmp42" + bytes(100), "it is a film")
    yield _refused("a PGM picture", b"P5\n8 8\n255\n" + bytes(64), "as PNG")
    yield _refused("XML", "<?xml version='1.0'?>\n<f>" + _line(SQUARE[0], " ") + "</f>\n", "as CSV")
    yield _refused(
        "hexadecimal behind 0x",
        _mapped(SQUARE, lambda v: f"0x{int(v):x}").partition("\n")[2],
        "are hexadecimal",
    )
    yield _refused(
        "a dump of xxd",
        "".join(f"{k:08x}: 0c0e 0c0b 0d0e 110d  ....\n" for k in range(9)),
        "are hexadecimal",
    )
    yield _refused("NumPy, complex numbers", npz(frames=SQUARE[:1] + 1j), "is complex")
    yield _refused(
        "NumPy, cells in a row",
        npz(frames=OBLONG.reshape(12, 60)),
        "rows and columns",
        values=OBLONG,
        told=SHAPE,
    )


def _pictures() -> Iterator[Dialect]:
    sizes = {
        f"{k}.png": picture(f.astype(np.uint16), "png") for k, f in enumerate((SQUARE[0], SMALL[0]))
    }
    yield _refused("a zip of pictures of two sizes", zipped(sizes), "of one size")


def stranger_dialects(pictures: bool = True) -> list[Dialect]:
    """Return all files; those of pictures take imageio."""
    parts = [_counters, _clocks, _cells, _others, *([_pictures] if pictures else [])]
    return [d for part in parts for d in part()]
