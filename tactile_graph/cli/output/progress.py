"""A progress bar on stderr for work that turns out to be long."""

from __future__ import annotations

import time
from contextlib import ExitStack
from typing import TYPE_CHECKING

from rich.console import Console

from tactile_graph.compiled.preparing import told_by

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

WORTH_A_BAR_S = 1.0
REDRAW_S = 0.1


class Bar:
    """Counts frames; shows itself after a second, on a terminal only.

    Elsewhere it may be a single line.

    Parameters
    ----------
    console : Console
        On stderr.
    what : str
        Stands before the bar.
    shown : bool
        False where it would disturb.
    things : str
        What it counts.
    elsewhere : str
        Printed once, after a second, where there is no terminal; ``{done}`` and ``{total}`` in it
        say how far the work is.
    """

    def __init__(
        self,
        console: Console,
        what: str,
        shown: bool = True,
        things: str = "frames",
        elsewhere: str = "",
    ) -> None:
        self._console = console
        self._what = what
        self._things = things
        self._elsewhere = "" if console.is_terminal else elsewhere
        self._next = time.monotonic() + WORTH_A_BAR_S
        self._progress: Progress | None = None
        self._task: TaskID | None = None
        self._shown = shown and console.is_terminal
        self._told = ExitStack()

    def at(self, done: int, total: int | None) -> None:
        """Say how far the work is; ``total`` is None where nobody knows."""
        if time.monotonic() < self._next:
            return
        if self._elsewhere:
            told = self._elsewhere.format(done=done, total=total)
            self._console.print(told, style="dim", soft_wrap=True)
            self._elsewhere = ""
        if not self._shown:
            return
        if self._progress is None:
            self._progress, self._task = self._start(done, total)
        if self._task is not None:
            self._progress.update(self._task, completed=done, total=total)
        self._next = time.monotonic() + REDRAW_S

    def now(self, total: int | None) -> None:
        """Show the bar without waiting: the first frame of a long run may take a while."""
        if self._shown and self._progress is None:
            self._progress, self._task = self._start(0, total)

    def _start(self, done: int, total: int | None) -> tuple[Progress, TaskID]:
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeRemainingColumn,
        )

        progress = Progress(
            TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(),
            TextColumn(self._things), TimeRemainingColumn(), console=self._console, transient=True,
        )  # fmt: skip
        progress.start()
        task = progress.add_task(self._what, completed=done, total=total)
        self._told.enter_context(
            told_by(lambda text: progress.update(task, description=text or self._what))
        )
        return progress, task

    def stop(self) -> None:
        """Take the bar away."""
        self._told.close()
        if self._progress is not None:
            self._progress.stop()
