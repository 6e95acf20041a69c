"""Where a plugin's code lies: all that its distribution installs, with the data beside it."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

from tactile_graph.files import sha256_of

MADE = (".pyc", ".pyo", ".nbi", ".nbc")
"""Endings of what is made of code."""
PATHS = ".pth"
"""Ending of a file among the installed packages that says where others lie."""
CACHES = "__pycache__"
BESIDE = {"tests", "test", "docs", "examples", "benchmarks", "build", "dist"}
"""Folders of a project that may hold packages, which are not installed."""


def digests_of(package: str, modules: Iterable[str]) -> list[tuple[str, str]]:
    """Return the names and digests of a plugin's files, sorted.

    Of a package that is installed they are those that it was installed with; of one that is
    installed to be edited, or of none, what lies in the folders of its modules.

    Parameters
    ----------
    package : str
        Of the plugin; it need not be an installed one's.
    modules : iterable of str
        Those that its steps are of.
    """
    names, root = {*modules}, None
    files = dict[Path, str]()
    try:
        dist = distribution(package)
    except (PackageNotFoundError, ValueError):  # code that was typed, or is beside a test
        dist = None
    if dist is not None:
        files = {Path(str(dist.locate_file(f))): f.as_posix() for f in dist.files or ()}
        files = {p: name for p, name in files.items() if _counts(name) and p.is_file()}
        root = _edited(dist)
        names |= {*(dist.read_text("top_level.txt") or "").split()}
        names |= {e.module for e in dist.entry_points if e.group == "tactile_graph"}
        names |= {*_on_paths(dist, root)}
    known = {path.resolve() for path in files}
    for name in sorted(names):
        for place in _places(name, root):
            first = place / "__init__.py" if place.is_dir() else place
            if first.resolve() not in known:
                files.update(_within(place))
    return sorted((name, sha256_of(path)) for path, name in files.items())


def _counts(name: str) -> bool:
    """Return whether a file that was installed is code, or data beside it."""
    head, *below = name.split("/")
    about = head == ".." or head.endswith((".dist-info", ".egg-info", *(() if below else (PATHS,))))
    return not (about or head.startswith("__editable__") or CACHES in name or name.endswith(MADE))


def _edited(dist: Distribution) -> Path | None:
    """Return the folder of a distribution that is installed to be edited."""
    told = json.loads(dist.read_text("direct_url.json") or "{}")
    if not told.get("dir_info", {}).get("editable"):
        return None
    return Path(url2pathname(urlsplit(told["url"]).path)).resolve()


def _on_paths(dist: Distribution, root: Path | None) -> Iterator[str]:
    """Yield the packages in the folders that a distribution which is edited puts on the path."""
    texts = [f.read_text() for f in dist.files or () if root is not None and f.suffix == PATHS]
    for line in "\n".join(texts).splitlines():
        folder = Path(line.strip())
        if folder.is_dir() and root is not None and folder.resolve().is_relative_to(root):
            found = {first.parent.name for first in folder.glob("*/__init__.py")}
            yield from sorted(found - BESIDE)


def _places(name: str, root: Path | None) -> Iterator[Path]:
    """Yield the folder or file of a module's package, of a namespace those below a folder."""
    head = ""
    for part in name.split("."):
        head = f"{head}.{part}" if head else part
        file, folders = _location(head)
        if file:
            place = Path(folders[0] if folders else file)
            yield from [place] if place.exists() else []
            return
        if root is not None:
            yield from (p for p in map(Path, folders) if p.resolve().is_relative_to(root))


def _location(name: str) -> tuple[str | None, list[str]]:
    """Return the file and the folders of a module; nothing of one that was typed."""
    module = sys.modules.get(name)
    if module is not None:
        return getattr(module, "__file__", None), [*(getattr(module, "__path__", None) or ())]
    try:
        spec = find_spec(name)
    except (ImportError, ValueError, AttributeError):
        spec = None
    if spec is None:
        return None, []
    return spec.origin if spec.has_location else None, [*(spec.submodule_search_locations or ())]


def _within(place: Path) -> Iterator[tuple[Path, str]]:
    """Yield a file, or the files of a folder, with their names from where it lies."""
    if place.is_file():
        yield place, place.name
        return
    been = set[str]()
    for folder, folders, files in os.walk(place, followlinks=True):
        if (real := os.path.realpath(folder)) in been:  # a link that leads back
            folders.clear()
            continue
        been.add(real)
        folders[:] = [f for f in folders if f != CACHES and not f.startswith(".")]
        for path in (Path(folder, f) for f in files):
            if not path.name.startswith(".") and path.suffix not in MADE and path.is_file():
                yield path, path.relative_to(place.parent).as_posix()
