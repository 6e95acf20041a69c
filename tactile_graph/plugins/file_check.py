"""What a plugin offers that looks through files of a kind of its own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple


class Checked(NamedTuple):
    """What came of looking through a file.

    Attributes
    ----------
    about : str
        What it is and holds, in a line.
    wrong : tuple of str
        What is wrong with it, and still is where it could not be mended.
    mended : tuple of str
        What was wrong and is right now.
    left : tuple of str
        What a writer that was cut short left behind, and what the file holds does not suffer from.
    """

    about: str
    wrong: tuple[str, ...] = ()
    mended: tuple[str, ...] = ()
    left: tuple[str, ...] = ()


class FileCheck(NamedTuple):
    """Looks through the files, or folders, of one kind.

    Attributes
    ----------
    takes : callable
        Whether a path is of this kind, told from little of it: every plugin's check is asked.
    check : callable
        Returns what is wrong with a file, mended before where the second argument is true; raises
        `TactileGraphError` if it is damaged beyond that.
    """

    takes: Callable[[Path], bool]
    check: Callable[[Path, bool], Checked]
