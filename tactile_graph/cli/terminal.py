"""The rich consoles that commands write to."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import Any, NoReturn

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.text import Text

from tactile_graph.cli.readable import readable
from tactile_graph.foreign_text import visible
from tactile_graph.plugins.foreign_code import stdout_to_stderr

WIDE = 200


class _Console(Console):
    def render_str(self, text: str, **style: Any) -> Text:
        """Spell out what a name would do before it is measured for a table."""
        return super().render_str(readable(visible(text), self.encoding), **style)

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterator[Segment]:
        """Spell it out wherever it is not yet; rich's own controls stay."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else segment._replace(text=visible(segment.text))

    def on_broken_pipe(self) -> NoReturn:
        """Let the command line end it: rich's own way exits with 1."""
        raise BrokenPipeError


@contextmanager
def stdout_for_programs(kept: bool) -> Iterator[None]:
    """Send what plugins print to stderr while stdout is kept for lines that programs read."""
    with stdout_to_stderr() if kept else nullcontext():
        yield


def console(stderr: bool = False) -> Console:
    """Return a console on stdout or stderr; away from a terminal its lines may be long."""
    made = _Console(stderr=stderr, highlight=False, markup=False, emoji=False)
    if not made.is_terminal and "COLUMNS" not in os.environ:
        made.width = WIDE  # a table cut to 80 columns is of no use to grep
    return made


def remark(text: str) -> None:
    """Tell people something beside the results, on stderr."""
    console(stderr=True).print(text, style="yellow", soft_wrap=True)
