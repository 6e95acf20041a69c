"""Look-alikes of vendors' files, and the vendors' own numbers read back independently."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tactile_graph.steps import Report
from tactile_graph.wires import Frame
from tactile_graph_sources.recording import recording

Array = NDArray[np.float64]
SHARED = Path(__file__).parents[1].parent / "shared/data"


def shared(name: str) -> Path:
    path = SHARED / name
    if not path.exists():
        pytest.skip(f"real recording {name} is not on this machine")
    return path


def frames_of(path: Path | list[Path], **settings: Any) -> tuple[list[Frame], Report]:
    report = Report()
    return list(recording(path=path, report=report, **settings)), report


def write(folder: Path, text: str | bytes, name: str = "recording.dat") -> Path:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def blobs(n: int, rows: int, columns: int, seed: int = 0, decimals: int = 2) -> Array:
    """Return frames with one or two loaded patches each, shape (n, rows, columns)."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:rows, :columns]
    frames = np.zeros((n, rows, columns))
    for frame in frames:
        for _ in range(2):
            cy, cx = rng.uniform(1, rows - 1), rng.uniform(1, columns - 1)
            frame += rng.uniform(50, 300) * np.exp(-((y - cy) ** 2 + (x - cx) ** 2) / 3.0)
    frames[frames < 5.0] = 0.0
    return np.asarray(np.round(frames, decimals))


def texts(row: Sequence[float] | Array, decimals: int = 2) -> list[str]:
    return ["B" if np.isnan(v) else f"{v:.{decimals}f}" for v in row]


# XSENSOR: -----------------------------------------------------------------------------------


def xsensor_text(sensors: dict[str, Array], side_cm: float = 0.86, padding: int = 8) -> str:
    """Return an export in mmHg, with padding commas, blank lines and GROUP blocks."""
    end = "," * padding
    lines = ["\ufeffFile:,C:\\data\\walk.XSN" + end, end, "Units:,mmHg" + end, end]
    for k in range(len(next(iter(sensors.values())))):
        lines += [f"FRAME,{100 + k}{end}", end, f"Time, 23:59:{59 + 0.5 * k:06.3f}{end}", end]
        for name, values in sensors.items():
            lines += [f"SENSOR,{name}{end}", end, *_xsensor_keys(values[k], side_cm, end)]
            lines += ["SENSELS" + end, *(",".join(texts(r)) + end for r in values[k]), end]
            lines += [f"GROUP{end}", f"Name,heel{end}", f"Cells,2{end}", f"SENSELS{end}"]
            lines += [f"1.5,2.5{end}", end]
    return "\n".join(lines) + "\n"


def _xsensor_keys(values: Array, side_cm: float, end: str) -> list[str]:
    load = values.sum() * 0.133322387415 * side_cm**2 * 0.1
    area = np.count_nonzero(values) * side_cm**2
    keys = {
        "Rows": f"{values.shape[0]}",
        "Columns": f"{values.shape[1]}",
        "Sensel Width (cm)": f"{side_cm}",
        "Sensel Height (cm)": f"{side_cm}",
        "Peak Pressure (mmHg)": f"{values.max():.2f}",
        "Contact Area (cm²)": f"{area:.2f}",
        "Est. Load (N)": f"{load:.2f}",
    }
    return [f"{key},{value}{end}" for key, value in keys.items()]


def xsensor_says(path: Path) -> list[dict[str, float]]:
    """Return load, area and peak of each sensor block, GROUP blocks apart."""
    said: list[dict[str, float]] = []
    inside = False
    names = {
        "Est. Load (N)": "load_n",
        "Contact Area (cm²)": "area",
        "Peak Pressure (mmHg)": "peak",
    }
    for line in path.read_text(encoding="utf-8-sig").splitlines():
        key, _, value = line.partition(",")
        if key == "SENSOR":
            said.append({})
        inside = key == "SENSOR" or (inside and key not in ("GROUP", "FRAME"))
        if inside and key in names:
            said[-1][names[key]] = float(value.strip(","))
    return said


# Tekscan: -----------------------------------------------------------------------------------


def tekscan_text(values: Array, units: str = "raw", spacing: str = "0.127 centimeters") -> str:
    """Return an export; NaN becomes ``B``. Raw frames carry their sum."""
    n, rows, columns = values.shape
    lines = ["DATA_TYPE MOVIE", "VERSION Tekscan Pressure Measurement System 6.10I"]
    lines += [f"ROWS {rows}", f"COLS {columns}", f"ROW_SPACING {spacing}", f"COL_SPACING {spacing}"]
    lines += ["SECONDS_PER_FRAME 0.1", "COMMENTS:", "walking 10 m", "START_FRAME 1"]
    lines += [f"END_FRAME {n}", f"UNITS {units}", "ASCII_DATA @@", ""]
    decimals = 0 if units == "raw" else 2
    for k, frame in enumerate(values):
        total = f", {0.1 * k:.1f},, 12/2/2019 6:21:52.34PM,,,Raw Sum=,,{np.nansum(frame):.0f}"
        lines.append(f"Frame {k + 1}" + (total if units == "raw" else ""))
        lines += [",".join(texts(row, decimals)) for row in frame] + [""]
    return "\n".join([*lines, "@@"]) + "\n"


def tekscan_says(path: Path) -> list[float]:
    return [float(s) for s in re.findall(r"Raw Sum=,,(\d+)", path.read_text())]


# pliance: -----------------------------------------------------------------------------------


def pliance_text(values: Array, pitch_cm: tuple[float, float] = (0.528, 1.028)) -> str:
    """Return an export in kPa with its force table and its table of corners."""
    n, rows, columns = values.shape
    ids = range(4, 4 + rows * columns)
    lines = ["file name: walk.mat date/time 17.06.23 15.21", "mat type s2160_001"]
    lines += [f"total times [secs]: {0.04 * n:.3f} time per frame [secs]: 0.04", ""]
    lines += ["pressure values in kPa", "", "", "electrical:"]
    lines.append("time[secs]" + "".join(f"{i:8d}" for i in ids))
    for k, frame in enumerate(values):
        cells = "".join(f"{v:8.3f}" for v in frame.T.ravel())
        lines.append(f"{0.04 * (k + 2):12.5f}{cells}")
    for name, row in (("MPP", values.max(0)), ("MVP", values.mean(0))):
        lines.append(f"{name:>12}" + "".join(f"{v:8.3f}" for v in row.T.ravel()))
    lines += ["", "", " time[secs] force[N]   x[cm]   y[cm]", ""]
    width, area = columns * pitch_cm[0], pitch_cm[0] * pitch_cm[1]
    x = (np.arange(columns) + 0.5) * pitch_cm[0]
    y = (np.arange(rows) + 0.5) * pitch_cm[1]
    lines.append(f"{0.04:12.5f}{0.0:9.3f}       -       -")
    for k, frame in enumerate(values):
        total = frame.sum()
        cx, cy = (frame.sum(0) @ x) / total, (frame.sum(1) @ y) / total
        lines.append(f"{0.04 * (k + 2):12.5f}{total * area * 0.1:9.3f}{width - cx:8.3f}{cy:8.3f}")
    xc, yc = np.repeat(x, rows), np.tile((rows * pitch_cm[1]) - y, columns)
    lines += ["", "", "sensor" + "".join(f"{i:9d}" for i in ids), "corner[cm]"]
    lines += ["x[c]" + "".join(f"{v:9.4f}" for v in xc), "y[c]" + "".join(f"{v:9.4f}" for v in yc)]
    return "\n".join(lines) + "\n"


def pliance_says(path: Path) -> dict[float, tuple[float, float, float]]:
    """Return force (N), x and y (cm, in the vendor's frame) by time, where there is a load."""
    table = path.read_text().partition("force[N]")[2].partition("sensor")[0]
    rows = [line.split() for line in table.splitlines()[1:]]
    return {
        round(float(r[0]), 4): (float(r[1]), float(r[2]), float(r[3]))
        for r in rows
        if len(r) == 4 and r[2] != "-"
    }


# emed: --------------------------------------------------------------------------------------


def emed_text(
    values: Array, first_row: int = 3, first_column: int = 5, summary: bool = True
) -> str:
    """Return an export of a 20 x 24 platform of 0.5 cm in kPa, in Latin-1 with form feeds."""
    pages = []
    for k, frame in enumerate(values):
        pages.append(_emed_page(k + 1, frame, first_row, first_column, f"Pict-No.: {k + 1}"))
    if summary:
        page = _emed_page(len(values) + 1, values.max(0), first_row, first_column, "MPP")
        pages.append(page)
    return "\n" + "\f\n".join(pages) + "\f\n\f\n"


def _emed_page(page: int, frame: Array, first_row: int, first_column: int, what: str) -> str:
    forces = frame * 0.25 * 0.1
    lines = [f"\t\t\t\tPage {page}", "", "\tFile: C:\\novel\\2.dat \tMatrix: 20x24 "]
    lines += ["\tSensor area: 0.25 cm²\tTime/picture:10.0 ms", "\tSensor size: 0.500x0.500 cm"]
    lines += [f"\t{what}  Force[N]=sum*sensor_area in row/column", ""]
    columns = range(first_column, first_column + frame.shape[1])
    lines.append("".join(f"\t{c}" for c in columns) + "\tForce")
    for k, row in enumerate(frame):
        cells = "\t".join([*texts(row), f"{forces[k].sum():.2f}"])
        lines.append(f"{first_row + k}\t{cells}")
    total = [*texts(forces.sum(0)), f"{forces.sum():.2f}"]
    return "\n".join([*lines, "Force\t" + "\t".join(total)]) + "\n"


def emed_says(path: Path) -> list[tuple[dict[int, float], dict[int, float]]]:
    """Return the forces by row number and by column number, for each picture."""
    said = []
    for page in re.split(r"Page\s+\d+", path.read_text(encoding="latin-1"))[1:]:
        if "Pict-No" not in page:
            continue
        lines = page.partition("row/column")[2].splitlines()
        labels = next(line.split() for line in lines if line.split()[-1:] == ["Force"])[:-1]
        rows = {
            int(w[0]): float(w[-1])
            for line in lines
            if (w := line.split())[:1] and w[0].isdigit() and w[-1] != "Force"
        }
        last = next(line.split()[1:] for line in lines if line.startswith("Force"))
        said.append((rows, dict(zip(map(int, labels), map(float, last[:-1]), strict=True))))
    return said


# Others: ------------------------------------------------------------------------------------


def capfingerid_text(values: NDArray[np.int64]) -> str:
    lines = []
    for k, frame in enumerate(values):
        cells = ",".join(str(v) for v in frame.ravel())
        lines.append(f"15;left;thumb;TAP;-1;{1510306588 + k},570843498,{cells},")
    return "\n".join(lines) + "\n"


def popu_bed_text(values: NDArray[np.int64]) -> str:
    snapshots = {
        str(k): {"id": str(200 + k), "tactilus_readings": frame.ravel().tolist()}
        for k, frame in enumerate(values)
    }
    shape = {"tactilus_columns": values.shape[2], "tactilus_rows": values.shape[1]}
    return json.dumps({"volunteer_id": "4", **shape, "snapshots": snapshots})


def npz_bytes(**arrays: Any) -> bytes:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)
    return buffer.getvalue()


def npy_bytes(array: NDArray[Any]) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array, allow_pickle=True)
    return buffer.getvalue()


def flat_text(values: Array, separator: str = ",") -> str:
    return "".join(separator.join(texts(f.ravel())) + "\n" for f in values)


def stacked_text(values: Array, separator: str = ",") -> str:
    return "\n".join("".join(separator.join(texts(r)) + "\n" for r in f) for f in values)


def long_text(values: Array) -> str:
    lines = ["frame,row,col,value"]
    lines += [f"{k},{i},{j},{v:.2f}" for (k, i, j), v in np.ndenumerate(values)]
    return "\n".join(lines) + "\n"
