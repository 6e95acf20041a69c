"""``Blocks``: a plan's program run for many frames at once, as far as they go the same way.

The frames of a block set out as one group. Where a guard holds for some of them only, or a step
answers some of them only, the group parts; what is settled stays settled. Frames that no group can
take further (a step keeps a state, or failed for them) go on one by one, in their order, by the
very program that runs single frames, from what is settled.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.engine.blocks.block import Group, State
from tactile_graph.engine.blocks.stacked import (
    Parted,
    stacked_call,
    stacked_field,
    stacked_form,
    stacked_guard,
)
from tactile_graph.engine.operations.fields import field_getter
from tactile_graph.engine.plan import Plan
from tactile_graph.engine.program import Reading, make_program
from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.graph import Node
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack

Call = Callable[..., Any]
FEWEST = 4
"""Frames that are worth a group."""


class Blocks:
    """Settles groups of frames as far as they go together.

    Parameters
    ----------
    plan : Plan
    call_of : callable
        Gives a node's call for one frame, the very one that single frames use.
    blank : list
        The state every frame starts from.
    show : callable
        Takes a frame that a step is about to be called for alone.
    """

    def __init__(
        self,
        plan: Plan,
        call_of: Callable[[Node], Call],
        blank: State,
        show: Callable[[Frame], None],
    ) -> None:
        self.plan = plan
        self._blank = blank
        self._call_of, self._show = call_of, show
        self._frames: FrameStack
        self._constant = {i.name for i in plan.items if i.constant and i.node is not None}
        reading = Reading(self._field_of, self._guard_of, resumed=True)
        self._operations = make_program(plan, self._stacked_call, blank, reading)
        self.resume = make_program(plan, call_of, blank, Reading(resumed=True))

    def __call__(
        self, frames: FrameStack, rows: NDArray[np.intp]
    ) -> tuple[list[Group], list[Group]]:
        """Return the groups that came to an end, and those whose frames go on alone.

        Parameters
        ----------
        frames : FrameStack
        rows : ndarray of int, shape (n,)
            Their places in the block.
        """
        state = self._blank.copy()
        state[self.plan.image] = frames.images
        state[0] = frames
        waiting, done, alone = [Group(rows, state)], list[Group](), list[Group]()
        n = self.plan.n_slots
        while waiting:
            group = waiting.pop()
            if len(group.rows) < FEWEST:
                alone.append(group)
                continue
            self._frames = group.state[0]
            try:
                for settle in self._operations:
                    settle(group.state)
            except Parted as parted:
                waiting += group.parts(parted, n)
                if len(parted.alone):
                    alone.append(group.part(parted.alone, n))
            else:
                done.append(group)
        return done, alone

    def _stacked_call(self, node: Node) -> Call:
        call = self._call_of(node)
        if node.name in self._constant:
            return call
        slot = self.plan.refs[Ref(node.name)]
        return stacked_call(node, slot, call, lambda: self._frames, self._show)

    def _guard_of(self, guard: Guard) -> Guard:
        return stacked_guard(guard, lambda: self._frames)

    def _field_of(self, ref: Ref) -> Call:
        return stacked_field(() if ref.item_path else ref.path, field_getter(ref))


def worth_blocks(plan: Plan) -> bool:
    """Return whether any step of a plan answers stacks of frames."""
    return any(stacked_form(i.node) is not None for i in plan.items if i.node is not None)
