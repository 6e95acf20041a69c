"""What every node of a variant came to in one frame, spelled out."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from dataclasses import replace

from tactile_graph import Result
from tactile_graph.inspect import NO_VALUE, Ref
from tactile_graph_compare.records.frames import NodeStory
from tactile_graph_compare.records.graph import STATES, state_of
from tactile_graph_compare.run.logs import VariantLog

Stories = dict[str, dict[str, NodeStory]]
"""By variant and node."""


def stories(result: Result, log: VariantLog) -> dict[str, NodeStory]:
    """Return what each node of a variant came to in one frame, as it alone would have."""
    alone = log.member.alone(result)
    times_us = alone.times_us
    found = {}
    for name in log.nodes:
        outcome = alone.outcome_at(Ref(name))
        ran = outcome.__class__ not in NO_VALUE
        found[name] = NodeStory(
            name,
            log.member.names[name],
            STATES[state_of(outcome)],
            "" if ran else outcome.reason,
            "" if ran else outcome.origin,
            times_us[name],
            outcome if ran else None,
        )
    return found


def stories_of_all(result: Result, logs: Sequence[VariantLog]) -> Stories:
    """Return them of each variant."""
    return {log.prepared.label: stories(result, log) for log in logs}


def as_sent(told: Stories) -> Stories:
    """Return stories that can be pickled: a plugin's value that cannot be is left out."""
    return {
        label: {name: _as_sent(story) for name, story in of.items()} for label, of in told.items()
    }


def _as_sent(story: NodeStory) -> NodeStory:
    try:
        pickle.dumps(story.value)
    except Exception:  # whatever a plugin's class raises
        return replace(story, value=None)
    return story
