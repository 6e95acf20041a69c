"""Films as files, a picture at a time: GIF by Pillow, MP4 by ffmpeg where it is there."""

from __future__ import annotations

import contextlib
import errno
import os
import struct
import subprocess
import threading
from abc import ABC, abstractmethod
from collections import deque
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.colours import FOUND, TRUE
from tactile_graph.draw.paint_strip import HEAT
from tactile_graph.errors import UsageError, without

Picture = NDArray[np.uint8]
RATE_HZ = 25.0
"""Pictures a second, at most."""
CRF = 25
"""Quality of MP4, by the scale of x264: 0 loses nothing, 51 is worst."""
MOST_LINES = 20
"""Lines of what ffmpeg tells that are kept."""
REASONS = (
    errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES, errno.ENOENT, errno.EIO,
)  # fmt: skip
"""Why the system lets no file be written, the likeliest first; ffmpeg tells them in a line."""
MISSING = (
    'films in MP4 need imageio-ffmpeg: pip install "tactile-graph[film]"; a .gif needs nothing more'
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
    OSError
        If ffmpeg cannot write the film, with the reason that it tells.
    """

    def __init__(self, path: Path, size: tuple[int, int]) -> None:
        rows, columns = size
        # Ctrl-C is not for it, and a file that may grow no more is told, not its end by SIGXFSZ.
        alone: dict[str, Any] = (
            {"creationflags": getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)}
            if os.name == "nt"
            else {"process_group": 0, "restore_signals": False}
        )
        self._process = subprocess.Popen(
            [
                ffmpeg().get_ffmpeg_exe(), "-y", "-v", "error",
                "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{columns}x{rows}",
                "-r", f"{RATE_HZ:g}", "-i", "-",
                "-an", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", str(CRF),
                "-f", "mp4", "-movflags", "+faststart", str(path),
            ],
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, **alone,
        )  # fmt: skip
        self._told: deque[bytes] = deque(maxlen=MOST_LINES)
        # While it is told to, as ffmpeg would wait where nobody reads.
        self._listener = threading.Thread(
            target=self._told.extend, args=(self._process.stderr,), daemon=True
        )
        self._listener.start()
        self._due_s = 0.0
        self._n = 0

    def add(self, picture: Picture, seconds: float) -> None:
        """Show a picture for so long."""
        assert self._process.stdin is not None
        self._due_s += seconds
        data = np.ascontiguousarray(picture).data
        try:
            for _ in range(max(round(self._due_s * RATE_HZ) - self._n, 1)):
                self._process.stdin.write(data)
                self._n += 1
        except OSError:  # it has ended, and says why
            self._end()
            raise self._why() from None

    def close(self, whole: bool) -> None:
        """End the film."""
        try:
            if whole and self._end():
                raise self._why()
        finally:
            self._process.kill()  # nothing where it has ended
            self._end()

    def _end(self) -> int:
        """Return the exit code of ffmpeg, to which nothing more comes."""
        assert self._process.stdin is not None
        assert self._process.stderr is not None
        with contextlib.suppress(OSError):  # it has ended already
            self._process.stdin.close()
        code = self._process.wait()
        self._listener.join()
        self._process.stderr.close()
        return code

    def _why(self) -> OSError:
        """Return the error that ffmpeg told: the system's own word for it, or its last line."""
        lines = [line.decode(errors="replace").strip() for line in self._told]
        for number in REASONS:
            if any(os.strerror(number) in line for line in lines):
                return OSError(number, os.strerror(number))
        code = self._process.returncode
        last = next(filter(None, reversed(lines)), f"it ended with code {code}")
        return OSError(errno.EIO, f"ffmpeg: {last}")


def ffmpeg() -> Any:
    """Return the library that finds and drives ffmpeg.

    Raises
    ------
    UsageError
        If it is not installed, or does not work.
    """
    try:
        import imageio_ffmpeg
    except ImportError as error:
        raise UsageError(without("imageio_ffmpeg", error, MISSING)) from error
    return imageio_ffmpeg
