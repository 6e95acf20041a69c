"""Fill a package's templates, and put it where it belongs, whole or not at all."""

from __future__ import annotations

import os
import shutil
from importlib.metadata import version
from pathlib import Path
from string import Template
from typing import NamedTuple

from tactile_graph.cli.package.kinds import KINDS
from tactile_graph.errors import UsageError
from tactile_graph.files import said, uninterrupted

TEMPLATES = Path(__file__).with_name("templates")
SUFFIX = ".template"


class Names(NamedTuple):
    """What is called how in a new package."""

    project: str
    """Of the folder and the distribution."""
    package: str
    """That is imported."""
    step: str
    """In pipeline files, and of the module."""

    @property
    def type_name(self) -> str:
        """Name of the step's class, or of what it answers with."""
        return "".join(part.capitalize() for part in self.step.split("_"))


def make_package(names: Names, kind: str, folder: Path) -> list[Path]:
    """Write the package, and return its files, relative to its folder.

    Raises
    ------
    UsageError
        If the folder is there already, or cannot be written.
    """
    if os.path.lexists(folder):
        raise UsageError(f"{folder} is there already; choose another name, or --into a folder")
    part = folder.with_name(f".{folder.name}.part")
    with uninterrupted(), said(folder):
        shutil.rmtree(part, ignore_errors=True)
        try:
            written = [_write(template, part, names, kind) for template in templates_of(kind)]
            part.rename(folder)
        except BaseException:
            shutil.rmtree(part, ignore_errors=True)
            raise
    return sorted(path.relative_to(part) for path in written)


def repository_around(folder: Path) -> Path | None:
    """Return the git repository that a package's folder lies in; None if it lies in none."""
    return next((p for p in folder.resolve().parents if (p / ".git").exists()), None)


def templates_of(kind: str) -> list[Path]:
    """Return the templates of a kind: those of every package, then its own."""
    rooms = (TEMPLATES / "common", TEMPLATES / kind)
    return [path for room in rooms for path in sorted(room.rglob("*")) if path.is_file()]


def words_of(names: Names, kind: str) -> dict[str, str]:
    """Return what stands for each ``$name`` in the templates."""
    words = {
        "project": names.project,
        "package": names.package,
        "step": names.step,
        "Step": names.type_name,
        "kind": kind,
        "version": version("tactile-graph"),
    }
    filled = {k: Template(v).substitute(words) for k, v in KINDS[kind]._asdict().items()}
    return words | filled


def _write(template: Path, folder: Path, names: Names, kind: str) -> Path:
    words = words_of(names, kind)
    room = TEMPLATES / ("common" if TEMPLATES / "common" in template.parents else kind)
    place = str(template.relative_to(room)).removesuffix(SUFFIX)
    for name in ("package", "step"):
        place = place.replace(f"__{name}__", words[name])
    path = folder / place
    path.parent.mkdir(parents=True, exist_ok=True)
    text = Template(template.read_text(encoding="utf-8")).substitute(words)
    path.write_text(text, encoding="utf-8")
    return path
