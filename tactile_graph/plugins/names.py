"""``Names``: what plugins offer of one kind, by plain name and by the plugin's and its own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from tactile_graph.errors import PluginError, UsageError, did_you_mean, one_of

OWN = "tactile-graph"
"""The project's own package."""
AMBIGUOUS = ("steps", "pipelines", "readers")
"""Kinds of which no plugin has a plain name before another."""


def singular(kind: str) -> str:
    """Return the word for one offer of a kind: ``"file kind"`` for ``"file_kinds"``."""
    words = kind.replace("_", " ")
    return words.removesuffix("ies") + "y" if words.endswith("ies") else words.removesuffix("s")


def qualified(plugin: str, name: str) -> str:
    """Return a name behind that of its plugin; the ending of a file's name has a dot already."""
    return f"{plugin}{name}" if name.startswith(".") else f"{plugin}.{name}"


@dataclass
class Plugin:
    """One installed plugin: what it offers, or why it does not."""

    name: str
    package: str
    version: str = ""
    error: str = ""
    blocked: bool = False
    import_ms: float = 0.0
    offers: dict[str, dict[str, Any]] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """Plugin and package, as errors name it."""
        return f"plugin {self.name!r} (package {self.package})"


def check_name(plugin: Plugin, packages: Sequence[str]) -> None:
    """Refuse a plugin whose name another package's has too; the project's own keep theirs.

    Parameters
    ----------
    plugin : Plugin
    packages : sequence of str
        All that have a plugin of this name.

    Raises
    ------
    PluginError
    """
    if len(packages) == 1 or plugin.package == OWN:
        return
    if OWN in packages:
        told = f"package {OWN} has a plugin of this name already; give the entry point another"
        raise PluginError(told)
    owners = " and ".join(packages)
    raise PluginError(
        f"packages {owners} have a plugin of this name each, so none of them has it; "
        "uninstall all but one, or give its entry point another name"
    )


@dataclass
class Offer:
    """One named thing a plugin offers."""

    name: str
    plugin: Plugin
    target: Any

    @property
    def qualified(self) -> str:
        """The name behind that of the plugin: ``filters.median``, or ``mine.csv`` of an ending."""
        return qualified(self.plugin.name, self.name)

    @property
    def identity(self) -> str:
        """A name that stays whatever else is installed: plain for the project's own."""
        return self.name if self.plugin.package == OWN else self.qualified


class Names:
    """What plugins offer of one kind.

    A name that two plugins offer has no silent winner among steps and pipelines: it is ambiguous,
    but for a file of a package that offers it, which means its own. Of other kinds the first has
    the plain name, the others have qualified ones.
    """

    def __init__(self, kind: str) -> None:
        self.kind = kind
        self._plain: dict[str, list[Offer]] = {}
        self._qualified: dict[str, Offer] = {}

    def add(self, offer: Offer) -> None:
        """Enter what a plugin offers."""
        self._plain.setdefault(offer.name, []).append(offer)
        self._qualified[offer.qualified] = offer

    def __contains__(self, name: str) -> bool:
        return name in self._plain or name in self._qualified

    def __iter__(self) -> Iterator[str]:
        """Yield a name of each offer, as short as it can be, in the order of the plugins."""
        return map(self.spelled, self._qualified.values())

    def spelled(self, offer: Offer) -> str:
        """Return the shortest name that means this offer and no other."""
        rivals = self._plain[offer.name]
        plain = rivals[0] is offer and (len(rivals) == 1 or self.kind not in AMBIGUOUS)
        return offer.name if plain else offer.qualified

    def find(self, name: str, package: str = "") -> Offer | None:
        """Return what a name means, in a file of a package; None if nothing is called so.

        Raises
        ------
        UsageError
            If several plugins offer it; says how each is named.
        """
        rivals = self._plain.get(name)
        if rivals is None:
            return self._qualified.get(name)
        if len(rivals) == 1 or self.kind not in AMBIGUOUS:
            return rivals[0]
        own = [offer for offer in rivals if offer.plugin.package == package]
        if len(own) == 1:
            return own[0]
        raise UsageError(self._ambiguous(name, rivals))

    def unknown(self, name: str) -> str:
        """Return the text that says a name is not on offer, with what is near."""
        head = name.partition(".")[0]
        dotted = [*self._qualified] if "." in name else []
        known = [q for q in dotted if q.startswith(f"{head}.")] or sorted(self)
        near = did_you_mean(name, dotted) or did_you_mean(name, known)
        return f"no {singular(self.kind)} named {name!r}{near or f'; there are: {one_of(known)}'}"

    @property
    def clashes(self) -> list[str]:
        """What is to be told of names that several plugins offer, a line each."""
        told = []
        for name, rivals in self._plain.items():
            if len(rivals) == 1:
                continue
            if self.kind in AMBIGUOUS:
                told.append(self._ambiguous(name, rivals))
                continue
            told += [
                f"{singular(self.kind)} {name!r} of {late.plugin.label} is called "
                f"{late.qualified}: {rivals[0].plugin.label} has the plain name"
                for late in rivals[1:]
            ]
        return told

    def _ambiguous(self, name: str, rivals: list[Offer]) -> str:
        owners = " and ".join(offer.plugin.label for offer in rivals)
        names = " or ".join(offer.qualified for offer in rivals)
        return f"{singular(self.kind)} {name!r} is ambiguous: {owners} offer it; write {names}"
