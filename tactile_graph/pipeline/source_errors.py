"""Name the source where it raises what nobody wrote for people."""

from __future__ import annotations

from collections.abc import Iterator

from tactile_graph.engine.outcome import raised_at
from tactile_graph.errors import DataError, TactileGraphError
from tactile_graph.wires.frame import Frame


def told(name: str, frames: Iterator[Frame]) -> Iterator[Frame]:
    """Yield the frames of the source of that name.

    Raises
    ------
    DataError
        In place of an error that is not for people: which source, what, and where in its code.
    """
    try:
        yield from frames
    except TactileGraphError:
        raise
    except (Exception, SystemExit) as error:  # a source may raise anything
        if isinstance(error, OSError) and error.filename is not None:
            raise  # it names the file
        text = f"{type(error).__name__}: {error}".removesuffix(": ")
        raise DataError(f"source {name!r}", f"{text} ({raised_at(error)})") from error
