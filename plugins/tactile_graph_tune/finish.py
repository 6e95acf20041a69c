"""From what the search found to what is told: frames it did not see, and real runs of the last."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf
from typing import Any

import numpy as np

from tactile_graph import Pipeline
from tactile_graph.plugins.registry import installed
from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.choices.text import Notes
from tactile_graph_tune.rerun import rerun
from tactile_graph_tune.search.front import Choice, Weighed
from tactile_graph_tune.searching import Told, Tuning
from tactile_graph_tune.split import Interval, interval_of
from tactile_graph_tune.table.kinds import Reals
from tactile_graph_tune.tuned import ALWAYS, CHOSEN, GIVEN, GuardWorth, Point, Tuned, Weight

MOST_ON_FRONT = 12
MOST_RIVALS = 3


def finished(tuning: Tuning, told: Told) -> Tuned:
    """Return the report of a search, its last few choices run and timed."""
    last = {GIVEN: tuning.variants[0].given, ALWAYS: tuning.always, CHOSEN: tuning.chosen}
    known = tuning.resamples().of_all(tuning.chosen)
    worths = tuple(
        replace(_worth(tuning, place), known=tuple(its for at, its in known if at == place))
        for place in tuning.chosen.chosen
    )
    text = _text(tuning, worths)
    told("run the last", 0, 1)
    pipelines = {k: _pipeline(tuning, c, text if k == CHOSEN else "") for k, c in last.items()}
    frames = [tuning.frames[k] for k in tuning.split.reporting]
    request = tuning.request
    ran = rerun(pipelines, frames, tuning.judged, request.rounds, request.seed)
    told("run the last", 1, 1)
    points = {
        k: Point(k, c, predicted(tuning, c), weight_of(tuning, ran[k])) for k, c in last.items()
    }
    (given_us, given), (tuned_us, tuned) = ran[GIVEN], ran[CHOSEN]
    return Tuned(
        judged=tuning.judged,
        n_choosing=len(tuning.split.choosing),
        n_reporting=len(tuning.split.reporting),
        how=tuning.how,
        n_weighed=tuning.front.n_weighed,
        points=points,
        front=tuple(
            Point("", p.choice, predicted(tuning, p.choice)) for p in _some(tuning.front.points)
        ),
        bound=tuning.bound(),
        everything_us=tuning.everything_us(),
        worths=worths,
        settings=_settings(tuning, pipelines[CHOSEN]),
        as_good=tuning.as_good,
        ratio=ratio_of(tuning, tuned_us, given_us),
        difference=weight_of(tuning, (tuned_us, tuned), (given_us, given)),
        saved=_saved(tuning),
        pipeline=pipelines[CHOSEN],
        text=text,
    )


def _some(points: list[Weighed]) -> list[Weighed]:
    """Return at most `MOST_ON_FRONT` points, evenly along the front, both its ends among them."""
    n = min(len(points), MOST_ON_FRONT)
    at = np.linspace(0, len(points) - 1, n).round().astype(int)
    return [points[k] for k in at.tolist()]


# -- the frames it did not see ---------------------------------------------------------------


def _columns(tuning: Tuning, choice: Choice) -> tuple[Reals, Reals]:
    """Return time and error of each frame that reports."""
    found = tuning.variants[choice.variant].predicted(choice)
    rows = tuning.split.reporting
    return found.time_us[rows], found.loss[rows]


def ratio_of(tuning: Tuning, values: Reals, over: Reals) -> Interval:
    """Return the weighed mean of a column of the frames that report over that of another."""
    rows = tuning.split.reporting
    weights = tuning.truths.weights[rows]
    seed = tuning.request.seed
    return interval_of(weights * values, tuning.split.groups[rows], seed, weights * over)


Columns = tuple[Reals, Reals]
"""Time and error of each frame that reports."""


def weight_of(tuning: Tuning, found: Columns, less: Columns | None = None) -> Weight:
    """Return the means of some columns, or of what they are more than others."""
    truths = tuning.truths.taken(tuning.split.reporting)
    time_us, loss = found
    kinds = {name: (part.astype(float), of) for name, part, of in truths.parts(loss)}
    if less is not None:
        time_us = time_us - less[0]
        others = {name: part for name, part, _ in truths.parts(less[1])}
        kinds = {name: (part - others[name], of) for name, (part, of) in kinds.items()}
    means = {name: ratio_of(tuning, part, of.astype(float)) for name, (part, of) in kinds.items()}
    return Weight(ratio_of(tuning, time_us, np.ones(len(time_us))), **means)


def predicted(tuning: Tuning, choice: Choice) -> Weight:
    """Return what the table says of a choice, on the frames that report."""
    return weight_of(tuning, _columns(tuning, choice))


def _saved(tuning: Tuning) -> Interval:
    whole, (own, _) = tuning.whole_us(), _columns(tuning, tuning.chosen)
    return ratio_of(tuning, whole - own, np.ones(len(own)))


def _worth(tuning: Tuning, place: str) -> GuardWorth:
    choice = tuning.chosen
    without = replace(choice, chosen={p: c for p, c in choice.chosen.items() if p != place})
    found, other = _columns(tuning, choice), _columns(tuning, without)
    weights = tuning.truths.weights[tuning.split.reporting]
    saved, whole = (float(np.average(t, weights=weights)) for t in (other[0] - found[0], other[0]))
    return GuardWorth(
        place=place,
        comparisons=choice.chosen[place],
        n_stopped=int(_stopped(tuning, place).sum()),
        saved_share=saved / whole if whole else 0.0,
        cost=weight_of(tuning, found, other),
        rivals=_rivals(tuning, place),
    )


def _stopped(tuning: Tuning, place: str) -> Any:
    """Return in which of the frames that report something at a place does not hold."""
    variant = tuning.variants[tuning.chosen.variant]
    rows = tuning.split.reporting
    columns = [c.of(variant.table.column(c.field).values) for c in tuning.chosen.chosen[place]]
    return ~np.logical_and.reduce(columns)[rows]


def _rivals(tuning: Tuning, place: str) -> tuple[tuple[Comparison, float, float], ...]:
    """Return the best other fields at a place, chosen by the frames that choose."""
    choice, rows = tuning.chosen, tuning.split.choosing
    space = tuning.spaces[choice.variant]
    own = {c.field for c in choice.chosen[place]}
    limits = tuning.means(choice, rows)._replace(time_us=inf)
    found = []
    for field in space.questions.fields.get(place, ()):
        batch = space.questions.batch(field)
        if field in own or batch is None:
            continue
        best = None
        for comparison in batch.comparisons:
            its = replace(choice, chosen={**choice.chosen, place: (comparison,)})
            means = tuning.means(its, rows)
            if means.within(limits) and (best is None or means.time_us < best[0]):
                best = (float(means.time_us), its)
        if best is not None:
            found.append(best)
    told = []
    for _, its in sorted(found, key=lambda b: b[0])[:MOST_RIVALS]:
        means = tuning.means(its, tuning.split.reporting)
        told.append((its.chosen[place][0], float(means.time_us), float(means.error)))
    return tuple(told)


# -- the file --------------------------------------------------------------------------------


def _pipeline(tuning: Tuning, choice: Choice, text: str = "") -> Pipeline:
    its = tuning.variants[choice.variant].declared
    return its.resolved(text or its.text(choice.order, choice.chosen))


def _text(tuning: Tuning, worths: tuple[GuardWorth, ...]) -> str:
    its = tuning.variants[tuning.chosen.variant].declared
    notes = Notes({w.place: told_of(w, tuning) for w in worths}, _head(tuning))
    own = tuning.request.pipeline
    head = {"pipeline": f"{own.name}-tuned", **_parent(own)}
    return its.text(tuning.chosen.order, tuning.chosen.chosen, head, notes)


def _settings(tuning: Tuning, tuned: Pipeline) -> dict[str, Any]:
    """Return what was chosen of the free settings, of nodes that are left."""
    chosen = tuning.variants[tuning.chosen.variant].settings
    nodes = {name: name.rpartition(".")[0] for name in chosen}
    left = {n for n in nodes.values() if {n, n.replace("/", "_")} & set(tuned.nodes)}
    return {name: value for name, value in chosen.items() if nodes[name] in left}


def _parent(own: Pipeline) -> Mapping[str, str]:
    """Return what the tuned file says it evolved from: what it can name wherever it lies."""
    registry = own.registry or installed()
    names = (own.name, own.evolves)
    return {"evolves": next((n for n in names if n and registry.has("pipelines", n)), "")}


def _head(tuning: Tuning) -> str:
    judged = tuning.judged
    name, levels = tuning.request.pipeline.name, tuning.request.levels
    made = "Numbers in guards" if levels else "Guards and order"
    return (
        f"{made} by 'tactile-graph tune {name}{' --levels' * levels}': "
        f"{tuning.front.n_weighed} choices weighed on {len(tuning.split.choosing)} frames, "
        f"numbers of {len(tuning.split.reporting)} others ({tuning.how}); error: of the "
        f"{judged.quantity} where something lies, a missed one counting {judged.price:g} "
        f"{judged.unit}".rstrip()
        + (f"; frames of {tuning.request.frames_of}" if tuning.request.frames_of else "")
    )


def told_of(worth: GuardWorth, tuning: Tuning) -> str:
    """Return what a guard saves and costs, in words."""
    unit, more = tuning.judged.unit, worth.cost.time_us
    saves = more.mean < 0.0
    low, high = (-more.high, -more.low) if saves else (more.low, more.high)
    share = f", {100 * worth.saved_share:.0f} %" if saves else ""
    took = "saves" if saves else "takes"
    return (
        f"{took} {abs(more.mean):.3g} us a frame ({low:.3g} to {high:.3g}){share}; "
        f"{worth.cost.told(unit)}; does not hold in {worth.n_stopped} of "
        f"{len(tuning.split.reporting)} frames" + "".join(f"; {its.text}" for its in worth.known)
    )
