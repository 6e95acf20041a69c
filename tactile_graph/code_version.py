"""Which code of the project this is: versions of one number are told apart by a digest."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from importlib.metadata import distribution
from importlib.util import find_spec

PROJECT = "tactile-graph"
SHORT = 12
"""Digits of the digest that are shown."""


def code_version() -> str:
    """Return the project's version and a digest of its code: ``0.1.0 (code 2f1bb648d840)``.

    The code is that of the project's own plugins, too, whether they are imported or not.
    """
    project = distribution(PROJECT)
    offered = (e.module for e in project.entry_points if e.group == "tactile_graph")
    whole = hashlib.sha256()
    for package in sorted({"tactile_graph", *(name.partition(".")[0] for name in offered)}):
        for name, path in _code(package):
            with open(path, "rb") as file:
                whole.update(f"{name}\n".encode() + hashlib.sha256(file.read()).digest())
    return f"{project.version} (code {whole.hexdigest()[:SHORT]})"


def _code(package: str) -> Iterator[tuple[str, str]]:
    """Yield the name in its package and the path of each file of code; none of an archive's."""
    spec = find_spec(package)
    for root in (spec.submodule_search_locations or ()) if spec is not None else ():
        for folder, folders, files in os.walk(root):
            folders.sort()
            within = os.path.relpath(folder, root).replace(os.sep, "/")
            for file in sorted(files):
                if file.endswith(".py"):
                    yield f"{package}/{within}/{file}", os.path.join(folder, file)
