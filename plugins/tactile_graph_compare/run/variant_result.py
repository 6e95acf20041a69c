"""Read a merged result as one variant alone would have it: in its names, with what it needed."""

from __future__ import annotations

from typing import Any

from tactile_graph.api.result import Result
from tactile_graph.engine.outcome import NO_VALUE, NOT_ASKED, Failed, Skipped
from tactile_graph.pipeline.graph import FRAME, Node
from tactile_graph.pipeline.wiring import Ref
from tactile_graph_compare.variants.merge import Member

NOT_SETTLED, RAN, SKIPPED, FAILED = range(4)
"""As `graph_records.STATES` names them."""


class OwnResult:
    """One frame's merged result, seen from one variant.

    Parameters
    ----------
    result : Result
        Of the merged pipeline.
    member : Member
    """

    def __init__(self, result: Result, member: Member) -> None:
        self.result = result
        self.member = member
        self._nodes = member.pipeline.nodes

    # -- values ------------------------------------------------------------------------------

    def merged_outcome(self, ref: Ref) -> Any:
        """Return the outcome of what the variant reads at ``ref``, in merged names."""
        return self.result.outcome_at(self.member.ref(ref))

    def asked_ref(self, name: str) -> Ref:
        """Return the reference of an output, or of a node or field asked for."""
        pipeline = self.member.pipeline
        return pipeline.outputs.get(name) or pipeline.ref(name)

    def outcome(self, name: str) -> Any:
        """Return the outcome of an output or node, as the variant alone would give it."""
        ref = self.asked_ref(name)
        return NOT_ASKED if ref.node not in self.member.names else self.outcome_at(ref)

    def outcome_at(self, ref: Ref) -> Any:
        """Return the outcome at a reference, skips and failures in the variant's own names."""
        found = self.merged_outcome(ref)
        if found.__class__ is Skipped:
            origin = self._origin_at(ref, found)
            return Skipped(origin, self._reason(found, origin))
        if found.__class__ is Failed:
            origin = self._origin_at(ref, found)
            step = found.step
            if step.startswith("when "):
                step = f"when {self._guard_text(origin)}"
            return Failed(origin, found.error, found.where, found.inputs, step)
        if getattr(found, "_fields", ()) and any(v.__class__ is Skipped for v in found):
            return self._in_own_names(ref, found)
        return found

    def _in_own_names(self, ref: Ref, record: Any) -> Any:
        """Return the outputs of a pipeline run over a list; some may have come out skipped."""
        return record._replace(
            **{
                name: Skipped(ref.node, value.reason)
                for name, value in zip(record._fields, record, strict=True)
                if value.__class__ is Skipped
            }
        )

    # -- where a skip or failure began ---------------------------------------------------------

    def _origin_at(self, ref: Ref, found: Any) -> str:
        if not ref.whole and found.origin == str(self.member.ref(ref)):
            return str(ref)
        return self._origin_of(ref.node, found)

    def _origin_of(self, name: str, found: Any) -> str:
        """Follow an outcome back: it is handed on from wire to node as the same object."""
        if name == FRAME or found.origin == self.member.names[name]:
            return name
        node = self._nodes[name]
        for ref in _deciding(node, found):
            if self.merged_outcome(ref) is found:
                return self._origin_at(ref, found)
        for binding in node.inputs:
            if binding.collects and binding.port.required:
                first: Any = self.merged_outcome(binding.refs[0])
                if isinstance(first, Skipped | Failed) and first.origin == found.origin:
                    return self._origin_at(binding.refs[0], first)
        return str(found.origin)  # of a pipeline run over a list: its own name

    def _guard_text(self, origin: str) -> str:
        node = self._nodes.get(origin)
        return node.guard.text if node is not None and node.guard is not None else ""

    def _reason(self, found: Skipped, origin: str) -> str:
        reason = found.reason
        node = self._nodes.get(origin)
        if node is not None and node.guard is not None:
            values = tuple(self.merged_outcome(r) for r in node.guard.refs)
            merged = self.result.plan.pipeline.nodes[self.member.names[origin]].guard
            # The guard is one, but each variant has its own words for it.
            if merged is not None and reason == merged.reason(values):
                return node.guard.reason(values)
        return f"{origin} is not known" if reason == f"{found.origin} is not known" else reason

    # -- what the variant alone would have run -------------------------------------------------

    def states(self) -> dict[str, int]:
        """Return what each of the variant's nodes came to; those not named were not needed."""
        found: dict[str, int] = {FRAME: RAN}
        for ref in self.member.asked:
            self._settle(ref.node, found)
        del found[FRAME]
        return found

    def _settle(self, name: str, found: dict[str, int]) -> None:
        if name in found:
            return
        found[name] = NOT_SETTLED  # no way back here: the graph has no cycle
        node = self._nodes[name]
        if node.guard is not None:
            for ref in node.guard.refs:
                self._settle(ref.node, found)
            stopped = self._guard(node)
            if stopped:
                found[name] = stopped
                return
        if node.choices:
            self._settle_choices(node, found)
        else:
            self._settle_inputs(node, found)
        outcome = self.merged_outcome(Ref(name))
        found[name] = (
            SKIPPED if outcome.__class__ is Skipped
            else FAILED if outcome.__class__ is Failed else RAN
        )  # fmt: skip

    def _guard(self, node: Node) -> int:
        """Return how a guard stopped its node; 0 if it holds."""
        assert node.guard is not None
        values = [self.merged_outcome(r) for r in node.guard.refs]
        for value in values:
            if value.__class__ in NO_VALUE:
                return SKIPPED if value.__class__ is Skipped else FAILED
        try:
            return 0 if node.guard.function(*values) else SKIPPED
        except Exception:  # as the engine has it: the node failed
            return FAILED

    def _settle_choices(self, node: Node, found: dict[str, int]) -> None:
        for ref in node.choices:
            self._settle(ref.node, found)
            if self.merged_outcome(ref).__class__ not in NO_VALUE:
                return

    def _settle_inputs(self, node: Node, found: dict[str, int]) -> None:
        for binding in node.inputs:
            for ref in binding.refs:
                self._settle(ref.node, found)
            if binding.port.required and self._lacks(binding.refs):
                return

    def _lacks(self, refs: tuple[Ref, ...]) -> bool:
        """Return whether a port came out skipped: the engine then looks at no port behind it."""
        kinds = [self.merged_outcome(r).__class__ for r in refs]
        return Failed not in kinds and all(k is Skipped for k in kinds)


def _deciding(node: Node, found: Any) -> list[Ref]:
    """Return what may have handed an outcome on to a node, the one that decides first."""
    guard = list(node.guard.refs) if node.guard is not None else []
    if found.__class__ is Failed:
        return node.wires()
    required = [r for b in node.inputs if b.port.required for r in b.refs]
    return [*guard, *required, *reversed(node.choices)]
