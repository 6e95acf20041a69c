"""Lists of the files that plugins offer: pads, presets, scenes; or one of them as it stands."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tactile_graph.cli.say import hand_over
from tactile_graph.errors import UsageError
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from rich.text import Text


def list_files(kind: str, name: str | None) -> None:
    """Print what is offered of a kind, a line each, or the file of one as it stands.

    Parameters
    ----------
    kind : str
        The hook's word for them: ``"pads"``.
    name : str, optional
        The one to print.

    Raises
    ------
    UsageError
        If there is none of that name, or its file cannot be read.
    """
    from tactile_graph.cli.terminal import console

    found = registry.installed()
    if name is not None:
        hand_over(file_text(found.path(kind, name)))
        return
    names = found.names(kind)
    out = console()
    if not names:
        out.print(f"no plugin offers {kind}")
    several = len({found.offer(kind, n).plugin.name for n in names}) > 1
    width = max((len(n) for n in names), default=0)
    for one in names:
        out.print(_line(found, kind, one, width, several), soft_wrap=True)


def complete(kind: str, incomplete: str) -> list[str]:
    """Return the names on offer that begin so, for the shell."""
    return [n for n in registry.installed().names(kind) if n.startswith(incomplete)]


def _line(found: registry.Registry, kind: str, name: str, width: int, several: bool) -> Text:
    from rich.text import Text

    text = Text.assemble((name.ljust(width), "bold"), "  ")
    try:
        text.append(_about(found.path(kind, name)))
    except UsageError as error:
        text.append(str(error), style="red")
    text.append(f"  ({found.offer(kind, name).plugin.name})" if several else "", style="cyan")
    return text


def _about(path: Path) -> str:
    """Return the line a file says of itself.

    Raises
    ------
    UsageError
        If it cannot be read.
    """
    from tactile_graph.pipeline.document import read_document

    document = read_document(file_text(path), path.name)
    if document.problems:
        raise UsageError(str(document.problems[0]).partition("\n")[0])
    data = document.data if isinstance(document.data, dict) else {}
    return str(data.get("about", ""))


def file_text(path: Path) -> str:
    """Return a file as it stands.

    Raises
    ------
    UsageError
        If it cannot be read.
    """
    from tactile_graph.pipeline.document import text_of_file

    try:
        return text_of_file(path)
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{path} cannot be read: {error}") from None
