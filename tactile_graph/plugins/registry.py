"""Find the installed plugins and keep what they offer, loading a step only when it is used."""

from __future__ import annotations

import importlib
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import pluggy

from tactile_graph.errors import PluginError, UsageError, did_you_mean, one_of, shown
from tactile_graph.plugins import hookspecs
from tactile_graph.plugins.foreign_code import Broken, foreign_code
from tactile_graph.plugins.mistakes import check_hooks, stale, why
from tactile_graph.vocabulary import QUANTITIES, UNITS, Vocabulary

if TYPE_CHECKING:
    from tactile_graph.steps.signature import Signature

GROUP = "tactile_graph"
ENVIRONMENT = "TACTILE_GRAPH_PLUGINS"
Row = tuple[str, str, str, Callable[[], ModuleType]]
"""A plugin to be: its name, its package, that one's version, and what imports its module."""
OWN = "tactile-graph"
"""The package of the core and of the plugins that come with it."""
_WORDS: dict[str, Vocabulary] = {"quantities": QUANTITIES, "units": UNITS}
CORE = "core"
"""The plugin that the core itself is: nothing goes without it, so no selection leaves it out."""


def singular(kind: str) -> str:
    """Return the word for one offer of a kind: ``"file kind"`` for ``"file_kinds"``."""
    words = kind.replace("_", " ")
    return words.removesuffix("ies") + "y" if words.endswith("ies") else words.removesuffix("s")


@dataclass(frozen=True)
class Selection:
    """Which plugins may load, as ``"hull,filters"`` (only these) or ``"-mrf"`` (all but these)."""

    only: frozenset[str] = frozenset()
    blocked: frozenset[str] = frozenset()

    @classmethod
    def parse(cls, text: str) -> Selection:
        """Return the selection a flag or environment variable spells."""
        names = [n.strip() for n in text.split(",") if n.strip()]
        return cls(
            frozenset(n for n in names if not n.startswith("-")),
            frozenset(n[1:] for n in names if n.startswith("-")),
        )

    def allows(self, name: str) -> bool:
        """Return whether the plugin may load."""
        asked = name not in self.blocked and (not self.only or name in self.only)
        return asked or name == CORE


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


@dataclass
class Offer:
    """One named thing a plugin offers."""

    name: str
    plugin: Plugin
    target: Any


class Registry:
    """Everything the installed plugins offer.

    Parameters
    ----------
    plugins : iterable of (name, package, version, loader)
        In the order in which names are handed out; ``loader()`` imports the plugin's module.
    selection : Selection
    """

    def __init__(
        self,
        plugins: Iterable[Row],
        selection: Selection | None = None,
    ) -> None:
        self.plugins: list[Plugin] = []
        self.clashes: list[str] = []
        self._hooks: dict[str, hookspecs.Answer] = {}
        self._offers: dict[str, dict[str, Offer]] = {}
        self._signatures: dict[str, Signature] = {}
        self._manager = pluggy.PluginManager(hookspecs.PROJECT)
        self._add_hooks(hookspecs)
        allowed = selection or Selection()
        modules = []
        for name, package, version, loader in plugins:
            plugin = Plugin(name, package, version, blocked=not allowed.allows(name))
            self.plugins.append(plugin)
            if not plugin.blocked:
                with self._blamed(plugin):
                    modules.append((plugin, self._module(plugin, loader)))
        # A hook of a plugin that is down is no misspelt one.
        sure = len(modules) == len(self.plugins)
        for plugin, module in modules:  # after all of them: one may have a hook another answers
            with self._blamed(plugin):
                self._ask_all(plugin, module, sure)
            for kind, offers in plugin.offers.items():
                for name, target in offers.items():
                    self._add(kind, Offer(name, plugin, target))
        for kind, words in _WORDS.items():
            for name, offer in self._offers[kind].items():
                words.enter(name, offer.target)

    @contextmanager
    def _blamed(self, plugin: Plugin) -> Iterator[None]:
        """Note what a plugin's code raises and how long it takes; it may raise anything."""
        start = time.perf_counter()
        try:
            yield
        except Exception as error:  # the rest must go on
            raised = error.error if isinstance(error, Broken) else error
            plugin.error = why(raised) + stale(raised, plugin.package)
            plugin.offers.clear()
        plugin.import_ms += 1e3 * (time.perf_counter() - start)

    def _module(self, plugin: Plugin, loader: Callable[[], ModuleType]) -> ModuleType:
        with foreign_code(plugin.name, plugin.label):
            module = loader()
        others = [p for p in self.plugins[:-1] if p.name == plugin.name and not p.error]
        if others:
            raise PluginError(
                f"package {others[0].package} has a plugin of this name already; "
                "give the entry point another"
            )
        own = getattr(module, "hookspecs", None)
        if isinstance(own, ModuleType):
            self._add_hooks(own)
        return module

    def _add_hooks(self, module: ModuleType) -> None:
        """Take the hooks that stand in a module, for all plugins to answer."""
        answers = {n: getattr(f, f"{GROUP}_answer", None) for n, f in vars(module).items()}
        found = {n.removeprefix(f"{GROUP}_"): a for n, a in answers.items() if a is not None}
        taken = [kind for kind in found if kind in self._hooks]
        if taken:
            raise PluginError(f"there is a hook {GROUP}_{taken[0]} already; give it another name")
        if found:
            self._manager.add_hookspecs(module)
        self._hooks |= found
        self._offers |= {kind: {} for kind in found}

    def _ask_all(self, plugin: Plugin, module: ModuleType, sure: bool) -> None:
        check_hooks(module, (f"{GROUP}_{kind}" for kind in self._hooks), hookspecs.PROJECT, sure)
        self._manager.register(module, plugin.name)
        with foreign_code(plugin.name, plugin.label):
            for kind in self._hooks:
                plugin.offers[kind] = self._ask(module, kind)

    def _ask(self, module: ModuleType, kind: str) -> dict[str, Any]:
        hook = getattr(self._manager.hook, f"{GROUP}_{kind}")
        answers = [i.function() for i in hook.get_hookimpls() if i.plugin is module]
        if not answers:
            return {}
        hook_name, wanted = f"hook {GROUP}_{kind}", self._hooks[kind]
        if not isinstance(answers[0], Mapping):
            raise PluginError(f"{hook_name} must return a mapping, got {shown(answers[0])}")
        for name, target in answers[0].items():
            if not isinstance(name, str) or not name:
                raise PluginError(f"{hook_name}: a name must be a text, got {shown(name)}")
            if wanted.endings and not (name.startswith(".") and name.islower()):
                told = "a name must be the ending of files' names in small letters"
                raise PluginError(f"{hook_name}: {told}, such as '.csv', got {shown(name)}")
            if not isinstance(target, wanted.types):
                raise PluginError(f"{hook_name}: {name!r} is {shown(target)}, {wanted.wanted}")
        return dict(answers[0])

    def _add(self, kind: str, offer: Offer) -> None:
        taken = self._offers[kind].get(offer.name)
        if taken is None:
            self._offers[kind][offer.name] = offer
            return
        clash = (
            f"{singular(kind)} {offer.name!r} of {offer.plugin.label} is refused: "
            f"{taken.plugin.label} has it already"
        )
        self.clashes.append(clash)
        offer.plugin.offers[kind] = {
            n: t for n, t in offer.plugin.offers[kind].items() if n != offer.name
        }

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of things that plugins offer: of the core's hooks first, then of theirs."""
        return tuple(self._hooks)

    def is_imported(self, kind: str) -> bool:
        """Return whether what is offered of a kind is named by import string."""
        return self._hooks[kind].imported

    def names(self, kind: str) -> list[str]:
        """Return the sorted names of all offers of a kind (``steps``, ``pipelines``, …)."""
        return sorted(self._offers.get(kind, ()))

    def offered(self, kind: str) -> list[Offer]:
        """Return all offers of a kind, the project's own first, as their plugins have them."""
        return [*self._offers.get(kind, {}).values()]

    def offer(self, kind: str, name: str) -> Offer:
        """Return one offer.

        Raises
        ------
        UsageError
            If nothing of that name is offered; says what is near, and which plugins are down.
        """
        try:
            return self._offers[kind][name]
        except KeyError:  # of the name, or of the kind where the plugin whose hook it is is down
            raise UsageError(self.unknown(kind, name)) from None

    def unknown(self, kind: str, name: str) -> str:
        """Return the text that says a name is not on offer, with what is near."""
        names = self.names(kind)
        text = f"no {singular(kind)} named {name!r}{did_you_mean(name, names)}"
        if not did_you_mean(name, names):
            text += f"; there are: {one_of(names)}"
        return text + self.missing_plugins()

    def missing_plugins(self) -> str:
        """Return the words that say which plugins offer nothing, and why; "" if all do."""
        text = ""
        for what, names in (
            ("failed to load", [p.name for p in self.plugins if p.error]),
            ("blocked", [p.name for p in self.plugins if p.blocked]),
        ):
            text += f" (plugins {what}: {', '.join(names)})" if names else ""
        return text

    def reader(self) -> str | None:
        """Return the first step offered that reads recordings, None if there is none."""
        return next(iter(self._offers["readers"]), None)

    def has(self, kind: str, name: str) -> bool:
        """Return whether something of that kind and name is on offer."""
        return name in self._offers.get(kind, ())

    def load(self, kind: str, name: str) -> Any:
        """Return the thing itself, imported if it was offered by import string.

        Raises
        ------
        PluginError
            If it cannot be imported, or is not what the hook asks for.
        """
        offer = self.offer(kind, name)
        if isinstance(offer.target, str):
            offer.target = _import(offer)
            self._hold_against_hook(kind, offer)
        return offer.target

    def _hold_against_hook(self, kind: str, offer: Offer) -> None:
        module, _, wanted = self._hooks[kind].record.partition(":")
        record = getattr(importlib.import_module(module), wanted) if module else object
        if not isinstance(offer.target, record):
            raise PluginError(
                f"{singular(kind)} {offer.name!r} of {offer.plugin.label} must be a {wanted}, "
                f"got {shown(offer.target)}"
            )

    def step(self, name: str) -> Signature:
        """Return what the step of that name needs and gives; imports its module."""
        if name not in self._signatures:
            from tactile_graph.steps.checks import check_signature
            from tactile_graph.steps.signature import read_signature

            target = self.load("steps", name)
            try:
                signature = read_signature(name, target)
                check_signature(signature)
            except PluginError as error:
                plugin = self.offer("steps", name).plugin
                of = f"(plugin {plugin.name!r}, package {plugin.package})"
                raise PluginError(f"{error} {of}") from None
            self._signatures[name] = signature
        return self._signatures[name]

    def path(self, kind: str, name: str) -> Path:
        """Return the file of a pipeline, pad, preset or scene."""
        return Path(self.offer(kind, name).target)


def _import(offer: Offer) -> Any:
    module_name, _, attribute = str(offer.target).partition(":")
    where = f"{offer.name!r} of {offer.plugin.label}"
    if not module_name or not attribute:
        raise PluginError(f"{where}: {offer.target!r} is no import string 'module:name'")
    try:
        with foreign_code(offer.plugin.name, where):
            module = importlib.import_module(module_name)
    except Broken as broken:
        error = broken.error
        raise PluginError(f"{where}: cannot import {module_name}: {why(error)}") from error
    try:
        return getattr(module, attribute)
    except AttributeError:
        hint = did_you_mean(attribute, vars(module))
        raise PluginError(f"{where}: {module_name} has no {attribute!r}{hint}") from None


def core() -> ModuleType:
    """Return the module in which the core answers its own hooks."""
    return importlib.import_module("tactile_graph.plugins.core")


def found_plugins() -> list[Row]:
    """Return the core and the installed entry points, sorted, the project's own first."""

    packages: dict[int, tuple[str, str]] = {}

    def package(entry: EntryPoint) -> tuple[str, str]:
        # Each look at a name or version parses the package's whole metadata anew.
        dist = entry.dist
        if dist is None:
            return ("", "")
        if id(dist) not in packages:
            packages[id(dist)] = (dist.name, dist.version)
        return packages[id(dist)]

    def place(entry: EntryPoint) -> tuple[bool, str, str]:
        name = package(entry)[0]
        return (name != OWN, entry.name, name)

    found = sorted(set(entry_points(group=GROUP)), key=place)
    own = next((package(e) for e in found if package(e)[0] == OWN), (OWN, ""))
    return [(CORE, *own, core), *((e.name, *package(e), e.load) for e in found)]


_override: str | None = None


def restrict(selection: str) -> None:
    """Restrict or block plugins for this process; ``selection`` as in `Selection`."""
    global _override
    _override = selection
    installed.cache_clear()


def selected() -> str:
    """Return what restricts or blocks plugins of this process; empty if nothing does."""
    return os.environ.get(ENVIRONMENT, "") if _override is None else _override


@cache
def installed() -> Registry:
    """Return the registry of this environment's plugins; found once per process."""
    return Registry(found_plugins(), Selection.parse(selected()))
