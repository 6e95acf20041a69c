"""What a file is that no reader takes, and what to do about it."""

from __future__ import annotations

import re
import struct

from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.words.names import named

_AS_CSV = "save its sheet as CSV"
_UNPACK = "unpack it first"
_AS_PICTURES = "save its frames as PNG or TIFF pictures, or as .npy"
_MARKS = (
    (b"\x1f\x8b", "packed by gzip", f"{_UNPACK}: gunzip -k FILE"),
    (b"BZh", "packed by bzip2", f"{_UNPACK}: bunzip2 -k FILE"),
    (b"\xfd7zXZ\0", "packed by xz", f"{_UNPACK}: unxz -k FILE"),
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", _UNPACK),
    (b"Rar!", "a RAR archive", _UNPACK),
    (b"\xd0\xcf\x11\xe0", "an old office document (.xls)", _AS_CSV),
    (b"PAR1", "Parquet", "in Python: pandas.read_parquet('FILE').to_csv('out.csv', index=False)"),
    (b"ARROW1", "Arrow or Feather",
     "in Python: pandas.read_feather('FILE').to_csv('out.csv', index=False)"),
    (b"\x80\x02", "a Python pickle", ""),
    (b"\x80\x03", "a Python pickle", ""),
    (b"\x80\x04", "a Python pickle", ""),
    (b"\x80\x05", "a Python pickle", ""),
    (b"#ROSBAG", "a ROS 1 bag", "convert it to MCAP: mcap convert FILE out.mcap"),
    (b"SQLite format 3", "an SQLite database (a ROS 2 bag?)",
     "convert it to MCAP, or save its table as CSV"),
    (b"<", "HTML or XML", "open it in a spreadsheet, and save its table as CSV"),
    (b"%PDF", "a PDF", "save the numbers it was made from"),
    (b"RIFF", "a film, a sound or a WebP picture", _AS_PICTURES),
    (b"P2\n", "a PGM picture", "save it as PNG or TIFF"),
    (b"P5\n", "a PGM picture", "save it as PNG or TIFF"),
    (b"P5 ", "a PGM picture", "save it as PNG or TIFF"),
    (b"HDF_UC", "HDF4", "save its array as .npy or HDF5"),
)  # fmt: skip
_PICKLE = (
    "it is not opened, as it may run any program; in Python, where you trust it: "
    "numpy.save('out.npy', the frames as an array)"
)
_SHEETS = {
    "xl/workbook.xml": "an Excel workbook",
    "xl/workbook.bin": "an Excel workbook",
    "content.xml": "an OpenDocument sheet",
    "word/document.xml": "a Word document",
}
_HEXADECIMAL = re.compile(
    r"(?:0x[0-9a-f]+[\s,;]*){3,}|(?=.*[a-f])(?:(?:[0-9a-f]{2}){1,4}[\s,;]+){7,}"
    r"(?:[0-9a-f]{2}){1,4}|[0-9a-f]{7,8}:(?: [0-9a-f]{4}){4,8}.*",
    re.IGNORECASE,
)
_WITH_UNITS = re.compile(
    r"(?:[-+\d.,]+\s*[;\t,]\s*)?(?:[-+]?\d+(?:\.\d+)?\s?[a-zA-Z%]+\s*[,;\t]\s*){2,}.*"
)
_FORTRAN = re.compile(r"\d\.?\d*[dD][-+]\d\d")
_AS_TABLE = (
    "write the numbers of a frame on a line of its own, separated by commas, and no words among "
    "them, or read it by a plugin: tactile-graph new my-reader --kind reader"
)
_RAW = (
    "in Python, with the type and the shape of its values: numpy.save('out.npy', "
    "numpy.fromfile('FILE', '<u2').reshape(-1, ROWS, COLUMNS))"
)


def remedy_for(head: Head) -> str:
    """Return what the file is and how it can be made readable; empty where it cannot be told."""
    for mark, what, remedy in _MARKS:
        if head.raw.startswith(mark):
            return f"it is {what}: {remedy or _PICKLE}".replace("FILE", head.path.name)
    if _is_matlab_4(head.raw):
        return "it is a MATLAB file of version 4: save it anew, save('out.mat', '-v7')"
    if head.raw[4:8] == b"ftyp":
        return f"it is a film: {_AS_PICTURES}"
    if head.raw[257:262] == b"ustar":
        return f"it is a tar archive: unpack it first: tar -xf {head.path.name}"
    if any(_FORTRAN.search(line) for line in head.first(3)):
        return "its exponents are Fortran's (1.2D+03): write them as 1.2E+03"
    if any("\u2212" in line for line in head.first(5)):
        return "its minus signs are U+2212: write them as '-'"
    if any(_HEXADECIMAL.fullmatch(line.strip()) for line in head.first(5)):
        return "its numbers are hexadecimal: write them as decimal ones"
    if any(_WITH_UNITS.fullmatch(line.strip()) for line in head.first(5)):
        return "a unit stands behind each of its numbers: leave them out"
    if melted := _melted(head.first(60)):
        return melted.replace("FILE", head.path.name)
    return ""


def _melted(lines: list[str]) -> str:
    """Return what to do with a cell a line that is known by its name: ``0.02,r0c1,17``."""
    fields = [[f.strip().strip('"') for f in re.split(r"[,;\t]", line)] for line in lines]
    if len(fields) < 3 or len(fields[0]) not in (2, 3) or len({*map(len, fields)}) > 1:
        return ""
    for k, column in enumerate(zip(*fields[1:], strict=True)):
        lettered = all(any(c.isalpha() for c in text) for text in column)
        if lettered and named(tuple(dict.fromkeys(column))).places:
            header = fields[0]
            time = next((n for j, n in enumerate(header[:-1]) if j != k), "")
            index = f"index={time!r}, " if time else ""
            return (
                f"each of its lines is a cell by its name ({column[0]!r}); make a line of each "
                f"frame, in Python: pandas.read_csv('FILE').pivot({index}columns={header[k]!r}, "
                f"values={header[-1]!r}).to_csv('out.csv')"
            )
    return ""


def remedy_without_header(head: Head) -> str:
    """Return what to do with bytes that may be bare numbers, and with a text that is no table."""
    if not head.raw:
        return ""
    lines = head.first(2)
    if len(lines) == 1 and len(re.split(r"[,;\t|]", lines[0])) > 1:
        return "it has one line, which may be a header: a line for each frame is missing; "
    if head.lines:
        return f"{_AS_TABLE}; "
    return f"if it is bare numbers, {_RAW}; ".replace("FILE", head.path.name)


def document_in(names: list[str]) -> str:
    """Return what an archive is by the names in it, and what to do; empty for any other."""
    what = next((said for name, said in _SHEETS.items() if name in names), "")
    return f"it is {what}: {_AS_CSV}" if what else ""


def _is_matlab_4(raw: bytes) -> bool:
    if len(raw) < 24:
        return False
    kind, rows, columns, imaginary, length = struct.unpack("<5i", raw[:20])
    known = kind in {p * 10 + t for p in range(6) for t in range(3)}
    name = raw[20 : 20 + max(0, min(length, 64)) - 1]
    return (
        known and imaginary in (0, 1) and min(rows, columns) > 0 and name.isascii() and bool(name)
        and name.decode("ascii").isidentifier()
    )  # fmt: skip
