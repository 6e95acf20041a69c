"""``FileKind``: one kind of YAML file that a plugin reads, as ``check`` and ``schema`` need it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class FileKind:
    """How files of one kind are checked, told in a line, and described for editors.

    Parameters
    ----------
    offers : str
        The hook's word for such files: ``"pads"`` of ``tactile_graph_pads``. Empty where no plugin
        offers any by name.
    record : type
        What a file holds: a dataclass or pydantic model, each key of it a parameter of its
        docstring.
    read : callable
        Returns what the file of a path or name holds, read as whatever uses it reads it; raises
        `PipelineError` with all that is wrong.
    tell : callable
        Returns what was read in a line.
    base_key : str
        Key of a file that names another one it is laid over: what that one says need not be said
        again. Empty where there is none.
    """

    offers: str
    record: type
    read: Callable[[str], Any]
    tell: Callable[[Any], str]
    base_key: str = ""
