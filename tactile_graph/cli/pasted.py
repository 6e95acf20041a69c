"""Words of command lines that are offered to be pasted into a shell."""

from __future__ import annotations

import shlex

from tactile_graph.foreign_text import visible


def pasted(word: str) -> str:
    r"""Return a word as a shell (bash, zsh, ksh) takes it for one, all of it seen.

    What is not seen, and bytes that are no UTF-8, stand as ``$'\377'``.
    """
    if visible(word) == word and "\n" not in word and "\t" not in word:
        return shlex.quote(word)
    return f"$'{''.join(map(_spelled, word))}'"


def pasted_path(path: str) -> str:
    """Return a path likewise, and so that none is taken for an option."""
    return pasted(f"./{path}" if path.startswith("-") else path)


def _spelled(character: str) -> str:
    if character in "'\\":
        return f"\\{character}"
    if visible(character) == character and character not in "\n\t":
        return character
    raw = character.encode("utf-8", "surrogateescape")
    return "".join(f"\\{byte:03o}" for byte in raw)
