"""The ways in which commands print lines that no table or console of rich's takes."""

from __future__ import annotations

import sys
from datetime import datetime

import click

from tactile_graph.cli.readable import encoding_of, readable
from tactile_graph.foreign_text import visible


def say(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text to stdout, or to stderr; what would act on the terminal is spelled out."""
    told = readable(visible(str(text)), encoding_of(sys.stderr if err else sys.stdout))
    click.echo(told, err=err, nl=nl)


def clock() -> str:
    """Return the time of day, to begin a line with that tells of something as it happens."""
    return datetime.now().strftime("%H:%M:%S")


def hand_over(text: str) -> None:
    """Print the text of a file to stdout as it would be written to one: in UTF-8, as it ends.

    A terminal of another encoding gets what people can read.
    """
    if sys.stdout.isatty():
        say(text, nl=False)
    else:
        click.echo(visible(text).encode(), nl=False)
