"""TIFF pictures: pages, samples and channels as the file says them, not as their shape looks."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.arrays.picture_tags import (
    CM_OF_INCH,
    ORIENTATION,
    refuse_large,
    tell_resolution,
    upright,
)
from tactile_graph_sources.readers.reading import Reading

WHITE_IS_ZERO, BLACK_IS_ZERO, PALETTE = 0, 1, 3
"""Photometric interpretations of one sample a pixel; with all others, samples are colours."""
APART = 2
"""The planar configuration of samples that lie one after another, each a picture."""
SHINES_THROUGH = (1, 2)
INCHES = {2: 1.0, 3: 1.0 / CM_OF_INCH}
"""Units of resolution."""
MOST_LIKE_SAMPLES = 5
"""Columns of a page that may be the samples of a row that was written as a page."""


def matrices(reading: Reading, where: str, content: bytes) -> Iterator[NDArray[Any]]:
    """Yield the pages of a TIFF: grey ones as matrices, others with their colours last.

    Parameters
    ----------
    reading : Reading
        Told what of the pages is assumed.
    where : str
        The picture, for messages.
    content : bytes

    Raises
    ------
    DataError
        If it is too large, or a pixel has samples, or the file channels, that are neither grey nor
        colours.
    """
    import tifffile

    with tifffile.TiffFile(io.BytesIO(content)) as file:
        sides = [(s.keyframe.imagelength, s.keyframe.imagewidth) for s in file.series]
        refuse_large(where, sides, sum(int(s.size) for s in file.series), len(content))
        for series in file.series:
            page = series.keyframe
            _check_channels(reading, where, series)
            if (inches := INCHES.get(page.resolutionunit)) is not None:
                tell_resolution(reading, page.resolution, inches)
            pages = _with_samples_last(page, series.asarray())
            if page.samplesperpixel == 1:
                _tell_narrow(reading, pages.shape)
            for picture in pages:
                grey = _without_samples(where, page, picture)
                grey = _as_white_says(reading, where, page, grey)
                yield upright(reading, grey, page.tags.valueof(ORIENTATION, 1))


def _with_samples_last(page: Any, array: NDArray[Any]) -> NDArray[Any]:
    """Return pages as (n, rows, columns, samples), whatever axes of length one are left out."""
    n, rows, columns = page.samplesperpixel, page.imagelength, page.imagewidth
    if n > 1 and page.planarconfig == APART:
        return np.moveaxis(array.reshape(-1, n, rows, columns), 1, -1)
    return array.reshape(-1, rows, columns, n)


def _check_channels(reading: Reading, where: str, series: Any) -> None:
    """Refuse channels beside another axis of pages; alone they are pages, as programs write so."""
    named = dict(zip(series.axes, series.shape, strict=False))
    n = named.pop("C", 1)
    if n == 1:
        return
    if any(length > 1 for name, length in named.items() if name not in "YXS"):
        raise DataError(
            where,
            f"the TIFF says that each frame has {n} channels (axes {series.axes}, shape "
            f"{series.shape}); save the one that is measured as a TIFF of its own, in Python: "
            f"tifffile.imread(…).take(channel, axis={series.axes.index('C')})",
        )
    reading.assume(f"{n} pages taken for frames that the TIFF calls channels")


def _tell_narrow(reading: Reading, shape: tuple[int, ...]) -> None:
    """Tell that pages are frames where they could be the rows of one picture of channels."""
    n, rows, columns = shape[:3]
    if reading.told.shape is None and 1 < columns <= MOST_LIKE_SAMPLES < min(n, rows):
        reading.assume(f"{n} pages of {rows} x {columns} taken for frames, as the TIFF says")


def _without_samples(where: str, page: Any, picture: NDArray[Any]) -> NDArray[Any]:
    """Return a page without how much shines through it and without samples that are alike."""
    n = picture.shape[-1]
    if n == 1:
        return picture[..., 0]
    if page.photometric not in (WHITE_IS_ZERO, BLACK_IS_ZERO, PALETTE) and n > 2:
        if page.planarconfig == APART and not (picture[..., :3] == picture[..., :1]).all():
            raise DataError(
                where,
                f"the picture is in colours, as the TIFF says of its {n} planes, from which no "
                "values can be had back; if they are frames, write them so: "
                "tifffile.imwrite(…, photometric='minisblack')",
            )
        return picture
    through = [k for k in page.extrasamples if int(k) in SHINES_THROUGH]
    grey = picture[..., : max(1, n - len(through))]
    if (grey == grey[..., :1]).all():
        return np.asarray(grey[..., 0])
    raise DataError(
        where,
        f"the TIFF has {n} channels (samples of each pixel) on {picture.shape[0]} x "
        f"{picture.shape[1]} pixels, of which a frame has one; save the one that is measured, in "
        "Python: array = tifffile.imread(…), then tifffile.imwrite('out.tif', "
        + ("array[channel])" if page.planarconfig == APART else "array[..., channel])"),
    )


def _as_white_says(reading: Reading, where: str, page: Any, matrix: NDArray[Any]) -> NDArray[Any]:
    """Return a page with white as its largest value where it is stored as 0; it is told.

    Of one bit it stays as it is: masks are written so, on or off, whatever white is said to be.
    """
    if page.photometric != WHITE_IS_ZERO:
        return matrix
    if matrix.dtype.kind == "b":
        reading.assume("1 bit a pixel taken as it is, though the TIFF says that 0 is white")
        return matrix
    reading.heed("grey values turned round, as the TIFF says that 0 is white")
    if matrix.dtype.kind != "u":
        raise DataError(
            where,
            f"the TIFF says that 0 is white, which values of type {matrix.dtype} cannot be turned "
            "round by; save them with photometric='minisblack'",
        )
    return np.asarray((1 << int(page.bitspersample)) - 1 - matrix).astype(matrix.dtype)
