"""Turn a declaration into a frozen graph: steps, settings, wires, types, rules, guards."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from numpy.random import default_rng

from tactile_graph.errors import (
    Mark,
    PluginError,
    Problem,
    TactileGraphError,
    UsageError,
)
from tactile_graph.pipeline.bind import bind_inputs
from tactile_graph.pipeline.checks import check_conditions, check_overrides
from tactile_graph.pipeline.conditions import Guard, compile_condition
from tactile_graph.pipeline.declaration import Declaration, NodeDeclaration
from tactile_graph.pipeline.facts import (
    output_facts,
    source_facts,
    step_troubles,
)
from tactile_graph.pipeline.node import FRAME, Binding, Facts, Node, NodeKind, node_key
from tactile_graph.pipeline.order import resolvable_order
from tactile_graph.pipeline.pipeline import Pipeline, Source, plain
from tactile_graph.pipeline.references import ConditionError, resolve_reference
from tactile_graph.pipeline.scope import Scope
from tactile_graph.pipeline.use import resolve_use
from tactile_graph.pipeline.wiring import UNKNOWN, Ref, common_type
from tactile_graph.plugins.mistakes import why
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.settings import Trouble, spelled, validate_settings
from tactile_graph.steps.signature import Kind, Signature

Overrides = Mapping[str, Mapping[str, Any]]
"""Node name -> settings that replace the file's."""

Loader = Callable[[str, Overrides], Pipeline]
"""Loads the pipeline a ``use`` names, with overrides for its nodes."""


class Resolver:
    """Resolves one declaration; problems go to its document.

    Parameters
    ----------
    declaration : Declaration
    registry : Registry
    load : Loader
        For ``use``.
    overrides : mapping
        Node name -> settings from outside (``--set``, ``with_settings``, ``use … with``).
    source : tuple of (step name, settings), optional
        Replaces the file's source.
    embedded : bool
        Whether another pipeline uses it: its frames are then not those of its own source.
    """

    def __init__(
        self,
        declaration: Declaration,
        registry: Registry,
        load: Loader,
        overrides: Overrides | None = None,
        source: tuple[str, dict[str, Any]] | None = None,
        embedded: bool = False,
    ) -> None:
        self.declaration = declaration
        self.document = declaration.document
        self.registry = registry
        self.load = load
        self.overrides = {k: dict(v) for k, v in (overrides or {}).items()}
        self.replaced_source = source
        self.embedded = embedded
        self.scope = Scope()
        self.condition_errors: list[tuple[NodeDeclaration, ConditionError]] = []

    def resolve(self) -> Pipeline:
        """Return the pipeline; it is only fit to run if the document has no problems."""
        source = self._source()
        self.scope.facts[FRAME] = source_facts(None if self.embedded else source)
        order, cycles = resolvable_order(self.declaration)
        for loop in cycles:
            text = f"the nodes form a cycle: {' -> '.join(loop)}"
            self.document.problem(text, "nodes", loop[0], key=True)
            self.scope.types.update(dict.fromkeys(loop, UNKNOWN))
        for name in order:
            declared = self.declaration.nodes[name]
            try:
                self._node(declared)
            except TactileGraphError as error:
                self.problem(declared, str(error))
                self.scope.types.setdefault(name, UNKNOWN)
        check_conditions(self)
        check_overrides(self)
        outputs = self._outputs()
        d = self.declaration
        return Pipeline(
            name=d.name, about=d.about, evolves=d.evolves, source=source,
            nodes=self.scope.nodes, outputs=outputs, file=self.document.file,
            text=self.document.text, frame_rules=tuple(self.scope.rules),
            overrides=self.overrides, source_override=self.replaced_source,
        )  # fmt: skip

    def problem(
        self, node: NodeDeclaration, message: str, *path: str | int, key: bool = False
    ) -> None:
        """Note what is wrong with a node, at a place within it."""
        self.document.problem(
            f"node {node.name!r}{message_join(message)}", *node.path, *path, key=key
        )

    # -- source ------------------------------------------------------------------------------

    def _source(self) -> Source | None:
        d = self.declaration
        step, given = d.source_step, d.source_settings
        mark = self.document.mark("source", "step")
        if self.replaced_source is not None:
            step, given = self.replaced_source
        if step is None:
            return None
        try:
            signature = self.registry.step(step)
        except (UsageError, PluginError) as error:
            self.document.problem(f"source: {error}", "source", "step")
            return None
        if signature.kind is not Kind.SOURCE:
            text = f"source: step {step!r} is no source: it yields no frames"
            self.document.problem(text, "source", "step")
            return None
        values, troubles = validate_settings(signature, given)
        for path, message in troubles:
            where = f"{spelled(path)}: " if path else ""
            self.document.problem(f"source, {where}{message}", "source", "with", *path)
        return Source(signature, values, mark)

    # -- nodes -------------------------------------------------------------------------------

    def _node(self, declared: NodeDeclaration) -> None:
        guard = self._guard(declared)
        if declared.first_of is not None:
            self._first_of(declared, guard)
        elif declared.use:
            resolve_use(self, declared, guard)
        elif declared.step:
            self._step(declared, guard)
        else:
            self.scope.types[declared.name] = UNKNOWN

    def _guard(self, declared: NodeDeclaration) -> Guard | None:
        if not declared.when:
            return None
        try:
            d = self.declaration
            return compile_condition(declared.when, self.scope.types, d.conditions, d.nodes)
        except ConditionError as error:
            self.condition_errors.append((declared, error))
            return None

    def mark(self, declared: NodeDeclaration) -> Mark:
        """Return where the file names the node."""
        return self.document.mark(*declared.path, key=True)

    def guard_key(self, guard: Guard | None) -> object:
        """Return what makes two guards equal."""
        return None if guard is None else (guard.meaning, [self.ref_key(r) for r in guard.refs])

    def ref_key(self, ref: Ref) -> tuple[object, ...]:
        """Return what makes two references equal."""
        return (self.scope.keys.get(ref.node, ref.node), ref.path, ref.item_path)

    def ref(self, declared: NodeDeclaration, text: str, *path: str | int) -> tuple[Ref, Any] | None:
        """Return reference and type for ``node.field``, or report what is wrong with it."""
        try:
            known = list(self.declaration.nodes)
            ref, kind = resolve_reference(tuple(text.split(".")), self.scope.types, known)
        except ConditionError as error:
            self.problem(declared, f": {error.message}", *path)
            return None
        return ref, kind

    def _first_of(self, declared: NodeDeclaration, guard: Guard | None) -> None:
        found = [
            self.ref(declared, t, "first_of", i) for i, t in enumerate(declared.first_of or [])
        ]
        choices = tuple(f[0] for f in found if f)
        kind = common_type([f[1] for f in found if f]) if choices else UNKNOWN
        facts = [self.scope.facts.get(c.node, Facts()) for c in choices if not c.path]
        same = facts[0] if len(facts) == len(choices) and len(set(facts)) == 1 else Facts()
        key = node_key("first_of", [self.ref_key(c) for c in choices], self.guard_key(guard))
        self.scope.add(
            Node(declared.name, NodeKind.FIRST_OF, kind, self.mark(declared), choices=choices,
                 guard=guard, facts=same, key=key)
        )  # fmt: skip

    def _settings(self, declared: NodeDeclaration, signature: Signature) -> dict[str, Any]:
        given = {**declared.settings, **self.overrides.get(declared.name, {})}
        values, troubles = validate_settings(signature, given)
        self._report(declared, troubles)
        return values

    def _report(self, declared: NodeDeclaration, troubles: list[Trouble]) -> None:
        outside = self.overrides.get(declared.name, {})
        for path, message in troubles:
            where = f", {spelled(path)}: " if path else ": "
            if path and path[0] in outside:
                text = f"setting {declared.name}.{spelled(path)}: {message}"
                found = Problem(None, text)
                if found not in self.document.problems:
                    self.document.problems.append(found)
            else:
                self.problem(declared, where + message, "with", *path)

    def _step(self, declared: NodeDeclaration, guard: Guard | None) -> None:
        assert declared.step is not None
        try:
            signature = self.registry.step(declared.step)
        except (UsageError, PluginError) as error:
            self.problem(declared, f": {error}", "step")
            self.scope.types[declared.name] = UNKNOWN
            return
        if signature.kind is Kind.SOURCE:
            self.problem(
                declared, f": {declared.step!r} is a source; it belongs under 'source'", "step"
            )
        before = len(self.document.problems)
        settings = self._settings(declared, signature)
        inputs = bind_inputs(self, declared, signature, self.scope.types)
        self._rules(declared, signature, settings, inputs)
        output: Any = signature.output
        if declared.each:
            output = list[output]
            if signature.stateful:
                text = f": a stateful step ({declared.step}) cannot run for each item"
                self.problem(declared, text, "each")
        key = node_key(
            declared.step, sorted(plain(settings).items()), declared.each,
            [(b.port.name, [self.ref_key(r) for r in b.refs]) for b in inputs],
            self.guard_key(guard),
        )  # fmt: skip
        node = Node(
            declared.name, NodeKind.STEP, output, self.mark(declared), signature, settings, inputs,
            guard=guard, each=declared.each, key=key,
            facts=output_facts(signature, settings, inputs, self.scope.facts),
        )  # fmt: skip
        if len(self.document.problems) == before and signature.kind is Kind.CLASS:
            node = self._made(declared, node)
        self.scope.add(node)

    def _made(self, declared: NodeDeclaration, node: Node) -> Node:
        """Build a class step once, so that settings it refuses are an error of the file."""
        try:
            rng = node.signature.rng if node.signature and node.signature.rng_at_init else ""
            return replace(node, callable=node.bound(**{rng: default_rng(0)} if rng else {}))
        except Exception as error:  # a constructor may raise anything about its settings
            told = isinstance(error, TactileGraphError | ValueError) and str(error)
            text = told or f"step {declared.step!r} cannot be made: {why(error)}"
            self.problem(declared, f": {text}", "with")
            return node

    def _rules(
        self,
        declared: NodeDeclaration,
        signature: Signature,
        settings: dict[str, Any],
        inputs: tuple[Binding, ...],
    ) -> None:
        given = {**declared.settings, **self.overrides.get(declared.name, {})}
        troubles, rules = step_troubles(
            declared.name, signature, given, settings, inputs, self.scope.facts
        )
        self.scope.rules += rules
        for port, message in troubles:
            path = ("in", port) if isinstance(declared.inputs, dict) else ("in",)
            self.problem(declared, f": {message}", *path)

    # -- the whole ---------------------------------------------------------------------------

    def _outputs(self) -> dict[str, Ref]:
        outputs: dict[str, Ref] = {}
        for i, text in enumerate(self.declaration.outputs):
            try:
                ref, _ = resolve_reference(tuple(text.split(".")), self.scope.types, [])
            except ConditionError as error:
                self.document.problem(f"output {text!r}: {error.message}", "outputs", i)
                continue
            outputs[text] = ref
        if not outputs and not self.document.problems:
            self.document.problem("'outputs' is empty: nothing is asked for", "outputs")
        return outputs


def message_join(message: str) -> str:
    """Return the message with ``": "`` before it unless it brings its own joint."""
    return message if message[:1] in ",:" else f": {message}"
