"""``--truth`` of commands that take the truth from recordings alone: it says how it gets there."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from tactile_graph.errors import UsageError

F = TypeVar("F", bound=Callable[..., Any])


def no_truth_option(command: F) -> F:
    """Refuse ``--truth``, which others take, with what to do instead."""
    return click.option(
        "--truth", metavar="FILE", hidden=True, is_eager=True, expose_value=False, callback=_refused
    )(command)


def _refused(context: click.Context, option: click.Parameter, value: str | None) -> None:
    if value is not None:
        raise UsageError(
            f"--truth {value}: {context.info_name} takes the truth that recordings hold; put it "
            f"into one by 'tactile-graph convert RECORDING NEW.npz --truth {value}' "
            "(docs/how-to/attach-truth.md)"
        )
