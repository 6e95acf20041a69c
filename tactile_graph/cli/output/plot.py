"""What ``--plot`` draws of a run: the first frames as a strip, or all of them as a film."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from tactile_graph.files import check_target, left_of

if TYPE_CHECKING:
    from rich.console import Console

    from tactile_graph.api.result import Result

IN_A_STRIP = 12
PICTURES = (".png", ".svg", ".pdf")
FILMS = (".gif", ".mp4")
PAINTING = "painting {done} of {total} pictures; Ctrl-C ends the film with those that are painted"


class Plot(Protocol):
    """Takes results while they come, and draws them in the end.

    Attributes
    ----------
    interrupted : KeyboardInterrupt or None
        What ended the drawing before its time, if anything did.
    """

    interrupted: KeyboardInterrupt | None

    def add(self, result: Result) -> None:
        """Take in a frame."""

    def save(self, stderr: Console) -> bool:
        """Write it, and return whether there was anything to draw."""

    def notes(self) -> Iterator[str]:
        """Yield what people should know of it."""


def check_plot(path: str) -> None:
    """Refuse what could not be drawn in the end, before the work.

    Raises
    ------
    UsageError
    """
    check_target("--plot", path, (*PICTURES, *FILMS), told_by_name=True)
    if Path(path).suffix.lower() == ".mp4":
        from tactile_graph.draw.film_files import ffmpeg

        ffmpeg()


def plot_of(path: str, name: str, asked: tuple[str, ...]) -> Plot:
    """Return what draws a run of the pipeline of that name, of which that is asked."""
    return _Film(path, name, asked) if Path(path).suffix.lower() in FILMS else _Strip(path)


class _Strip:
    interrupted: KeyboardInterrupt | None = None

    def __init__(self, path: str) -> None:
        self._path = path
        self._kept: list[Result] = []

    def add(self, result: Result) -> None:
        if len(self._kept) < IN_A_STRIP:
            self._kept.append(result)

    def save(self, stderr: Console) -> bool:
        if self._kept:
            from tactile_graph.draw.strip import save_strip

            save_strip(self._kept, self._path)
        return bool(self._kept)

    def notes(self) -> Iterator[str]:
        yield from ()


class _Film:
    def __init__(self, path: str, name: str, asked: tuple[str, ...]) -> None:
        from tactile_graph.draw.film import Film

        self._path = path
        self._film = Film(name, asked)
        self.interrupted: KeyboardInterrupt | None = None

    def add(self, result: Result) -> None:
        self._film.add(result)

    def save(self, stderr: Console) -> bool:
        if not self._film.n:
            return False
        from tactile_graph.cli.output.progress import Bar

        painting = Bar(stderr, "painting", things="pictures", elsewhere=PAINTING)
        older = left_of(Path(self._path))
        try:
            self._film.write(self._path, painting.at)
        except KeyboardInterrupt as error:
            painting.stop()
            if not self._film.written:
                stderr.print(f"{self._path}: not written; {older}", style="yellow", soft_wrap=True)
                raise
            self.interrupted = error
        finally:
            painting.stop()
        return True

    def notes(self) -> Iterator[str]:
        from tactile_graph.draw.film import LONGEST_S, UNTIMED_S

        film = self._film
        if film.n_painted < film.n:
            yield f"stopped while painting: the film holds {film.n_painted} of {film.n} pictures"
        if film.full:
            yield f"the film holds the first {film.n} pictures; --frames A:B takes others"
        if film.shortened:
            yield f"pauses of more than {LONGEST_S:g} s are shown as {LONGEST_S:g} s"
        if not film.timed:
            yield f"frames without a time are shown for {UNTIMED_S:g} s each"
