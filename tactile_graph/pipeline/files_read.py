"""``FilesRead``: the files that a pipeline is made of, as they were when it was loaded."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple


class Used(NamedTuple):
    """A pipeline file that another uses: as errors name it, and what stands in it."""

    file: str
    text: str


@dataclass(frozen=True)
class FilesRead:
    """What a pipeline is resolved from again, whatever became of its files and of who moved.

    Parameters
    ----------
    folder : str
        The current folder then, from which files are named.
    used : dict of (str, str) to Used
        By the file that uses it and its name there.
    parents : dict of str to str
        What each file's pipeline evolves from.
    """

    folder: str
    used: dict[tuple[str, str], Used] = field(default_factory=dict)
    parents: dict[str, str] = field(default_factory=dict)

    @classmethod
    def here(cls) -> FilesRead:
        """Return that of a pipeline that is about to be read from the current folder."""
        try:
            return cls(os.getcwd())
        except OSError:  # the folder was deleted
            return cls("")

    def place(self, file: str) -> str:
        """Return a file's path that means the same from any folder."""
        return os.path.join(self.folder, file)

    def target(self, file: str) -> Path:
        """Return a file's path with links seen through: two of one file are equal."""
        return Path(self.place(file)).resolve()
