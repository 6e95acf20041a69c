"""``Runner``: a plan made ready to run, with the state of its stateful steps."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import chain
from typing import Any, Generic, NoReturn, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph.changes import changes
from tactile_graph.engine.blocks.block import Block, Constant, Group, Repeats, first_settled
from tactile_graph.engine.blocks.blocks import Blocks, worth_blocks
from tactile_graph.engine.calls.calls import Call, make_call
from tactile_graph.engine.calls.context import Context, RunInner
from tactile_graph.engine.calls.isolated import Host, ProcessState
from tactile_graph.engine.calls.watched import watched
from tactile_graph.engine.deadlines.allowed import Deciding
from tactile_graph.engine.deadlines.options import Decider, options_of
from tactile_graph.engine.operations.step_operation import Operation, step_label
from tactile_graph.engine.outcomes.outcome import defined_at
from tactile_graph.engine.outcomes.outcomes import INNER, ITEM_FAILURES, Outcomes, blank_state
from tactile_graph.engine.plan import Plan, make_plan
from tactile_graph.engine.program import make_program
from tactile_graph.errors import Degenerate, RuleError, UsageError
from tactile_graph.pipeline.graph import FrameRule, Graph, Isolation, Node
from tactile_graph.pipeline.named_files.made_of import MadeOf, made_of
from tactile_graph.pipeline.resolution.facts import quantity_trouble
from tactile_graph.shared_process import (
    errors_of_numpy,
    go_away,
    put_right,
    righted,
    steps_at_work,
)
from tactile_graph.steps.rules import square_wanted
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph.wires.image import Image
from tactile_graph.wires.stacks import ImageStack

ResultT = TypeVar("ResultT", bound=Outcomes)
_Equal = tuple[str, Isolation | None, MadeOf | None]
_new = object.__new__


@dataclass(frozen=True)
class RunSettings:
    """How frames are run.

    Parameters
    ----------
    seed : int
        Seed of the steps that take randomness.
    verify : bool
        Whether steps that write into what they share fail; costs time.
    decider : Decider, optional
        Decides for each frame what is left undone; nothing is if not given.
    after : Runner, optional
        Of the same seed, and verified likewise; not called any more once this one is. Nodes of
        equal key, code and files go on with the state they have there.

    Raises
    ------
    UsageError
        If the seed is below 0.
    """

    seed: int = 0
    verify: bool = False
    decider: Decider | None = None
    after: Runner[Any] | None = None

    def __post_init__(self) -> None:
        if self.seed < 0:
            raise UsageError(f"seed: must be a whole number >= 0, got {self.seed}")


class Runner(Generic[ResultT]):
    """Call it with a frame, get the result; stateful steps keep their state between calls.

    They keep one for each label: frames of another recording or sensor find none of its state.

    Parameters
    ----------
    pipeline : Graph
    asked : tuple of str
        Nodes or ``node.field`` to ask for.
    result : type
        What a frame's outcomes are handed out as.
    settings : RunSettings, optional
    """

    def __init__(
        self,
        pipeline: Graph,
        asked: tuple[str, ...],
        result: type[ResultT],
        settings: RunSettings | None = None,
    ) -> None:
        settings = settings or RunSettings()
        decider, before = settings.decider, settings.after
        asked = asked or tuple(pipeline.outputs)
        self.plan: Plan = make_plan(pipeline, asked, ladders_wait=decider is not None)
        self._result = result
        embedded = partial(_embedded, result, settings)
        self._context: Context = (
            Context(settings.seed, embedded) if before is None else before._context
        )
        self._context.hosts = {}  # a process that the runner before uses takes no more steps
        self._apart_before = {} if before is None else before._apart
        self._apart: dict[str, Host] = {}
        self._context.apart = self._apart
        self._blank = blank_state(self.plan.n_slots)
        self._verify = settings.verify
        self._calls: dict[str, Call] = {}
        self._made_of = made_of(pipeline)  # before steps read their files
        self._left = {} if before is None else before._keeping
        self._went_on: set[str] = set()
        self._decider = decider
        deciding = None if decider is None else Deciding(options_of(self.plan), decider)
        if deciding is not None:
            deciding.decider.prepare(deciding.options)
        with righted():
            self._operations = make_program(
                self.plan, self._call, self._blank, deciding=deciding, chained=not settings.verify
            )
        self._left, self._apart_before = {}, {}
        self._repeatable = self.plan.repeatable
        self._image = self.plan.image
        self._last: tuple[bytes, ResultT] | None = None
        self._sure: ResultT | None = None
        self._n_lost = 0
        # All that rules are about: a frame that is as the last one in these keeps them, too.
        self._checked: tuple[tuple[int, ...], str, tuple[float, float]] = (), "", (0.0, 0.0)
        _make_room(self.plan.depth)

    def __reduce__(self) -> NoReturn:
        """Refuse to be copied or pickled: a copy's steps would share what they keep with its own.

        Raises
        ------
        UsageError
        """
        raise UsageError(
            "a runner is not to be copied or pickled: its steps keep state; copy or pickle its "
            "pipeline, whose runner() makes a new one"
        )

    @property
    def stateful(self) -> bool:
        """Whether a step keeps something from frame to frame."""
        return self.plan.stateful

    @property
    def n_states(self) -> int:
        """Of how many labels, of recordings and sensors, steps have kept a state so far."""
        return len(self._context.labels)

    def repeats(self, frame: Frame) -> bool:
        """Return whether the frame would reuse the last one's result."""
        last = self._last
        image = frame.image
        return (
            last is not None
            and image.values.tobytes() == last[0]
            and _alike(image, last[1].frame.image)
            and (last[1] is self._sure or self._lasts(last[1]))
        )

    def _lasts(self, last: ResultT) -> bool:
        """Return whether an equal frame comes to the same as the last one."""
        if _may_pass(last):
            return False
        self._sure = last  # or each frame of an idle pad would look again
        return True

    @property
    def _lost_calls(self) -> bool:
        """Whether processes of steps left calls without an answer since this was asked last."""
        before = self._n_lost
        self._n_lost = sum(host.n_lost for host in self._apart.values())
        return self._n_lost != before

    def forget(self) -> None:
        """Forget the last frame: the next one is computed, whatever it holds."""
        self._last = None

    @cached_property
    def in_blocks(self) -> bool:
        """Whether some of its steps answer many frames at once, so that `block` is worth while."""
        return not self._verify and self._decider is None and worth_blocks(self.plan)

    @property
    def anew(self) -> tuple[str, ...]:
        """Nodes that keep something and did not go on with what they had in the runner before."""
        return tuple(n for n in self.plan.keeping if n not in self._went_on)

    @property
    def processes(self) -> dict[str, ProcessState]:
        """How the processes fare of the nodes that run apart; ``map/node`` within a mapped one."""
        return {name: host.state for name, host in self._apart.items()}

    def prepare(self) -> None:
        """Make the machine code of nodes that are run by one call, and use it from now on."""
        self._operations.write_chains(make=True)

    def each_alone(self) -> Self:
        """Run every node by a call of its own, whose time is its alone; return the runner."""
        self._operations.unchain()
        return self

    @property
    def _keeping(self) -> dict[str, tuple[_Equal, Call]]:
        """The calls that keep something (a state, a process), and what makes a node their equal."""
        nodes = self.plan.pipeline.nodes
        return {n: (self._equal(nodes[n]), c) for n, c in self._calls.items() if nodes[n].keeps}

    def _equal(self, node: Node) -> _Equal:
        return node.key, node.isolation, self._made_of.get(node.name)

    def _call(self, node: Node) -> Call:
        if node.name not in self._calls:
            call = self._taken_over(node)
            if call is None:
                call = make_call(node, self._context)
                call = self._watched(node, call) if self._verify else call
            self._calls[node.name] = call
        return self._calls[node.name]

    def _watched(self, node: Node, call: Call) -> Call:
        signature = node.signature
        if signature is None:
            return watched(call, step_label(node))
        ports = [port.name for port in signature.ports]
        return watched(call, step_label(node), ports, defined_at(signature.target))

    def _taken_over(self, node: Node) -> Call | None:
        """Return the call of an equal node of the runner before, its own name's first."""
        nodes = self.plan.pipeline.nodes
        for name in (node.name, *(n for n in self._left if n not in nodes)):
            equal, call = self._left.get(name, (None, None))
            if equal is not None and equal == self._equal(node):
                del self._left[name]
                self._went_on.add(node.name)
                self._take_processes(name, node.name)
                return call
        return None

    def _take_processes(self, before: str, now: str) -> None:
        for name, host in self._apart_before.items():
            if name == before or name.startswith(f"{before}/"):
                self._apart[now + name.removeprefix(before)] = host

    def __call__(self, frame: Frame) -> ResultT:
        """Return the result for the frame.

        Raises
        ------
        RuleError
            If the frame's quantity, shape or pitch breaks a rule of a step.
        UsageError
            If it is no frame.
        """
        try:
            image = frame.image
        except AttributeError:
            raise UsageError(
                f"a runner takes frames, got {type(frame).__name__}; Frame.of(values) makes one"
            ) from None
        values = image.values
        if (values.shape, image.quantity, image.pitch_cm) != self._checked:
            self._check(image)
        if self._repeatable:
            content = values.tobytes()
            last = self._last
            if (
                last is not None
                and content == last[0]
                and _alike(image, last[1].frame.image)
                and (last[1] is self._sure or self._lasts(last[1]))
            ):
                return last[1].again(frame)
        state = self._blank.copy()
        state[self._image] = image  # where nothing reads it, the frame takes its place
        state[0] = frame
        decider = self._decider
        if decider is not None:
            decider.begin(frame)
        # As in `_settle`, whose call would take a tenth of an empty pad's time.
        context = self._context
        context.frame = frame
        # As in `steps_at_work`, likewise.
        before, errors = changes.n, errors_of_numpy()
        if changes.away:
            go_away()
        try:
            self._operations.run(state)
        except BaseException:  # Ctrl-C, for one
            context.drop_items()
            raise
        finally:
            if changes.n != before or errors_of_numpy() is not errors:
                put_right(before, errors)
        if context.inner_results or context.item_failures:
            self._note_items(state)
        if decider is not None:
            decider.end()
        result = _new(self._result)  # as its class would, in half the time
        result.plan = self.plan
        result._state = state
        if (decider is not None and result.decisions) or (self._apart and self._lost_calls):
            self._last = None  # less than an equal frame may come to
        elif self._repeatable:
            self._last = content, result  # only now: an interrupted frame leaves nothing to reuse
        return result

    def _check(self, image: Image) -> None:
        check_frame(image, self.plan)
        self._checked = image.values.shape, image.quantity, image.pitch_cm

    def _settle(self, state: list[Any], operations: list[Operation]) -> None:
        context = self._context
        context.frame = state[0]
        try:
            for settle in operations:
                settle(state)
        except BaseException:  # Ctrl-C, for one
            context.drop_items()
            raise
        if context.inner_results or context.item_failures:
            self._note_items(state)

    def _note_items(self, state: list[Any]) -> None:
        """Take what items of lists came to out of the context."""
        context = self._context
        if context.inner_results:
            state[INNER] = context.inner_results
            context.inner_results = {}
        if context.item_failures:
            state[ITEM_FAILURES] = context.item_failures
            context.item_failures = []

    # -- many frames at once -------------------------------------------------------------------

    @steps_at_work()
    def block(self, frames: FrameStack) -> Block[ResultT]:
        """Return the results of several frames, those that each would give one after the other.

        Raises
        ------
        RuleError
            As of a call; of frames that are alike it is the first that breaks a rule.
        """
        images = frames.images
        n = len(frames)
        if (images.shape[1:], images.quantity, images.pitch_cm) != self._checked:
            self._check(images[0])
        last = self._last
        of, before = np.arange(n), None
        if self._repeatable:
            again = equal_to_last(images)
            if last is not None:
                before = last[1]
                again[0] = self.repeats(frames[0])
            of = np.maximum.accumulate(np.where(again, -1, of))
        own = np.flatnonzero(of == np.arange(n))
        done: list[Group] = []
        states: dict[int, list[Any]] = {}
        open_slots = [s for s in self._constant_slots if self._blank[s] is None]
        if len(own):
            its = frames if len(own) == n else frames.take(own)
            done, unfinished = self._blocks(its, own)
            states = self._one_by_one(unfinished)
        lost = bool(self._apart) and self._lost_calls
        if len(own) < len(of):
            of = self._tried_again(frames, of, done, states, lost)
        constants = [
            Constant(slot, first_settled(slot, done, states), self._blank[slot])
            for slot in open_slots
            if self._blank[slot] is not None
        ]
        block = Block(self.plan, self._result, frames, done, states, Repeats(of, before), constants)
        own = np.flatnonzero(of == np.arange(n))
        if lost:
            self._last = None
        elif self._repeatable and len(own):
            result = block[int(own[-1])]
            self._last = result.frame.image.values.tobytes(), result
        return block

    def _tried_again(
        self,
        frames: FrameStack,
        of: NDArray[np.intp],
        done: list[Group],
        states: dict[int, list[Any]],
        lost: bool,
    ) -> NDArray[np.intp]:
        """Compute the frames that would repeat what may pass, and return whom the others repeat."""
        of = of.copy()
        failing = [g.rows for g in done if _may_pass(self._result(self.plan, g.state))]
        rows = [i for i, s in states.items() if lost or _may_pass(self._result(self.plan, s))]
        for row in np.flatnonzero(np.isin(of, [*chain(*failing), *rows])).tolist():
            if of[row] != row:
                state = states[row] = self._blank.copy()
                state[self._image], state[0] = frames[row].image, frames[row]
                self._settle(state, [self._operations.run])
                of[row] = row
        return of

    @cached_property
    def _blocks(self) -> Blocks:
        return Blocks(self.plan, self._call, self._blank, self._show)

    @cached_property
    def _constant_slots(self) -> list[int]:
        return [i.slot for i in self.plan.items if i.constant and i.node is not None]

    def _show(self, frame: Frame) -> None:
        self._context.frame = frame

    def _one_by_one(self, groups: list[Group]) -> dict[int, list[Any]]:
        """Settle what is left of groups, in the order of the frames."""
        waiting = sorted(
            (int(row), group, place)
            for group in groups
            for place, row in enumerate(group.rows.tolist())
        )
        states = {}
        for row, group, place in waiting:
            state = states[row] = group.frame_state(place, self.plan.n_slots)
            self._settle(state, self._blocks.resume)
        return states


def _may_pass(outcomes: Outcomes) -> bool:
    """Return whether something failed that is not of the frame's data: it may pass by itself."""
    return any(not isinstance(f.error, Degenerate | RuleError) for f in outcomes.failures)


def _embedded(
    result: type[Outcomes], settings: RunSettings, pipeline: Graph
) -> tuple[RunInner, Mapping[str, Host]]:
    """Return what runs a pipeline for a node that runs it over a list, and its processes."""
    inner = Runner(pipeline, (), result, RunSettings(settings.seed, settings.verify))

    def run(frame: Frame, item: tuple[int, ...]) -> Outcomes:
        inner._context.item = item  # or every item would draw the same numbers
        return inner(frame)

    return run, inner._apart


def equal_to_last(images: ImageStack) -> NDArray[np.bool_]:
    """Return for each image of a stack whether it equals the one before, bit for bit."""
    n = len(images)
    raw = images.values.reshape(n, -1)
    wide = raw.view(np.int64) if raw.itemsize == 8 else raw.view(np.uint8)
    again = np.zeros(n, np.bool_)
    again[1:] = (wide[1:] == wide[:-1]).all(axis=1)
    if images.valid is not None:
        again[1:] &= (images.valid[1:] == images.valid[:-1]).all(axis=(1, 2))
    return again


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
    if rule.square_to is not None and (wanted := square_wanted(image, rule.square_to)):
        across, down = image.pitch_cm
        return (
            f"step {rule.step!r} takes {wanted}, got a frame with a pitch of {across:g} by "
            f"{down:g} cm"
        )
    return ""


def _make_room(depth: int) -> None:
    """Let lazy blocks nest as deep as the plan does; each level takes up to four calls."""
    needed = 4 * depth + 1000
    if depth > 100 and sys.getrecursionlimit() < needed:
        sys.setrecursionlimit(needed)
