"""``Runner``: a plan made ready to run, with the state of its stateful steps."""

from __future__ import annotations

import sys
from typing import Generic, TypeVar

from tactile_graph.engine.calls import Call, make_call
from tactile_graph.engine.context import Context, RunInner
from tactile_graph.engine.outcomes import INNER, ITEM_FAILURES, Outcomes, blank_state
from tactile_graph.engine.plan import Plan, make_plan
from tactile_graph.engine.program import make_program
from tactile_graph.engine.step_operation import step_label
from tactile_graph.engine.watched import watched
from tactile_graph.errors import RuleError
from tactile_graph.pipeline.facts import quantity_trouble
from tactile_graph.pipeline.graph import FrameRule, Graph, Node
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import Image

ResultT = TypeVar("ResultT", bound=Outcomes)


class Runner(Generic[ResultT]):
    """Call it with a frame, get the result; stateful steps keep their state between calls.

    Parameters
    ----------
    pipeline : Graph
    asked : tuple of str
        Nodes or ``node.field`` to ask for.
    seed : int
        Seed of the steps that take randomness.
    result : type
        What a frame's outcomes are handed out as.
    verify : bool
        Whether steps that write into what they share fail; costs time.
    """

    def __init__(
        self,
        pipeline: Graph,
        asked: tuple[str, ...],
        seed: int,
        result: type[ResultT],
        verify: bool = False,
    ) -> None:
        self.plan: Plan = make_plan(pipeline, asked or tuple(pipeline.outputs))
        self._result = result
        self._context = Context(seed, self._embedded)
        self._blank = blank_state(self.plan.n_slots)
        self._verify = verify
        self._operations = make_program(self.plan, self._call, self._blank)
        self._repeatable = self.plan.repeatable
        self._image = self.plan.image
        self._last: tuple[bytes, ResultT] | None = None
        self._shape: tuple[int, ...] = ()
        self._quantity = ""
        # Rules about numbers (shape, pitch) are rare: where there are any, every frame is checked.
        self._rules = any(r.quantity is None for r in self.plan.rules)
        _make_room(self.plan.depth)

    @property
    def stateful(self) -> bool:
        """Whether a step keeps something from frame to frame."""
        return self.plan.stateful

    def repeats(self, frame: Frame) -> bool:
        """Return whether the frame would reuse the last one's result."""
        last = self._last
        image = frame.image
        return (
            last is not None
            and image.values.tobytes() == last[0]
            and _alike(image, last[1].frame.image)
        )

    def forget(self) -> None:
        """Forget the last frame: the next one is computed, whatever it holds."""
        self._last = None

    def _call(self, node: Node) -> Call:
        call = make_call(node, self._context)
        return watched(call, step_label(node)) if self._verify else call

    def _embedded(self, pipeline: Graph) -> RunInner:
        """Return what runs a pipeline that a node of this one runs over a list."""
        inner = Runner(pipeline, (), self._context.seed, self._result, self._verify)

        def run(frame: Frame, item: tuple[int, ...]) -> Outcomes:
            inner._context.item = item  # or every item would draw the same numbers
            return inner(frame)

        return run

    def __call__(self, frame: Frame) -> ResultT:
        """Return the result for the frame.

        Raises
        ------
        RuleError
            If the frame's quantity, shape or pitch breaks a rule of a step.
        """
        image = frame.image
        values = image.values
        if values.shape != self._shape or image.quantity != self._quantity or self._rules:
            check_frame(image, self.plan)
            self._shape, self._quantity = values.shape, image.quantity
        if self._repeatable:
            content = values.tobytes()
            last = self._last
            if last is not None and content == last[0] and _alike(image, last[1].frame.image):
                return last[1].again(frame)
        context = self._context
        context.frame = frame
        state = self._blank.copy()
        state[self._image] = image  # where nothing reads it, the frame takes its place
        state[0] = frame
        for settle in self._operations:
            settle(state)
        if context.inner_results:
            state[INNER] = context.inner_results
            context.inner_results = {}
        if context.item_failures:
            state[ITEM_FAILURES] = context.item_failures
            context.item_failures = []
        result = self._result(self.plan, state)
        if self._repeatable:
            self._last = content, result  # only now: an interrupted frame leaves nothing to reuse
        return result


def _alike(image: Image, last: Image) -> bool:
    """Return whether two images of equal bytes are equal in everything else."""
    if image is last:
        return True
    valid, last_valid = image.valid, last.valid
    return (
        image.values.dtype == last.values.dtype
        and image.values.shape == last.values.shape
        and image.pitch_cm == last.pitch_cm
        and image.origin_cm == last.origin_cm
        and image.quantity == last.quantity
        and (
            valid is last_valid
            or (valid is not None and last_valid is not None and bool((valid == last_valid).all()))
        )
    )


def check_frame(image: Image, plan: Plan) -> None:
    """Check the rules that only a frame can settle.

    Raises
    ------
    RuleError
        Naming each node, its step, what is allowed and what came.
    """
    if image.values.ndim != 2 or 0 in image.values.shape:
        raise RuleError(f"a frame holds values of shape (rows, columns), got {image.values.shape}")
    troubles = [(rule.node, trouble) for rule in plan.rules if (trouble := _broken(rule, image))]
    if troubles:
        lines = [f"node {node!r}: {trouble}" for node, trouble in troubles]
        raise RuleError(f"pipeline {plan.pipeline.name!r}, " + "\n  ".join(dict.fromkeys(lines)))


def _broken(rule: FrameRule, image: Image) -> str:
    came = rule.came.get(image.quantity)
    if came is None:
        return ""
    if rule.quantity is not None:
        return quantity_trouble(rule, came, image.quantity)
    rows, columns = image.shape
    if (rule.rows or rows) != rows or (rule.columns or columns) != columns:
        wanted = f"{rule.rows or 'any'} x {rule.columns or 'any'}"
        return f"step {rule.step!r} takes {wanted} cells, got a frame of {rows} x {columns}"
    if rows < rule.min_rows or columns < rule.min_columns:
        wanted = f"{rule.min_rows} x {rule.min_columns}"
        return (
            f"step {rule.step!r} takes at least {wanted} cells, got a frame of {rows} x {columns}"
        )
    pitch = rule.pitch_cm
    if pitch is not None and any(abs(p - pitch) > 1e-6 * pitch for p in image.pitch_cm):
        return f"step {rule.step!r} takes a pitch of {pitch} cm, got a frame of {image.pitch_cm} cm"
    return ""


def _make_room(depth: int) -> None:
    """Let lazy blocks nest as deep as the plan does; each level takes up to four calls."""
    needed = 4 * depth + 1000
    if depth > 100 and sys.getrecursionlimit() < needed:
        sys.setrecursionlimit(needed)
