"""Find the installed plugins and keep what they offer, loading a step only when it is used."""

from __future__ import annotations

import importlib
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache, cached_property
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import pluggy

from tactile_graph.errors import PluginError, UsageError, did_you_mean, shown
from tactile_graph.plugins import hookspecs
from tactile_graph.plugins.foreign_code import Broken, foreign_code
from tactile_graph.plugins.mistakes import check_hooks, stale, why
from tactile_graph.plugins.names import OWN, Names, Offer, Plugin, check_name, singular
from tactile_graph.vocabulary import QUANTITIES, UNITS, Vocabulary

if TYPE_CHECKING:
    from tactile_graph.steps.signature import Signature

GROUP = "tactile_graph"
ENVIRONMENT = "TACTILE_GRAPH_PLUGINS"
Row = tuple[str, str, str, Callable[[], ModuleType]]
"""A plugin to be: its name, its package, that one's version, and what imports its module."""
_WORDS: dict[str, Vocabulary] = {"quantities": QUANTITIES, "units": UNITS}
CORE = "core"
"""The plugin that the core itself is: nothing goes without it, so no selection leaves it out."""


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
        self._hooks: dict[str, hookspecs.Answer] = {}
        self._offers: dict[str, Names] = {}
        self._signatures: dict[str, Signature] = {}
        self._manager = pluggy.PluginManager(hookspecs.PROJECT)
        self._add_hooks(hookspecs)
        allowed = selection or Selection()
        modules = []
        rows = [*plugins]
        owners: dict[str, list[str]] = {}
        for name, package, *_ in rows:
            owners.setdefault(name, []).append(package)
        for name, package, version, loader in rows:
            plugin = Plugin(name, package, version, blocked=not allowed.allows(name))
            self.plugins.append(plugin)
            if not plugin.blocked:
                with self._blamed(plugin):
                    check_name(plugin, owners[name])
                    modules.append((plugin, self._module(plugin, loader)))
        # A hook of a plugin that is down is no misspelt one.
        sure = len(modules) == len(self.plugins)
        for plugin, module in modules:  # after all of them: one may have a hook another answers
            with self._blamed(plugin):
                self._ask_all(plugin, module, sure)
            for kind, offers in plugin.offers.items():
                for name, target in offers.items():
                    self._offers[kind].add(Offer(name, plugin, target))
        for kind, words in _WORDS.items():
            for offer in (self.offer(kind, name) for name in self.offered(kind)):
                if self._of(kind).spelled(offer) == offer.name:
                    words.enter(offer.name, offer.target)

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
        self._offers |= {kind: Names(kind) for kind in found}

    def _ask_all(self, plugin: Plugin, module: ModuleType, sure: bool) -> None:
        check_hooks(module, (f"{GROUP}_{kind}" for kind in self._hooks), hookspecs.PROJECT, sure)
        self._manager.register(module, plugin.name)
        with foreign_code(plugin.name, plugin.label):
            for kind in self._hooks:
                plugin.offers[kind] = self._ask(module, kind)
        for name in plugin.offers["isolated"]:
            if name not in plugin.offers["steps"]:
                hint = did_you_mean(name, plugin.offers["steps"])
                raise PluginError(f"hook {GROUP}_isolated: it has no step {name!r}{hint}")

    def _ask(self, module: ModuleType, kind: str) -> dict[str, Any]:
        hook = getattr(self._manager.hook, f"{GROUP}_{kind}")
        impls = [i for i in hook.get_hookimpls() if i.plugin is module]
        # A wrapper goes around what others answer: nothing of its own where there is an answer.
        plain = [i for i in impls if not (i.wrapper or i.hookwrapper)] or impls
        found: dict[str, Any] = {}
        functions = dict.fromkeys(i.function for i in plain)
        for function in functions:  # a module may answer a hook more than once
            answer = self._checked(kind, function())
            for name in answer:
                if name in found:
                    raise PluginError(f"hook {GROUP}_{kind}: {name!r} is offered twice")
            found |= answer
        return found

    def _checked(self, kind: str, answer: Any) -> Mapping[str, Any]:
        """Return an answer to a hook, which is held against what the hook wants."""
        hook_name, wanted = f"hook {GROUP}_{kind}", self._hooks[kind]
        if not isinstance(answer, Mapping):
            raise PluginError(f"{hook_name} must return a mapping, got {shown(answer)}")
        for name, target in answer.items():
            if not isinstance(name, str) or not name:
                raise PluginError(f"{hook_name}: a name must be a text, got {shown(name)}")
            if wanted.endings and not (name.startswith(".") and name.islower()):
                told = "a name must be the ending of files' names in small letters"
                raise PluginError(f"{hook_name}: {told}, such as '.csv', got {shown(name)}")
            if not isinstance(target, wanted.types):
                raise PluginError(f"{hook_name}: {name!r} is {shown(target)}, {wanted.wanted}")
        return answer

    @property
    def clashes(self) -> list[str]:
        """What is to be told of names that several plugins offer, a line each."""
        return [told for names in self._offers.values() for told in names.clashes]

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of things that plugins offer: of the core's hooks first, then of theirs."""
        return tuple(self._hooks)

    def is_imported(self, kind: str) -> bool:
        """Return whether what is offered of a kind is named by import string."""
        return self._hooks[kind].imported

    def names(self, kind: str) -> list[str]:
        """Return the sorted names of all offers of a kind (``steps``, ``pipelines``, …).

        They are plain, but for those that several plugins offer, which are qualified.
        """
        return sorted(self._of(kind))

    def offered(self, kind: str) -> list[str]:
        """Return the names of all offers of a kind, in the order of the plugins."""
        return [*self._of(kind)]

    def _of(self, kind: str) -> Names:
        """Return what is offered of a kind; nothing where the plugin whose hook it is is down."""
        return self._offers.get(kind, Names(kind))

    def spelled(self, kind: str, name: str, file: str = "") -> str:
        """Return the shortest name of what a name means, which no other plugin's is called."""
        return self._of(kind).spelled(self.offer(kind, name, file))

    def offer(self, kind: str, name: str, file: str = "") -> Offer:
        """Return one offer.

        Parameters
        ----------
        kind, name : str
            The name plain, or qualified by the plugin: ``filters.median``.
        file : str, optional
            The pipeline file it is named in: one that a plugin offers means its own package's.

        Raises
        ------
        UsageError
            If nothing of that name is offered, or by several; says what is near, and which plugins
            are down.
        """
        names = self._of(kind)
        try:
            found = names.find(name)
        except UsageError:
            found = names.find(name, self._packages.get(os.path.abspath(file), "") if file else "")
        if found is None:
            raise UsageError(self.unknown(kind, name))
        return found

    @cached_property
    def _packages(self) -> dict[str, str]:
        """Package of each pipeline file on offer."""
        offers = (self.offer("pipelines", name) for name in self.names("pipelines"))
        return {os.path.abspath(o.target): o.plugin.package for o in offers}

    def unknown(self, kind: str, name: str) -> str:
        """Return the text that says a name is not on offer, with what is near, or why not."""
        head, dot, _ = name.partition(".")
        called = [p for p in self.plugins if dot and p.name == head]
        if called and all(p.error for p in called):
            told = f"plugin {head!r} failed to load: {called[0].error}"
            return f"no {singular(kind)} named {name!r}: {told}"
        return self._of(kind).unknown(name) + self.missing_plugins()

    def missing_plugins(self) -> str:
        """Return the words that say which plugins offer nothing, and why; "" if all do."""
        text = ""
        for what, names, more in (
            ("failed to load", [p.name for p in self.plugins if p.error],
             "; 'tactile-graph plugins' says why"),
            ("blocked", [p.name for p in self.plugins if p.blocked], ""),
        ):  # fmt: skip
            told = ", ".join(dict.fromkeys(names))
            text += f" (plugins {what}: {told}{more})" if names else ""
        return text

    def reader(self) -> str | None:
        """Return the first step offered that reads recordings, None if there is none."""
        return next(iter(self._of("readers")), None)

    def has(self, kind: str, name: str) -> bool:
        """Return whether something of that kind and name is on offer."""
        return name in self._of(kind)

    def load(self, kind: str, name: str) -> Any:
        """Return the thing itself, imported if it was offered by import string.

        Raises
        ------
        PluginError
            If it cannot be imported, or is not what the hook asks for.
        """
        return self._loaded(kind, self.offer(kind, name))

    def _loaded(self, kind: str, offer: Offer) -> Any:
        if isinstance(offer.target, str):
            target = _import(offer)
            self._hold_against_hook(kind, offer, target)
            offer.target = target
        return offer.target

    def _hold_against_hook(self, kind: str, offer: Offer, target: Any) -> None:
        module, _, wanted = self._hooks[kind].record.partition(":")
        record = getattr(importlib.import_module(module), wanted) if module else object
        if not isinstance(target, record):
            ours = module.startswith(f"{__package__.partition('.')[0]}.")
            raise PluginError(
                f"{singular(kind)} {offer.name!r} of {offer.plugin.label} must be a "
                f"{wanted if ours else f'{module}.{wanted}'}, got {shown(target)}"
            )

    def step(self, name: str, file: str = "") -> Signature:
        """Return what a step needs and gives; imports its module. Parameters as of `offer`."""
        offer = self.offer("steps", name, file)
        if offer.qualified not in self._signatures:
            from tactile_graph.steps.checks import check_signature
            from tactile_graph.steps.signature import read_signature

            target = self._loaded("steps", offer)
            try:
                signature = read_signature(self._offers["steps"].spelled(offer), target)
                check_signature(signature)
            except PluginError as error:
                of = f"(plugin {offer.plugin.name!r}, package {offer.plugin.package})"
                raise PluginError(f"{error} {of}") from None
            self._signatures[offer.qualified] = replace(signature, identity=offer.identity)
        return self._signatures[offer.qualified]

    def path(self, kind: str, name: str, file: str = "") -> Path:
        """Return the file of a pipeline, pad, preset or scene; parameters as of `offer`."""
        return Path(self.offer(kind, name, file).target)


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


def installed_and(steps: Mapping[str, str | Callable[..., Any]]) -> Registry:
    """Return a registry of this environment's plugins and of steps given by their names.

    They are a plugin ``own``: where another offers a step of the same name, ``own.NAME`` is this.
    """

    @hookspecs.hookimpl
    def tactile_graph_steps() -> Mapping[str, str | Callable[..., Any]]:
        return dict(steps)

    given = ModuleType("own")
    vars(given)["tactile_graph_steps"] = tactile_graph_steps
    return Registry([*found_plugins(), ("own", "given", "", lambda: given)],
                    Selection.parse(selected()))  # fmt: skip
