"""Files that pass for recordings and ask for work out of proportion, each of at most 20 MB."""

from __future__ import annotations

import base64
import gzip
import io
import json
import struct
import sys
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from helpers_dialects import dialects, npz, picture, zipped

MOST_BYTES = 20_000_000
Make = Callable[[Path], Path]


def zeros_deflated(n: int) -> bytes:
    """Return a deflate stream of that many MB of zeros, without making them all."""
    pack = zlib.compressobj(9, zlib.DEFLATED, -15)
    block = pack.compress(bytes(1 << 20)) + pack.flush(zlib.Z_FULL_FLUSH)
    return block * n + pack.flush()


class Member(NamedTuple):
    """A member of an archive: a head stored, and so many MB of zeros packed behind it."""

    name: str
    head: bytes
    n_mb: int


def archive(*members: Member) -> bytes:
    """Return a zip of members that are far larger than it."""
    parts, directory = b"", b""
    for name, head, n in members:
        data = struct.pack("<BHH", 0, len(head), len(head) ^ 0xFFFF) + head + zeros_deflated(n)
        crc = zlib.crc32(head)
        for _ in range(n):
            crc = zlib.crc32(ZEROS, crc)
        sizes = struct.pack("<III", crc, len(data), min(len(head) + (n << 20), 0xFFFFFFFF))
        called = name.encode()
        fields = struct.pack("<HHHHH", 20, 0, 8, 0, 33) + sizes + struct.pack("<HH", len(called), 0)
        directory += b"PK\1\2" + struct.pack("<H", 20) + fields
        directory += struct.pack("<HHHII", 0, 0, 0, 0, len(parts)) + called
        parts += b"PK\3\4" + fields + called + data
    n, size = len(members), len(directory)
    return parts + directory + b"PK\5\6" + struct.pack("<HHHHIIH", 0, 0, n, n, size, len(parts), 0)


ZEROS = bytes(1 << 20)


def npy_head(shape: object, descr: str = "'<f8'", version: int = 1, spare: int = 0) -> bytes:
    """Return the head of an ``.npy`` that says whatever it is told to."""
    said = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}"
    text = said.encode() + b" " * spare + b"\n"
    size = struct.pack("<H" if version == 1 else "<I", len(text) & 0xFFFF if version == 1 else
                       len(text))  # fmt: skip
    return b"\x93NUMPY" + bytes((version, 0)) + size + text


def file_of(name: str, content: Callable[[], bytes]) -> Make:
    """Return what writes a file of that content."""

    def make(folder: Path) -> Path:
        path = folder / name
        path.write_bytes(content())
        return path

    return make


# -- archives and arrays -----------------------------------------------------------------------


def arrays() -> Iterator[tuple[str, Make]]:
    """Yield files of NumPy, and archives."""
    for n in (150, 255, 1000, 3900):
        for shape in ((n << 9, 16, 16), (n << 17,), (1, 1 << 10, n << 7)):
            yield (
                f"npz of {n} MB of zeros, {shape}",
                file_of(
                    "a.npz",
                    lambda n=n, shape=shape: archive(Member("values.npy", npy_head(shape), n)),
                ),
            )
    for shape in ("(1000000000, 16, 16)", "(-5, 16, 16)", "(2, 3037000500, 3037000500)",
                  "(99999999999999999999, 4, 4)", "(1000000, 0, 16)", "((((" * 5000, "()",
                  "(16, 16.0)", "(" + "1," * 200_000 + ")", "(5000000, 2, 2)"):  # fmt: skip
        head = npy_head(shape, version=2)
        yield f"npy that says {shape[:40]}", file_of("a.npy", lambda h=head: h + bytes(4096))
        yield (
            f"npz that says {shape[:40]}",
            file_of("a.npz", lambda h=head: zipped({"values.npy": h + bytes(4096)})),
        )
    types = "[" + ",".join(f"('f{i}', '<f8')" for i in range(60_000)) + "]"
    for descr in (types, "'O'", "'|V1000000000'", "'<U500000000'", "'<f8' " + "+1" * 100_000):
        head = npy_head((2, 2), descr, version=2)
        yield f"npy of type {descr[:30]}", file_of("a.npy", lambda h=head: h + bytes(4096))
    long = npy_head((2, 2), version=2, spare=19_000_000)
    yield "npy with a head of 19 MB", file_of("a.npy", lambda: long + bytes(32))
    yield "npy of 20 MB in one row", file_of("a.npy", lambda: npy_head((1, 2_490_000), version=2)
                                             + bytes(19_920_000))  # fmt: skip
    yield (
        "npz of 20,000 members",
        file_of("a.npz", lambda: npz(**{f"a{i}": np.zeros((2, 2)) for i in range(20_000)})),
    )
    yield (
        "npz of 900 members",
        file_of("a.npz", lambda: npz(**{f"a{i}": np.zeros((20, 20)) for i in range(900)})),
    )
    for numbers in (range(2), range(12)):  # each small enough for an array alone
        parts = [Member(f"frame{i}.npy", npy_head((1 << 13, 240 << 4)), 240) for i in numbers]
        yield f"npz of {len(parts)} arrays of 250 MB", file_of("a.npz", lambda p=parts: archive(*p))
    ours = [Member("values.npy", npy_head((240 << 9, 16, 16)), 240),
            Member("label.npy", npy_head((1,), "'<U62390272'"), 238)]  # fmt: skip
    yield "npz of our own, two arrays of 250 MB", file_of("a.npz", lambda: archive(*ours))
    yield "zip of 150,000 empty members", file_of("a.zip", lambda: zipped(
        {f"{i}": b"" for i in range(150_000)}))  # fmt: skip
    yield (
        "npz whose members are 60,000 letters each",
        file_of(
            "a.npz", lambda: npz(**{chr(97 + i) * 60_000: np.zeros((2, 2)) for i in range(20)})
        ),
    )
    yield "npz of our own, labels of 100 million letters", file_of(
        "a.npz", lambda: npz(values=np.zeros((2, 4, 4)), label=np.array(["x" * 40_000_000, ""]))
        [:0] + archive(Member("label.npy", npy_head((1,), "'<U100000000'"), 382))
    )  # fmt: skip
    yield (
        "npz of our own, truth deep",
        file_of("a.npz", lambda: npz(values=np.ones((2, 4, 4)), truth=np.array("[" * 1_000_000))),
    )
    yield "npz of our own, truth wide", file_of(
        "a.npz", lambda: npz(values=np.ones((2, 4, 4)), truth=np.array("[" + "[]," * 1_000_000 +
                                                                       "[]]"))
    )  # fmt: skip
    yield "cut-off central directory", file_of("a.npz", lambda: archive(Member("values.npy",
                                               npy_head((2, 2)), 100))[:-30])  # fmt: skip


# -- pictures ----------------------------------------------------------------------------------


def png(rows: int, columns: int, packed: bytes, *more: tuple[bytes, bytes]) -> bytes:
    """Return a PNG that says what it is told to."""
    parts = [(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)), *more,
             (b"IDAT", packed), (b"IEND", b"")]  # fmt: skip
    made = b"\x89PNG\r\n\x1a\n"
    for kind, data in parts:
        made += struct.pack(">I", len(data)) + kind + data
        made += struct.pack(">I", zlib.crc32(kind + data))
    return made


def tiff(tags: dict[int, tuple[int, int, int]], rest: bytes = b"", following: int = 0) -> bytes:
    """Return a TIFF of one directory: tag -> type, count, value."""
    made = b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", len(tags))
    for tag, (kind, count, value) in sorted(tags.items()):
        made += struct.pack("<HHII", tag, kind, count, value & 0xFFFFFFFF)
    return made + struct.pack("<I", following) + rest


def pictures() -> Iterator[tuple[str, Make]]:
    """Yield PNG, TIFF, GIF, BMP and JPEG, and archives of them."""
    packed = cache(lambda: b"\x78\xda" + zeros_deflated(400) + struct.pack(">I", 0))
    for side in (1_900, 5_000, 13_000, 20_000, 60_000, 2**31 - 1):
        yield f"PNG of {side} x {side}", file_of("a.png", lambda s=side: png(s, s, packed()))
        yield (
            f"zip of a PNG of {side} x {side}",
            file_of(
                "a.zip", lambda s=side: zipped({f"{i}.png": png(s, s, packed()) for i in range(9)})
            ),
        )
    text = cache(lambda: b"a\0\0" + zlib.compress(bytes(50 << 20), 9))
    yield (
        "PNG of a text of 50 MB",
        file_of("a.png", lambda: png(8, 8, zlib.compress(bytes(72)), *([(b"zTXt", text())] * 20))),
    )
    yield (
        "PNG of a colour profile of 50 MB",
        file_of("a.png", lambda: png(8, 8, zlib.compress(bytes(72)), (b"iCCP", text()))),
    )
    small = picture(np.zeros((4, 4), np.uint8), "png")
    yield (
        "zip of 20,000 PNGs",
        file_of("a.zip", lambda: zipped({f"{i}.png": small for i in range(20_000)})),
    )
    yield (
        "zip of a PNG that is none, 1 GB of zeros",
        file_of("a.zip", lambda: archive(Member("a.png", small, 1000))),
    )
    usual = {256: (4, 1, 8), 257: (4, 1, 8), 258: (3, 1, 8), 259: (3, 1, 1), 262: (3, 1, 1),
             273: (4, 1, 200), 277: (3, 1, 1), 278: (4, 1, 8), 279: (4, 1, 64)}  # fmt: skip
    for what, changed in {
        "wide": {256: (4, 1, 2**31)}, "tall": {257: (4, 1, 2**31), 278: (4, 1, 2**31)},
        "of 2 billion strips": {273: (4, 2**31, 8), 279: (4, 2**31, 8), 278: (4, 1, 1)},
        "of 60,000 x 60,000": {256: (4, 1, 60_000), 257: (4, 1, 60_000), 278: (4, 1, 60_000)},
        "of 65,535 samples": {277: (3, 1, 65_535)}, "of 30,000 x 30,000 tiles":
        {322: (4, 1, 30_000), 323: (4, 1, 30_000), 324: (4, 1, 200), 325: (4, 1, 64)},
    }.items():  # fmt: skip
        yield f"TIFF {what}", file_of("a.tif", lambda c=changed: tiff(usual | c, bytes(400)))
    yield (
        "TIFF whose directories go round",
        file_of("a.tif", lambda: tiff(usual, bytes(400), following=8)),
    )
    deflated = zlib.compress(bytes(400 << 20), 9)
    bomb = {256: (4, 1, 20_000), 257: (4, 1, 20_000), 259: (3, 1, 8), 278: (4, 1, 20_000),
            279: (4, 1, len(deflated))}  # fmt: skip
    yield (
        "TIFF of 400 MB of zeros",
        file_of("a.tif", lambda: tiff(usual | bomb, deflated).ljust(300)),
    )
    many = io.BytesIO()

    def pages() -> bytes:
        import imageio.v3 as iio

        iio.imwrite(many, np.zeros((8_000, 4, 4), np.uint8), extension=".tif")
        return many.getvalue()

    yield "TIFF of 8,000 pages", file_of("a.tif", pages)
    gif = b"GIF89a" + struct.pack("<HHBBB", 65_535, 65_535, 0x80, 0, 0) + bytes(6)
    image = b"," + struct.pack("<HHHHB", 0, 0, 65_535, 65_535, 0) + b"\x02\x02\x4c\x01\0"
    yield "GIF of 65,535 x 65,535", file_of("a.gif", lambda: gif + image + b";")
    tiny = b"GIF89a" + struct.pack("<HHBBB", 1_900, 1_900, 0x80, 0, 0) + bytes(6)
    dot = b"," + struct.pack("<HHHHB", 0, 0, 1, 1, 0) + b"\x02\x02\x4c\x01\0"
    yield "GIF of 1,900 x 1,900 in 100,000 pictures", file_of("a.gif", lambda: tiny + dot * 100_000)
    bmp = (
        b"BM"
        + struct.pack("<IHHI", 1000, 0, 0, 54)
        + struct.pack("<IiiHHIIiiII", 40, 60_000, 60_000, 1, 8, 0, 0, 0, 0, 256, 0)
    )
    yield "BMP of 60,000 x 60,000", file_of("a.bmp", lambda: bmp + bytes(2000))
    jpeg = picture(np.zeros((16, 16), np.uint8), "jpg")
    at = jpeg.find(b"\xff\xc0")
    big = jpeg[: at + 5] + struct.pack(">HH", 65_500, 65_500) + jpeg[at + 9 :]
    yield "JPEG of 65,500 x 65,500", file_of("a.jpg", lambda: big)


# -- texts -------------------------------------------------------------------------------------


def repeated(text: str, size: int = MOST_BYTES - 1000) -> str:
    """Return a text so often that it is about as long as is allowed."""
    return text * (size // len(text.encode()))


def texts() -> Iterator[tuple[str, Make]]:
    """Yield tables and JSON."""
    number = str(12)
    found: dict[str, Callable[[], str]] = {
        "one line of numbers": lambda: repeated("1,"),
        "one number": lambda: repeated("1"),
        "one word": lambda: repeated("x"),
        "one quoted field that never ends": lambda: '"' + repeated("1,2\n"),
        "only commas": lambda: repeated(","),
        "only blank lines": lambda: repeated("\n"),
        "only blanks": lambda: repeated(" "),
        "only comments": lambda: repeated("# a word\n"),
        "only quotes": lambda: repeated('"'),
        "a million columns": lambda: "\n".join([",".join([number] * 1_000_000)] * 6),
        "a million columns with names": lambda: ",".join(f"v{i}" for i in range(1_000_000)) + "\n"
        + ",".join("1" * 1 for _ in range(1_000_000)),
        "a hundred thousand columns": lambda: "\n".join([",".join([number] * 100_000)] * 60),
        "lines of any length": lambda: "\n".join(",".join(["1"] * (i % 97 + 1))
                                                 for i in range(200_000)),
        "ten million lines": lambda: repeated("1\n"),
        "lines of words": lambda: repeated("a,b,c,d\n"),
        "dates": lambda: repeated("2024-01-01 00:00:00,1,2,3,4\n"),
        "times that go back": lambda: "time,v1,v2,v3,v4\n" + repeated("9e99,1,2,3,4\n"),
        "numbers of 100,000 digits": lambda: repeated(",".join(["9" * 100_000] * 4) + "\n"),
        "exponents": lambda: repeated("1e999999999,1e-999999999,2,3\n"),
        "of no number": lambda: repeated("nan,inf,-inf,NaN\n"),
        "a long table far out": lambda: "frame,row,column,value\n0,0,0,1\n0,999999,999999,2\n",
        "a long table farther out": lambda: "frame,row,column,value\n"
        "0,0,0,1\n0,999999999999,5,2\n",
        "a long table, a diagonal": lambda: "frame,row,column,value\n" + "".join(
            f"0,{i},{i},1\n" for i in range(30_000)),
        "a long table, frames far apart": lambda: "frame,row,column,value\n" + "".join(
            f"{i * 10**9},{r},{c},1\n" for i in range(50) for r in (0, 1) for c in (0, 1)),
        "a long table of one cell frames": lambda: "frame,row,column,value\n" + "".join(
            f"{i},0,0,1\n" for i in range(900_000)),
        "names of cells far out": lambda: "time,r0c0,r0c999999,r999999c0\n" + "0,1,2,3\n" * 50,
        "names of cells, a diagonal": lambda: ",".join(f"r{i}c{i}" for i in range(20_000)) + "\n"
        + ",".join("1" for _ in range(20_000)) + "\n",
        "stacked blocks of one line": lambda: repeated("1,2,3,4\n\n"),
        "stacked blocks, unequal": lambda: "\n\n".join("\n".join(["1,2"] * (i % 50))
                                                       for i in range(50_000)),
        "JSON deep": lambda: repeated("["),
        "JSON deep and closed": lambda: "[" * 9_000_000 + "]" * 9_000_000,
        "JSON deep objects": lambda: repeated('{"a":'),
        "JSON flat": lambda: "[" + repeated("1,") + "1]",
        "JSON of fractions": lambda: "[" + repeated("0.5,") + "1]",
        "JSON of empty lists": lambda: "[" + repeated("[],") + "[]]",
        "JSON of empty objects": lambda: "[" + repeated("{},") + "{}]",
        "JSON of one number": lambda: "[[" + "9" * 19_000_000 + "]]",
        "JSON of one text": lambda: '{"a": "' + repeated("x") + '"}',
        "JSON of many keys": lambda: "{" + ",".join(f'"k{i}":[{i}]' for i in range(900_000)) + "}",
        "JSON in lines, damaged": lambda: repeated('{"a": [1\n'),
        "JSON in lines of numbers": lambda: '{"a":1}\n' + repeated("1\n"),
        "JSON of unequal matrices": lambda: json.dumps([[[1] * (i % 90)] for i in range(90_000)]),
        "JSON of texts": lambda: "[" + repeated('"x",') + '"x"]',
        "JSON of a matrix and texts": lambda: '{"values": [[1,2],[3,4]], "x": ['
        + repeated('"x",') + '"x"]}',
    }  # fmt: skip
    for what, text in found.items():
        yield f"text: {what}", file_of("a.txt", lambda t=text: t().encode())
    yield "text: UTF-16 of one line", file_of("a.csv", lambda: repeated("1,", 9_000_000).encode(
        "utf-16"))  # fmt: skip
    yield "text: bytes that are no text", file_of("a.csv", lambda: b"\xff1,2\n" * 4_000_000)
    yield "binary: zeros", file_of("a.bin", lambda: bytes(MOST_BYTES))
    yield "binary: at random", file_of("a.bin", lambda: np.random.default_rng(0).bytes(MOST_BYTES))
    yield "gzip", file_of("a.gz", lambda: gzip.compress(bytes(200 << 20)))
    for dialect in dialects():
        yield (
            f"{dialect.name} with numbers inflated",
            file_of("a.dat", lambda d=dialect: inflated(d.content)),
        )


def inflated(content: bytes) -> bytes:
    """Return a text whose first whole numbers beyond 1 are a billion: what a head says of sizes."""
    made, left, at = bytearray(), 12, 0
    while at < len(content):
        end = at
        while end < len(content) and 48 <= content[end] < 58:
            end += 1
        if end > at + 0 and left and content[at:end] not in (b"", b"0", b"1"):
            made += b"999999999"
            left -= 1
            at = end
        elif end > at:
            made += content[at:end]
            at = end
        else:
            made.append(content[at])
            at += 1
    return bytes(made)


# -- files of named arrays, logs, stores -------------------------------------------------------


def element(kind: int, data: bytes) -> bytes:
    """Return an element of a MATLAB 5 file."""
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def matrix(shape: tuple[int, ...], data: bytes, kind: int = 6, name: bytes = b"values") -> bytes:
    """Return a matrix of a MATLAB 5 file that says what it is told to."""
    inner = element(6, struct.pack("<II", kind, 0)) + element(5, struct.pack(f"<{len(shape)}i",
                                                                              *shape))  # fmt: skip
    return element(14, inner + element(1, name) + data)


def matlab() -> Iterator[tuple[str, Make]]:
    """Yield MATLAB files of version 5."""
    head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
    numbers = element(9, bytes(8 * 64))
    deep = numbers
    for _ in range(20_000):
        deep = matrix((1, 1), deep, 1, b"")
        if len(deep) > 4_000_000:
            break
    cells = element(14, element(6, struct.pack("<II", 1, 0)) + element(5, struct.pack(
        "<ii", 2**31 - 1, 1)) + element(1, b"c"))  # fmt: skip
    empty = matrix((0, 0), element(9, b""), 6, b"")
    flat = element(6, struct.pack("<II", 1, 0)) + element(5, struct.pack("<ii", 300_000, 1)) + (
        element(1, b"c") + empty * 300_000)  # fmt: skip
    found = {
        "that says 2 billion squared": matrix((2**31 - 1, 2**31 - 1), numbers),
        "that says -1": matrix((-1, 64), numbers),
        "of 100,000 axes": matrix((1,) * 100_000, numbers),
        "cells within cells": deep,
        "of 2 billion cells": cells,
        "of 300,000 cells": element(14, flat),
        "packed, 900 MB of zeros": element(15, b"\x78\xda" + zeros_deflated(900)),
        "packed, a head and 900 MB of zeros": element(15, b"\x78\xda" + zeros_headed(900)),
        "of 300,000 variables": matrix((1, 1), element(9, bytes(8))) * 250_000,
        "that says 4 GB": struct.pack("<II", 14, 0xFFFFFFF0) + bytes(100),
    }
    for what, body in found.items():
        yield f"MATLAB {what}", file_of("a.mat", lambda b=body: head + b[:MOST_BYTES])


def zeros_headed(n: int) -> bytes:
    """Return packed zeros behind the head of a matrix that holds them."""
    size = n << 20
    head = struct.pack("<II", 14, size + 56) + element(6, struct.pack("<II", 6, 0))
    head += element(5, struct.pack("<ii", 16, size // 128)) + element(1, b"values")
    head += struct.pack("<II", 9, size)
    return struct.pack("<BHH", 0, len(head), len(head) ^ 0xFFFF) + head + zeros_deflated(n)


def hdf5() -> Iterator[tuple[str, Make]]:
    """Yield HDF5 files, where h5py is installed."""
    try:
        import h5py
    except ImportError:
        return

    def made(fill: Callable[[Any], object]) -> Make:
        def make(folder: Path) -> Path:
            path = folder / "a.h5"
            with h5py.File(path, "w") as file:
                fill(file)
            return path

        return make

    def nested(file: Any) -> None:
        for i in range(3_000):
            file = file.create_group(f"g{i}")

    def virtual(file: Any) -> None:
        layout = h5py.VirtualLayout((10**6, 16, 16), "f8")
        layout[:] = h5py.VirtualSource("no-such.h5", "x", (10**6, 16, 16))
        file.create_virtual_dataset("values", layout)

    def looped(file: Any) -> None:
        group = file.create_group("a")
        group["again"], group["soft"] = file["/"], h5py.SoftLink("/a/soft")
        group["outer"] = h5py.ExternalLink("/dev/zero", "x")

    for shape in ((10**6, 16, 16), (10**12, 16, 16), (1_900_000, 16, 16), (2, 20_000, 10_000)):
        yield (
            f"HDF5 of {shape}, never written",
            made(lambda f, s=shape: f.create_dataset("values", s, "f8", chunks=(1, 16, 16))),
        )
        yield f"HDF5 of {shape}, one chunk", made(
            lambda f, s=shape: f.create_dataset("values", s, "f8", chunks=(1, 16, 16)).__setitem__(
                (0, 0, 0), 1.0))  # fmt: skip
    yield "HDF5 packed, 480 MB of zeros", made(
        lambda f: f.create_dataset("values", (60, 1_000, 1_000), "f8", compression="gzip",
                                   chunks=(1, 1_000, 1_000)).__setitem__(..., 0.0))  # fmt: skip
    yield (
        "HDF5 of 20,000 datasets",
        made(lambda f: [f.create_dataset(f"d{i}", (2, 2, 2)) for i in range(20_000)]),
    )
    yield (
        "HDF5 of 500 numbered matrices, never written",
        made(lambda f: [f.create_dataset(f"frame{i}", (4_000, 2_000), "f8", chunks=(4, 4))
                        for i in range(500)]),
    )  # fmt: skip

    def of_nodes(file: Any, n: int, side: int, piece: int) -> None:
        file.attrs["format"] = "tactile-graph node images"
        values = file.create_dataset("a/values", (n, side, side), "f8", chunks=(1, piece, piece))
        values.attrs.update(kind="image", quantity="volt", pitch_cm=(1, 1), origin_cm=(0, 0))
        file.create_dataset("a/outcome", (n,), "u1", chunks=(1,))
        file.create_dataset("time_s", (n,), "f8", chunks=(1,))

    for size in ((10**10, 2, 2), (2, 10**5, 2), (1_000, 1_900, 2), (1_000, 1_900, 1_900)):
        what = "HDF5 of {} images of a node, {} wide, in pieces of {}".format(*size)
        yield what, made(lambda f, s=size: of_nodes(f, *s))

    def timed(file: Any, n: int, letters: int) -> None:
        file["values"] = np.ones((5, 8, 8))
        file.create_dataset("time", (n,), f"S{letters}", chunks=(min(n, 1000),))

    for size in ((5, 10**8), (2 * 10**9, 4)):
        what = "HDF5 whose times are {} texts of {} letters".format(*size)
        yield what, made(lambda f, s=size: timed(f, *s))
    yield "HDF5 of 3,000 groups in each other", made(nested)
    yield "HDF5 of a dataset elsewhere", made(virtual)
    yield "HDF5 that goes round", made(looped)
    yield (
        "HDF5 with 8,000 attributes",
        made(lambda f: [f.attrs.__setitem__(f"a{i}", "x" * 500) for i in range(8_000)]),
    )


def mcap() -> Iterator[tuple[str, Make]]:
    """Yield MCAP logs."""
    mark = b"\x89MCAP0\r\n"

    def record(kind: int, data: bytes, size: int | None = None) -> bytes:
        return struct.pack("<BQ", kind, len(data) if size is None else size) + data

    def text(words: bytes) -> bytes:
        return struct.pack("<I", len(words)) + words

    head = mark + record(1, text(b"") + text(b""))
    channel = record(
        4, struct.pack("<HH", 1, 0) + text(b"/t") + text(b"json") + struct.pack("<I", 0)
    )
    message = record(5, struct.pack("<HIQQ", 1, 0, 0, 0) + b"[[1,2],[3,4]]")
    bomb = struct.pack("<QQQI", 0, 0, 4 << 30, 0)
    end = record(2, bytes(20)) + mark
    found = {
        "a record of 2^62 bytes": head + record(5, b"", 2**62),
        "400,000 messages": head + channel + message * 400_000 + end,
        "deep JSON": head + channel + record(5, struct.pack("<HIQQ", 1, 0, 0, 0) + b"[" *
                                             5_000_000) + end,
        "a chunk that says 4 GB": head + record(6, bomb + text(b"") + struct.pack("<Q", 9) + b"x" *
                                                9) + end,
        "a chunk packed by zstd": head + record(6, bomb + text(b"zstd") + struct.pack("<Q", 9) +
                                                b"x" * 9) + end,
        "65,000 channels": head + b"".join(
            record(4, struct.pack("<HH", i, 0) + text(b"/t%d" % i) + text(b"json") + bytes(4))
            for i in range(65_000)) + end,
        "an end that lies": head + record(2, struct.pack("<QQI", 2**60, 2**60, 0)) + mark,
    }  # fmt: skip
    for what, content in found.items():
        yield f"MCAP: {what}", file_of("a.mcap", lambda c=content: c)
    try:
        import zstandard
    except ImportError:
        return

    def chunk() -> bytes:
        data = channel + message * 8_000_000
        packed = zstandard.compress(data, 19)
        sizes = struct.pack("<QQQI", 0, 0, len(data), 0) + text(b"zstd")
        return head + record(6, sizes + struct.pack("<Q", len(packed)) + packed) + end

    yield "MCAP: a chunk of 350 MB packed", file_of("a.mcap", chunk)


def stores() -> Iterator[tuple[str, Make]]:
    """Yield Zarr stores whose metadata or journal tell absurd things."""
    from tactile_graph import Frame
    from tactile_graph_sources.writers.write_store import StoreWriter

    changes: dict[str, tuple[str, Callable[[Any], Any]]] = {
        "billions of frames": ("values", lambda d: d | {"shape": [10**12, *d["shape"][1:]]}),
        "a wide grid": ("values", lambda d: d | {"shape": [d["shape"][0], 10**6, 10**6]}),
        "numbers of billions": ("number", lambda d: d | {"shape": [10**12]}),
        "a huge chunk": ("values", lambda d: d | {"chunk_grid": {"name": "regular", "configuration":
                         {"chunk_shape": [10**9, 1000, 1000]}}}),
        "no chunk": ("values", lambda d: d | {"chunk_grid": {"name": "regular", "configuration":
                     {"chunk_shape": [0, 0, 0]}}}),
        "a codec that is none": ("values", lambda d: d | {"codecs": [{"name": "x"}] * 100_000}),
        "a fill of 4,000 digits": ("values", lambda d: d | {"fill_value": 10**4_000}),
        "a deep grid": ("", lambda d: d | {"attributes": json.loads("[" * 900 + "]" * 900)}),
    }  # fmt: skip

    def changed(part: str, change: Callable[[Any], Any], journal: bool) -> Make:
        def make(folder: Path) -> Path:
            store = folder / "a.zarr"
            with StoreWriter(store, 4) as writer:
                for i in range(10):
                    writer.write(Frame.of(np.full((4, 5), float(i)), index=i))
            if not journal:
                (store / "frames.journal").unlink()
            file = store / part / "zarr.json"
            file.write_text(json.dumps(change(json.loads(file.read_text()))))
            return store

        return make

    for what, (part, change) in changes.items():
        for journal in (True, False):
            without = "" if journal else ", no journal"
            yield f"store: {what}{without}", changed(part, change, journal)

    def line(text: bytes | Callable[[], bytes]) -> Make:
        def make(folder: Path) -> Path:
            store = changed("", lambda d: d, True)(folder)
            with (store / "frames.journal").open("ab") as file:
                file.write(text if isinstance(text, bytes) else text())
            return store

        return make

    def sealed(text: bytes) -> bytes:
        return b"%08x %s\n" % (zlib.crc32(text), text)

    def gigabyte() -> bytes:
        packed = base64.b64encode(zlib.compress(bytes(1 << 30), 9))
        return sealed(b'{"rows":[10,12],"values":0,"columns":"' + packed + b'"}')

    texts: dict[str, bytes | Callable[[], bytes]] = {
        "a line of 19 MB": b"x" * 19_000_000,
        "two million lines": b"x\n" * 2_000_000,
        "deep, and right": sealed(b'{"rows":' + b"[" * 900_000 + b"]" * 900_000 + b"}"),
        "frames of billions": sealed(b'{"rows":[10,999999999999],"values":0,"columns":""}'),
        "frames of billions, lost": sealed(b'{"rows":[10,999999999999],"values":0,"lost":"x"}'),
        "rows that are none": sealed(b'{"rows":"ab","values":0,"columns":""}'),
        "columns of 1 GB": gigabyte,
        "150,000 blocks": b"".join(sealed(b'{"rows":[%d,%d],"values":0,"lost":"x"}' % (i, i + 1))
                                   for i in range(10, 150_000)),
    }  # fmt: skip
    for what, text in texts.items():
        yield f"store: journal, {what}", line(text)


def no_files() -> Iterator[tuple[str, Make]]:
    """Yield what is no file, or has no end."""
    for device in ("/dev/zero", "/dev/urandom", "/dev/full", "/dev/tty", "/proc/self/mem"):
        yield device, lambda folder, d=device: Path(d)

        def link(folder: Path, device: str = device) -> Path:
            (folder / "a.csv").symlink_to(device)
            return folder / "a.csv"

        yield f"a link to {device}", link

    def crowded(folder: Path) -> Path:
        for i in range(20_000):
            (folder / f"{i}.png").touch()
        return folder

    yield "a folder of 20,000 empty pictures", crowded


def recordings() -> Iterator[tuple[str, Make]]:
    """Yield every hostile recording: what it is, and what makes it."""
    for of in (arrays, pictures, texts, matlab, hdf5, mcap, stores, no_files):
        yield from of()
