"""How a command ends: its exit code, and errors told to people without a traceback."""

from __future__ import annotations

import errno
import os
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from tactile_graph.changes import home_kept
from tactile_graph.cli.interrupt import Interrupts, code_of, words_of
from tactile_graph.cli.readable import encoding_of, open_all_readable, readable
from tactile_graph.cli.say import say
from tactile_graph.errors import PipelineError, PluginError, TactileGraphError, text_of
from tactile_graph.foreign_text import visible

SOME_FAILED = 1
NOT_DONE = 2
PIPE_CLOSED = 141
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


def ending(run: Callable[[], Any], debug: bool) -> int:
    """Run a command line and return its exit code; errors are shown on stderr.

    Parameters
    ----------
    run : callable
        Runs it; a returned number is an exit code.
    debug : bool
        Show tracebacks.
    """
    Interrupts.latest = None
    open_all_readable()
    try:
        with Interrupts(), home_kept():
            code = run()
        sys.stdout.flush()  # a closed pipe must show itself here, not while Python shuts down
    except BrokenPipeError:
        stop_writing()
        return PIPE_CLOSED
    except (click.Abort, KeyboardInterrupt) as error:
        cause = (error.__cause__ if isinstance(error, click.Abort) else None) or error
        if isinstance(cause, EOFError):  # click takes it for Ctrl-D; nothing here asks anything
            show(cause, debug)
            return NOT_DONE
        return _interrupted(cause)
    except SystemExit as error:
        if _of_click(error):
            raise
        show(exited(error), debug)
        return NOT_DONE
    except Exception as error:  # whatever a plugin raises: people get a line, not a traceback
        if Interrupts.latest is not None and not isinstance(error, TactileGraphError):
            return _interrupted(Interrupts.latest)
        show(error, debug)
        return error.exit_code if isinstance(error, click.ClickException) else NOT_DONE
    except BaseException as error:
        show(exited(error), debug)
        return NOT_DONE
    return code if isinstance(code, int) else 0


def _interrupted(error: BaseException) -> int:
    say(words_of(error), err=True)
    return code_of(error)


def exited(error: BaseException) -> PluginError:
    """Return what to say when a plugin's code ends the program."""
    from tactile_graph.engine.outcomes.outcome import raised_at

    what = f"{error!r}, {raised_at(error)}"
    told = PluginError(f"a plugin ended the program: {what}")
    told.__cause__ = error
    return told


def _of_click(error: SystemExit) -> bool:
    """Return whether click itself ends the program, as it does after completing a word."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    return Path(last.filename).parent == Path(click.__file__).parent


def stop_writing() -> None:
    """Send what is still to be written to stdout nowhere: whoever read it is gone."""
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
    except (OSError, ValueError, AttributeError):  # stdout is no file, as in tests
        return


def show(error: BaseException, debug: bool = False) -> None:
    """Write an error to stderr."""
    if debug:
        traceback.print_exception(error, file=sys.stderr)
    if isinstance(error, PipelineError):
        from tactile_graph.cli.problems import show_problems
        from tactile_graph.cli.terminal import console

        show_problems(console(stderr=True), error)
    elif isinstance(error, click.exceptions.NoArgsIsHelpError):  # what it says is no error
        say(error.format_message(), err=True)
    elif isinstance(error, click.UsageError):
        _line(error.format_message())
        if error.ctx is not None:
            say(f"try: {error.ctx.command_path} --help", err=True)
    else:
        _line(words(error))
        if not (debug or isinstance(error, TactileGraphError | click.ClickException | OSError)):
            say("(--debug shows where)", err=True)


def words(error: BaseException) -> str:
    """Return an error in words: its text, with its type unless that is one of ours."""
    if isinstance(error, click.ClickException):
        return error.format_message()
    if isinstance(error, TactileGraphError):
        return str(error)
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror or error}"
    if isinstance(error, OSError) and error.errno in NO_ROOM:  # what has a name says it
        return f"the output cannot be written: {error.strerror}"
    return f"{type(error).__name__}: {text_of(error)}".removesuffix(": ")


def _line(text: str) -> None:
    told = readable(visible(text), encoding_of(sys.stderr))
    click.echo(f"{click.style('error:', fg='red', bold=True)} {told}", err=True)
