"""What a new package and its step can be called."""

from __future__ import annotations

import keyword
import re
import symtable
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution
from importlib.util import find_spec
from string import Template

from tactile_graph.cli.package.making import TEMPLATES, Names, templates_of, words_of
from tactile_graph.errors import UsageError
from tactile_graph.pipeline.document import is_plain
from tactile_graph.plugins import registry

OWN = re.compile(r"tactile[-_.]graph[-_.]+(?=.)")
"""What a package's name may begin with and its step's need not."""
LONGEST_PACKAGE, LONGEST_STEP = 38, 24
"""So that no line of a package is longer than its own workflow allows."""
_NOBODY = Names("nobodys", "nobodys", "nobodys")
"""Names that no template holds."""


def names_of(project: str, step: str | None, kind: str) -> Names:
    """Return the names of a package and its step, or say which cannot be.

    Parameters
    ----------
    project : str
        As the user gave it: letters, digits, ``-``, ``_`` and ``.``.
    step : str, optional
        By default the project's name without ``tactile-graph-`` before it.
    kind : str
        Of `KINDS`: the names that its modules use are no step's.

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
    told = _no_name("package", package, LONGEST_PACKAGE) or _is_installed(project, package)
    if told:
        raise UsageError(told)
    names = Names(project, package, OWN.sub("", package) if step is None else step)
    told = _no_step(names.step, kind)
    if told:
        raise UsageError(f"{told}; name another by --step{_such_as(names.step, kind)}")
    return names


def _no_name(what: str, name: str, most: int) -> str:
    """Return why a name is none in Python; "" if it is one."""
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or keyword.iskeyword(name):
        return (
            f"a {what} cannot be called {name!r}: small letters, digits and '_' make its name, "
            "the first a letter, and no word of Python's own"
        )
    if len(name) > most:
        return f"a {what}'s name has at most {most} letters, got {len(name)}: {name}"
    return ""


def _is_installed(project: str, package: str) -> str:
    """Return that something is installed under a package's names; "" if nothing is."""
    if package in sys.stdlib_module_names or find_spec(package) is not None:
        return f"there is a module {package!r} already; choose another name"
    try:
        there = distribution(project)
    except PackageNotFoundError:
        return ""
    return (
        f"package {there.name} is installed already, and this one would take its place; "
        "choose another name"
    )


def _no_step(name: str, kind: str) -> str:
    """Return why a step of a kind cannot have a name; "" if it can."""
    told = _no_name("step", name, LONGEST_STEP)
    if told:
        return told
    if not is_plain(name):
        return f"a step cannot be called {name!r}: in a pipeline file that is no name but a value"
    target = words_of(Names("", "", name), kind)["target"]
    taken = {name, target} & set(_used_by(kind))
    if taken:
        return (
            f"a step of kind {kind} cannot be called {name!r}: its package uses {min(taken)!r} "
            "for something else"
        )
    return _on_offer(name)


def _used_by(kind: str) -> Iterator[str]:
    """Yield the names that a kind's modules import, define or look up, Python's own among them."""
    words = words_of(_NOBODY, kind)
    for template in templates_of(kind):
        place = template.relative_to(TEMPLATES)
        if place.name.endswith(".py.template") and "src" in place.parts:
            text = Template(template.read_text(encoding="utf-8")).substitute(words)
            yield from _globals_of(symtable.symtable(text, template.name, "exec"), whole=True)


def _globals_of(table: symtable.SymbolTable, whole: bool = False) -> Iterator[str]:
    """Yield the names of a module that its code means, in it (the whole) or in a function."""
    yield from (s.get_name() for s in table.get_symbols() if whole or s.is_global())
    for inner in table.get_children():
        yield from _globals_of(inner)


def _on_offer(step: str) -> str:
    """Return which plugin has a step's names already; "" if none has."""
    offers = registry.installed()
    for kind, name in (("steps", step), ("pipelines", f"{step}-demo")):
        if offers.has(kind, name):
            label = offers.offer(kind, name).plugin.label
            return f"{label} has a {kind.removesuffix('s')} {name!r} already"
    labels = [plugin.label for plugin in offers.plugins if plugin.name == step]
    return f"there is a {labels[0]} already" if labels else ""


def _such_as(step: str, kind: str) -> str:
    """Return the words that offer a name near one that cannot be."""
    plain = re.sub(r"[^a-z0-9]+", "_", step.lower()).strip("_")
    near = (name[:LONGEST_STEP].rstrip("_") for name in (plain, f"my_{plain or kind}"))
    found = next((name for name in near if not _no_step(name, kind)), "")
    return f", such as {found}" if found else ""
