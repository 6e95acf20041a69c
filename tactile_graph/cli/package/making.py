"""Fill a package's templates, and put it where it belongs, whole or not at all."""

from __future__ import annotations

import keyword
import re
import shutil
import sys
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import NamedTuple

from tactile_graph.cli.package.kinds import KINDS
from tactile_graph.errors import UsageError
from tactile_graph.files import said, uninterrupted
from tactile_graph.plugins import registry

TEMPLATES = Path(__file__).with_name("templates")
SUFFIX = ".template"
OWN = re.compile(r"tactile[-_.]graph[-_.]+(?=.)")
"""What a package's name may begin with and its step's need not."""


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


def names_of(project: str, step: str | None) -> Names:
    """Return the names of a package and its step, or say which cannot be.

    Parameters
    ----------
    project : str
        As the user gave it: letters, digits, ``-``, ``_`` and ``.``.
    step : str, optional
        By default the project's name without ``tactile-graph-`` before it.

    Raises
    ------
    UsageError
        If a name is no name, or is taken.
    """
    if not re.fullmatch(r"[A-Za-z0-9]([A-Za-z0-9._-]*[A-Za-z0-9])?", project):
        raise UsageError(
            f"a package cannot be called {project!r}: letters, digits, '-', '_' and '.' make its "
            "name, the first and last a letter or digit"
        )
    package = re.sub(r"[-_.]+", "_", project).lower()
    step = step or OWN.sub("", package)
    for what, name in (("package", package), ("step", step)):
        if not name.isidentifier() or keyword.iskeyword(name) or name != name.lower():
            raise UsageError(
                f"a {what} cannot be called {name!r}: small letters, digits and '_' make its name, "
                "the first a letter, and no word of Python's own"
            )
    for what, name, most in (("package", package, 38), ("step", step, 24)):
        if len(name) > most:
            raise UsageError(f"a {what}'s name has at most {most} letters, got {len(name)}: {name}")
    if package in sys.stdlib_module_names or find_spec(package) is not None:
        raise UsageError(f"there is a module {package!r} already; choose another name")
    if registry.installed().has("steps", step):
        label = registry.installed().offer("steps", step).plugin.label
        raise UsageError(f"{label} has a step {step!r} already; name another by --step")
    return Names(project, package, step)


def make_package(names: Names, kind: str, folder: Path) -> list[Path]:
    """Write the package, and return its files, relative to its folder.

    Raises
    ------
    UsageError
        If the folder is there already, or cannot be written.
    """
    if folder.exists():
        raise UsageError(f"{folder} is there already; choose another name, or --into a folder")
    part = folder.with_name(f".{folder.name}.part")
    with uninterrupted(), said(folder):
        shutil.rmtree(part, ignore_errors=True)
        try:
            written = [
                _write(template, part, names, kind)
                for room in ("common", kind)
                for template in sorted((TEMPLATES / room).rglob("*"))
                if template.is_file()
            ]
            part.rename(folder)
        except BaseException:
            shutil.rmtree(part, ignore_errors=True)
            raise
    return sorted(path.relative_to(part) for path in written)


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
