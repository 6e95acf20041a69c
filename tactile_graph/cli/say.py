"""The one way in which commands print lines that no table or console of rich's takes."""

from __future__ import annotations

import click

from tactile_graph.foreign_text import visible


def say(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text to stdout, or to stderr; what would act on the terminal is spelled out."""
    click.echo(visible(str(text)), err=err, nl=nl)
