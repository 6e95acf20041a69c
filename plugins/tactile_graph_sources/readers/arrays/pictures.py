"""Pictures as frames: PNG, TIFF, JPEG and whatever else imageio reads; pages, folders, archives."""

from __future__ import annotations

import hashlib
import io
import logging
import os
import re
import warnings
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.arrays.archive import opened
from tactile_graph_sources.readers.arrays.picture_tags import (
    ORIENTATION,
    refuse_large,
    tell_resolution,
    upright,
)
from tactile_graph_sources.readers.arrays.tiff import matrices
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.sequence.by_number import in_order

_MARKS = (b"\x89PNG", b"II*\0", b"MM\0*", b"II+\0", b"MM\0+", b"\xff\xd8\xff", b"GIF8", b"BM")
NAMES = (".png", ".tif", ".tiff", ".jpg", ".jpeg", ".gif", ".bmp")
_BMP_HEAD = 14
"""Bytes, of which four are always 0."""
MOST_BYTES = 1 << 28
MOST_UNPACKED = 1 << 26
_IN_MEMORY = re.compile(r"\s*<[^<>]* at 0x[0-9a-fA-F]+>")


def recognises(head: Head) -> bool:
    """Return whether the file starts as pictures do, or is an archive of them."""
    if head.raw.startswith(b"PK\x03\x04"):
        return any(n.lower().encode() in head.raw for n in NAMES) and _holds_pictures(head.path)
    return head.raw.startswith(_MARKS) and not (
        head.raw.startswith(b"BM") and b"\0" not in head.raw[:_BMP_HEAD] and head.lines
    )


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each picture or page, its grey values as they are.

    Raises
    ------
    DataError
        If a picture cannot be read, or its colours are no shades of one.
    """
    reading.refuse_settings()
    if reading.head.raw.startswith(b"PK"):
        with opened(reading.path) as archive:
            yield from _of_archive(reading, archive)
        return
    reading.recognised("the first bytes of a picture")
    if reading.path.stat().st_size > MOST_BYTES:
        raise DataError(str(reading.path), f"is a picture of more than {MOST_BYTES >> 20} MB")
    yield from _in_turn(reading, [("", reading.path.read_bytes())])


def _of_archive(reading: Reading, archive: zipfile.ZipFile) -> Iterator[Frame]:
    members = _pictures_of(archive)
    reading.recognised(f"an archive of {len(members)} pictures, in the order of their numbers")
    reading.report.expect(len(members))
    yield from _in_turn(reading, ((n, _unpacked(reading, archive, n)) for n in members))


def read_folder(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each picture of a folder, in the order of the numbers in their names."""
    reading.refuse_settings()
    names = pictures_in(reading.path)
    reading.recognised(f"a folder of {len(names)} pictures, in the order of their numbers")
    reading.report.expect(len(names))
    yield from _in_turn(reading, ((n, _content(reading, n)) for n in names))


def _content(reading: Reading, name: str) -> bytes:
    content = (reading.path / name).read_bytes()
    reading.report.digest(str(reading.path / name), hashlib.sha256(content).hexdigest())
    return content


def _in_turn(reading: Reading, contents: Iterable[tuple[str, bytes]]) -> Iterator[Frame]:
    """Yield the frames of pictures that belong together, which therefore are of one size."""
    first: tuple[str, tuple[int, ...]] | None = None
    for name, content in contents:
        for matrix in _pages(reading, content, name):
            if first is None:
                first = (name, matrix.shape)
                reading.told.agree(str(reading.path), *matrix.shape)
            if matrix.shape != first[1]:
                (n, m), (rows, columns) = first[1], matrix.shape
                raise DataError(
                    f"{reading.path}:{name}" if name else str(reading.path),
                    f"has {rows} x {columns} pixels, {first[0] or 'its first page'} {n} x {m}; the "
                    "frames of a recording are of one size: keep those of each size in a file or "
                    "folder of their own",
                )
            yield reading.frame(matrix)


def pictures_in(folder: Path) -> list[str]:
    """Return the names of a folder's pictures in their order; none where it holds no picture."""
    with os.scandir(folder) as entries:
        names = [e.name for e in entries if e.name.lower().endswith(NAMES) and e.is_file()]
    return in_order(names)


def _holds_pictures(path: Path) -> bool:
    try:
        with opened(path) as archive:
            return bool(_pictures_of(archive))
    except DataError:  # who reads arrays tells it
        return False


def _pictures_of(archive: zipfile.ZipFile) -> list[str]:
    """Return the pictures of an archive in their order."""
    names = archive.namelist()
    return in_order([n for n in names if n.lower().endswith(NAMES) and "__MACOSX" not in n])


def _unpacked(reading: Reading, archive: zipfile.ZipFile, name: str) -> bytes:
    try:
        if archive.getinfo(name).file_size > MOST_UNPACKED:
            raise ValueError(f"it has more than {MOST_UNPACKED >> 20} MB")
        return archive.read(name)
    except Exception as error:
        raise DataError(f"{reading.path}:{name}", f"cannot be unpacked: {error}") from error


def _pages(reading: Reading, content: bytes, name: str) -> Iterator[NDArray[Any]]:
    where = f"{reading.path}:{name}" if name else str(reading.path)
    n, plugin = 0, _plugin(content)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # readers of pictures warn of what they then refuse
        try:
            read = matrices if plugin == "tifffile" else _with_pillow
            for page in read(reading, where, content):
                yield _grey(where, page)
                n += 1
        except DataError:
            raise
        except Exception as error:  # every library below imageio has errors of its own
            if not n:
                raise DataError(where, f"the picture cannot be read: {_why(error)}") from error
            what = "cannot be read; the pages before it are kept"
            reading.damaged(f"page {n}", what, n_frames=0)  # nobody knows how many come after it


def _why(error: Exception) -> str:
    """Return the first line of an error without where in the memory what it names lies."""
    line = _IN_MEMORY.sub("", str(error).partition("\n")[0])
    return line.replace("<", "").replace(">", "").strip()[:120] or type(error).__name__


def _plugin(content: bytes) -> str:
    """Return who reads a picture: left to itself imageio asks OpenCV too, which prints."""
    if content[:2] not in (b"II", b"MM"):
        return "pillow"
    logger = logging.getLogger("tifffile")
    if not logger.handlers:
        logger.addHandler(logging.NullHandler())  # what is wrong comes as an exception as well
    return "tifffile"


def _with_pillow(reading: Reading, where: str, content: bytes) -> Iterator[NDArray[Any]]:
    """Yield the pages of what is no TIFF; a third axis is that of colours, or of grey and how much
    shines through."""
    import imageio.v3 as iio
    from PIL import Image as Picture

    with Picture.open(io.BytesIO(content)) as picture:
        refuse_large(where, [picture.size[::-1]])
        told = "exif" in picture.info  # to ask a PNG without it unpacks the picture
        orientation = picture.getexif().get(ORIENTATION, 1) if told else 1
        if dots := picture.info.get("dpi"):
            tell_resolution(reading, dots, 1.0)
    for page in iio.imiter(content, plugin="pillow"):
        yield upright(reading, np.asarray(page), orientation)


def _grey(where: str, page: NDArray[Any]) -> NDArray[Any]:
    if page.dtype.kind not in "buif" or page.ndim not in (2, 3) or 0 in page.shape:
        raise DataError(where, f"the picture has shape {page.shape} and type {page.dtype}")
    if page.ndim == 2:
        return page
    colours = page[..., :3] if page.shape[2] >= 3 else page[..., :1]
    if (colours == colours[..., :1]).all():
        return np.asarray(colours[..., 0])
    raise DataError(
        where,
        "the picture is in colours, from which no values can be had back; save the values, or "
        "shades of grey",
    )


FORMAT = RecordingFormat(
    "pictures (PNG, TIFF, JPEG, GIF, BMP; single, many pages or a zip of them)", recognises, read
)
FOLDER = RecordingFormat(
    FORMAT.name, lambda head: bool(pictures_in(head.path)), read_folder, of_folders=True
)
