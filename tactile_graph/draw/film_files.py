"""Films as files, a picture at a time: GIF by Pillow, MP4 by ffmpeg where it is there."""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.colours import FOUND, TRUE
from tactile_graph.draw.paint_strip import HEAT
from tactile_graph.errors import UsageError

Picture = NDArray[np.uint8]
RATE_HZ = 25.0
"""Pictures a second, at most."""
MISSING = (
    "films in MP4 need imageio-ffmpeg: pip install 'tactile-graph[film]'; a .gif needs nothing more"
)


class FilmFile(ABC):
    """Takes pictures of one size, shape (rows, columns, 3); ends the film where its block does."""

    @abstractmethod
    def add(self, picture: Picture, seconds: float) -> None:
        """Show a picture for so long."""

    @abstractmethod
    def close(self, whole: bool) -> None:
        """End the film; where it is not whole, it only has to be let go of."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        self.close(whole=error is None)


class Gif(FilmFile):
    """An endless GIF; of time it keeps hundredths of a second, and their sum right.

    Parameters
    ----------
    path : Path
    size : (int, int)
        Rows and columns.
    """

    def __init__(self, path: Path, size: tuple[int, int]) -> None:
        self._file = file = path.open("wb")
        self._due_s = self._shown_s = 0.0
        self._palette = _palette()
        rows, columns = size
        file.write(b"GIF89a" + struct.pack("<HHBBB", columns, rows, 0, 0, 0))
        file.write(b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")

    def add(self, picture: Picture, seconds: float) -> None:
        """Show a picture for so long."""
        from PIL import GifImagePlugin, Image

        self._due_s += seconds
        shown = max(round(100.0 * (self._due_s - self._shown_s)), 2)  # less is not kept to
        self._shown_s += shown / 100.0
        image = Image.fromarray(picture).quantize(palette=self._palette, dither=Image.Dither.NONE)
        parts = GifImagePlugin.getdata(image, duration=10 * shown, include_color_table=True)
        for part in parts:
            self._file.write(part)

    def close(self, whole: bool) -> None:
        """End the film."""
        with self._file as file:
            file.write(b";" if whole else b"")


def _palette() -> Any:
    """Return the colours of a film: to choose them picture by picture takes half of all time."""
    from matplotlib import colormaps
    from PIL import Image

    heat = 255.0 * colormaps[HEAT](np.linspace(0.0, 1.0, 128))[:, :3]
    shades = [
        np.linspace(end, 255.0, n)
        for end, n in ((np.zeros(3), 18), (_rgb(FOUND), 12), (_rgb(TRUE), 12))
    ]
    colours = np.rint(np.vstack([heat, *shades])).astype(np.uint8)
    image = Image.new("P", (1, 1))
    image.putpalette(colours.tobytes())
    return image


def _rgb(colour: str) -> NDArray[np.float64]:
    return np.array([*bytes.fromhex(colour[1:])], dtype=np.float64)


class Mp4(FilmFile):
    """An MP4 of `RATE_HZ` pictures a second, each repeated as often as its time takes.

    Parameters
    ----------
    path : Path
    size : (int, int)
        Rows and columns; both even.

    Raises
    ------
    UsageError
        If imageio-ffmpeg is not installed.
    """

    def __init__(self, path: Path, size: tuple[int, int]) -> None:
        self._writer: Any = ffmpeg().write_frames(
            str(path), size[::-1], fps=RATE_HZ, codec="libx264", macro_block_size=2,
            output_params=["-f", "mp4", "-movflags", "+faststart"], ffmpeg_log_level="error",
        )  # fmt: skip
        self._writer.send(None)
        self._due_s = 0.0
        self._n = 0

    def add(self, picture: Picture, seconds: float) -> None:
        """Show a picture for so long."""
        self._due_s += seconds
        data = np.ascontiguousarray(picture)
        for _ in range(max(round(self._due_s * RATE_HZ) - self._n, 1)):
            self._writer.send(data)
            self._n += 1

    def close(self, whole: bool) -> None:
        """End the film."""
        self._writer.close()


def ffmpeg() -> Any:
    """Return the library that finds and drives ffmpeg.

    Raises
    ------
    UsageError
        If it is not installed.
    """
    try:
        import imageio_ffmpeg
    except ImportError:
        raise UsageError(MISSING) from None
    return imageio_ffmpeg
