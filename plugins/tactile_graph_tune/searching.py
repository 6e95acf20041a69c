"""From one run of everything to the choice that is taken, before any of it is run."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from tactile_graph import Pipeline
from tactile_graph.errors import UsageError, did_you_mean, one_of
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.score.answers import answers_of
from tactile_graph_tune.apart import without_repeats, without_seen
from tactile_graph_tune.choices.declared import Declared, Place, declared
from tactile_graph_tune.request import Request
from tactile_graph_tune.search.cascade import Cascade, Order, Predicted, bound
from tactile_graph_tune.search.front import Choice, Front
from tactile_graph_tune.search.levels import (
    LevelSearch,
    Resamples,
    dials_of,
    unchanged_where_as_good,
)
from tactile_graph_tune.search.oracle import Bound, Options, options_of
from tactile_graph_tune.search.questions import Questions, fields_by_place
from tactile_graph_tune.search.search import Search, orders_of, pruned
from tactile_graph_tune.search.select import Goal, Rows, merged, selected
from tactile_graph_tune.search.settings import AsGood, best_of_each, settled, told_from
from tactile_graph_tune.search.weigher import Aim, Space
from tactile_graph_tune.shares import weights_of
from tactile_graph_tune.split import Split, halves_of, split_of
from tactile_graph_tune.table.columns import Table
from tactile_graph_tune.table.kinds import Means, Reals, Truths
from tactile_graph_tune.table.losses import PRICES, quantity_of
from tactile_graph_tune.table.record import Judged, Rounds, leaves_of, record

COSTLY = 0.1
"""Share of all time from which a step without a guard is offered one."""
MOST_OFFERED = 3
N_PRICES = 5
MARGINS = (1.0, 0.9, 0.75)
"""Shares of the greatest error allowed that descents aim at: a margin holds on other frames."""
OVER = 1e4
"""What being over a limit costs, in times of running everything."""
Told = Callable[[str, int, int], None]
"""Is told what is done, how far, and how far it goes."""


@dataclass(frozen=True, eq=False)
class Variant:
    """One combination of the free settings' values, with its table."""

    number: int
    settings: dict[str, Any]
    declared: Declared
    pipeline: Pipeline
    cascade: Cascade
    table: Table
    given: Choice

    def predicted(self, choice: Choice) -> Predicted:
        """Return what a choice comes to in every frame."""
        return self.cascade.predicted(self.table, choice.order, choice.chosen)


@dataclass(frozen=True, eq=False)
class Tuning:
    """All that the search found, before any of it is run."""

    request: Request
    judged: Judged
    frames: Sequence[Frame]
    split: Split
    variants: list[Variant]
    spaces: list[Space]
    front: Front
    always: Choice
    goal: Goal
    chosen: Choice
    as_good: AsGood

    @property
    def how(self) -> str:
        """How frames were told apart, and for how many they count, in words."""
        shares = ", ".join(map(str, self.request.shares))
        return self.split.how + (f"; weighed so that {shares} of all" if shares else "")

    @property
    def truths(self) -> Truths:
        """In which frames something lies."""
        return self.variants[0].table.truths

    def means(self, choice: Choice, rows: Rows) -> Means:
        """Return what a choice comes to over some frames."""
        return _means(self.variants, choice, rows)

    def whole_us(self) -> Reals:
        """Return the time of each frame that reports, nothing skipped."""
        nodes = self.variants[0].table.taken(self.split.reporting).nodes
        found: Reals = np.sum([c.time_us for c in nodes.values()], axis=0)
        return found

    def everything_us(self) -> float:
        """Return the mean time of the frames that report, nothing skipped."""
        return self.variants[0].table.taken(self.split.reporting).mean(self.whole_us())

    def resamples(self) -> Resamples:
        """Return who tells how surely numbers are known."""
        groups = self.split.groups[self.split.choosing]
        over_us = OVER * _whole_us(self.spaces[0])
        return Resamples(self.spaces, self.goal, over_us, groups, self.request.seed)

    def bound(self) -> Bound:
        """Return the least that any choice could reach on the frames that report."""
        rows = self.split.reporting
        options = [_options(v, v.table.taken(rows), self.judged.answer) for v in self.variants]
        times, losses = (np.concatenate(part) for part in zip(*options, strict=True))
        return Bound(Options(times, losses), self.truths.taken(rows))


def searched(
    request: Request, frames: Sequence[Frame], held_out: Sequence[Frame], told: Told
) -> Tuning:
    """Return what the search found; parameters and errors as of `tuner.tune`."""
    judged = _judged(request)
    given, apart = _known(frames, held_out)
    n_given = len(given)
    given = given if apart else without_repeats(given)
    other = without_seen(given, apart)
    every = [*given, *other]
    split = split_of(every, len(other), request.seed)
    if seen := len(apart) - len(other):
        split = split._replace(how=f"{split.how}, less {seen} of their frames that choose, too")
    if twice := n_given - len(given):
        split = split._replace(how=f"{split.how}, less {twice} frames that two of them hold")
    _check_objects(every, split)
    weights = weights_of(every, request.shares, (split.choosing, split.reporting))
    variants = _variants(
        request, judged, every, weights, lambda n, of: told("run everything", n, of)
    )
    _check_truths(variants, judged)
    _check_answers(variants, judged)
    spaces = [_space(v, v.table.taken(split.choosing), request) for v in variants]
    _check_choices(request, spaces)

    def weigh(choice: Choice, rows: Rows) -> Means:
        return _means(variants, choice, rows)

    always = _always(spaces[0])
    goal = Goal(spaces[0].given, request.most_us, request.most_error,
                request.most_missed, request.most_false, request.margin)  # fmt: skip
    _check_found([weigh(c, split.choosing).missed for c in (goal.given, always)], judged)
    folds = halves_of(every, split, request.seed)
    fronts = [Front() for _ in folds]
    for k, (front, rows) in enumerate(zip(fronts, folds, strict=True)):
        half = [_space(v, v.table.taken(rows), request) for v in variants]
        _search(half, front, goal.limits(rows, weigh), request.levels)
        told("weigh choices", k + 1, len(folds))
    found = [p.choice for front in fronts for p in front.points]
    before = [goal.given] if request.levels else [goal.given, always]
    chosen = selected(goal, [*before, *found], folds, weigh)

    def allowed(choice: Choice) -> bool:
        return all(weigh(choice, rows).within(goal.limits(rows, weigh)) for rows in folds)

    as_good: AsGood = {}
    if len(variants) > 1:
        chosen, as_good = _settled(variants, chosen, [*before, *found], goal, allowed, split,
                                   request.seed)  # fmt: skip
    limits = goal.limits(split.choosing, weigh)
    if not request.levels:
        chosen = pruned(spaces[chosen.variant], chosen, limits, goal.by_time)
    front = merged(fronts, found, split.choosing, weigh, limits)
    tuning = Tuning(request, judged, every, split, variants, spaces, front, always, goal, chosen,
                    as_good)  # fmt: skip
    if not request.levels:
        return tuning
    known = tuning.resamples().known
    chosen = unchanged_where_as_good(chosen, goal.given.chosen, known, allowed)
    return replace(tuning, chosen=chosen)


def _settled(
    variants: Sequence[Variant],
    chosen: Choice,
    others: Sequence[Choice],
    goal: Goal,
    allowed: Callable[[Choice], bool],
    split: Split,
    seed: int,
) -> tuple[Choice, AsGood]:
    """Return the choice with the values that are taken of the free settings."""
    rows, truths = split.choosing, variants[0].table.truths
    weights = truths.weights * truths.full if goal.by_time else truths.weights

    def sought(choice: Choice) -> tuple[Reals, Reals]:
        found = variants[choice.variant].predicted(choice)
        return (found.loss if goal.by_time else found.time_us)[rows], weights[rows]

    best = best_of_each(chosen, others, len(variants), allowed,
                        lambda c: goal.sought(_means(variants, c, rows)))  # fmt: skip
    least = min(best.values(), key=lambda c: goal.sought(_means(variants, c, rows)))
    as_good = told_from(least, sought, split.groups[rows], seed)
    return settled(best, [v.settings for v in variants], _given(variants), as_good)


def _given(variants: Sequence[Variant]) -> dict[str, Any]:
    """Return what the pipeline as it is has the free settings at."""
    nodes, found = variants[0].pipeline.nodes, {}
    for name in variants[-1].settings:
        node, _, setting = name.rpartition(".")
        its = nodes.get(node) or nodes.get(node.replace("/", "_"))
        found[name] = None if its is None else its.settings.get(setting)
    return found


def _means(variants: Sequence[Variant], choice: Choice, rows: Rows) -> Means:
    variant = variants[choice.variant]
    found = variant.predicted(choice)
    return found.taken(rows).means(variant.table.truths.taken(rows))


# -- before the search -----------------------------------------------------------------------


def _known(frames: Sequence[Frame], held_out: Sequence[Frame]) -> tuple[list[Frame], list[Frame]]:
    """Return the frames whose truth is known, and those of them that are held out."""
    known = [f for f in frames if f.truth is not None]
    apart = [f for f in held_out if f.truth is not None]
    if frames and not known:
        raise UsageError(
            f"none of {len(frames)} frames has a truth to choose by: give --truth FILE, or "
            "recordings that hold it (docs/how-to/attach-truth.md)"
        )
    if held_out and not apart:
        raise UsageError(
            f"--held-out: none of {len(held_out)} frames has a truth to report on; --truth tells "
            "that of the other recordings alone, so name one that holds its own: 'tactile-graph "
            "convert RECORDING NEW.npz --truth FILE' writes it"
        )
    return known, apart


def _check_objects(frames: Sequence[Frame], split: Split) -> None:
    for rows, what in ((split.choosing, "choose"), (split.reporting, "report")):
        if not any(frames[k].truth for k in rows.tolist()):
            raise UsageError(
                f"nothing lies in any of the {len(rows)} frames that {what}, where an answer that "
                "never comes would be the best: give frames with objects, too"
            )


def _check_truths(variants: Sequence[Variant], judged: Judged) -> None:
    scored = np.all([v.table.scored for v in variants], axis=0)
    if not scored.all():
        raise UsageError(
            f"in {int((~scored).sum())} of {len(scored)} frames the truth says nothing of "
            f"{judged.quantity!r}: choose another with --error, or leave these frames out"
        )


def _check_found(missed: Sequence[float], judged: Judged) -> None:
    if min(missed) > 1.0 - 1e-9:
        price = f"{judged.price:g} {judged.unit}".rstrip()
        raise UsageError(
            f"no way to an answer comes within {price} of what lies there in any frame that "
            "chooses: is the truth that of these frames, in cm from the pad's top left corner? "
            "(--price sets what is a miss)"
        )


def _check_choices(request: Request, spaces: Sequence[Space]) -> None:
    if request.levels and not any(dials_of(spaces[0].given.chosen)):
        raise UsageError(
            f"--levels: no guard of pipeline {request.pipeline.name!r} that may be chosen compares "
            "a node's field with a number"
        )
    if not spaces[0].questions.fields and len(spaces) == 1 and len(spaces[0].given.order) < 2:
        raise UsageError(
            f"pipeline {request.pipeline.name!r}: nothing to choose: it has no guard, no first_of "
            "that answers, and no costly step before which a field is known; mark a setting free "
            "(free: {setting: [values]}, or --free node.setting=low:high)"
        )


def _judged(request: Request) -> Judged:
    pipeline = request.pipeline
    answer = request.answer
    if answer and answer not in pipeline.outputs:
        known = list(pipeline.outputs)
        hint = did_you_mean(answer, known)
        raise UsageError(f"--answer {answer}: outputs are {one_of(known)}{hint}")
    if not answer:
        able = [o for o in pipeline.outputs if answers_of(pipeline, (o,)).quantities]
        if not able:
            raise UsageError(f"pipeline {pipeline.name!r}: no truth says how right an output is")
        answer = able[0]
    quantity, unit = quantity_of(pipeline, answer, request.quantity)
    price = PRICES.get(unit, 1.0) if request.price is None else request.price
    return Judged(answer, quantity, unit, price)


def _variants(
    request: Request,
    judged: Judged,
    frames: Sequence[Frame],
    weights: Reals,
    told: Callable[[int, int], None],
) -> list[Variant]:
    settings = request.variants()
    given = [
        declared(request.pipeline.with_settings(s) if s else request.pipeline, judged.answer)
        for s in settings
    ]
    own = f"pipeline {request.pipeline.name!r}"
    unchosen = f"no condition or guard of {own} that could be chosen otherwise"
    _check_named("--keep", request.kept, given[0].places, unchosen)
    kept = set(request.kept)
    rounds = Rounds(request.rounds, request.seed, told, request.place)
    while True:
        parted = [d.keeping(kept) for d in given]
        opened = [d.opened() for d in parted]
        also = [c.field for p in parted[0].places.values() for c in p.given]
        tables = [t.weighed(weights) for t in record(opened, also, frames, judged, rounds)]
        nodes = set().union(*(bound(p, t) for p, t in zip(opened, tables, strict=True)))
        stay = {p.name for d in parted for p in d.places.values() if nodes & set(p.nodes)}
        if not stay:
            break
        kept |= stay  # what they keep from running is read where it may be missing
    found = []
    for k, (values, its, pipeline, table) in enumerate(
        zip(settings, parted, opened, tables, strict=True)
    ):
        its = _with_offers(its, pipeline, table, nodes)
        cascade = Cascade(pipeline, its, pipeline.outputs[judged.answer])
        choice = Choice(k, its.rungs, its.given)
        found.append(Variant(k, values, its, pipeline, cascade, table, choice))
    unread = f"no node of {own} has it, or it is no number"
    _check_named("--field", request.fields, found[0].table.fields, unread)
    return found


def _with_offers(its: Declared, pipeline: Pipeline, table: Table, bound_: set[str]) -> Declared:
    """Offer a guard to the costliest steps of the file that have none."""
    mean = {n: table.mean(c.time_us) for n, c in table.nodes.items()}
    least = COSTLY * sum(mean.values())
    guarded = {n for p in its.places.values() for n in p.nodes}
    costly = [
        n for n, node in its.data["nodes"].items()
        if "step" in node and n not in guarded | bound_ and mean.get(n, 0.0) >= least
    ]  # fmt: skip
    for name in sorted(costly, key=lambda n: -mean[n])[:MOST_OFFERED]:
        its = its.with_place(Place(name, (name,)))
    return its


def _check_named(option: str, names: Sequence[str], known: Collection[str], why: str) -> None:
    """Refuse a name that is not known, with the one it is nearest to."""
    for name in names:
        if name not in known:
            raise UsageError(f"{option} {name}: {why}{did_you_mean(name, known)}")


def _check_answers(variants: Sequence[Variant], judged: Judged) -> None:
    tables = [v.table for v in variants]
    names = _leaves(variants[0], judged.answer)
    if not any(t.nodes[node].ok.any() for t in tables for node in names.values()):
        failed = sum(t.nodes[n].failed.sum() for t in tables[:1] for n in names.values())
        why = f"; {failed} times a step failed" if failed else ""
        raise UsageError(
            f"{judged.answer!r} has a value in none of {tables[0].n} frames, even with every guard "
            f"left out{why}: 'tactile-graph explain' tells why"
        )


def _space(variant: Variant, table: Table, request: Request) -> Space:
    fields = fields_by_place(variant.declared, variant.pipeline, table, request.fields)
    fields = {place: names for place, names in fields.items() if names}
    questions = Questions(variant.pipeline, table, fields)
    return Space(variant.number, variant.cascade, table, questions, variant.given)


def _leaves(variant: Variant, answer: str) -> dict[str, str]:
    """Return what may answer -> its node."""
    refs = leaves_of(variant.pipeline, variant.pipeline.outputs[answer])
    return {str(ref): ref.node for ref in refs}


def _options(variant: Variant, table: Table, answer: str) -> Options:
    return options_of(variant.pipeline, table, _leaves(variant, answer))


def _always(space: Space) -> Choice:
    """Return the one rung, always run, whose error is least where something lies."""
    rungs: list[Order] = [(r,) for r in space.given.order] or [()]
    return min((Choice(0, order, {}) for order in rungs), key=lambda c: _alone(space, c).error)


# -- the search ------------------------------------------------------------------------------


def _search(spaces: Sequence[Space], front: Front, limits: Means, levels: bool = False) -> None:
    whole_us = _whole_us(spaces[0])
    aims = _aims(whole_us, spaces[0].table.truths.price, limits)
    allowed = limits._replace(time_us=inf, error=inf)
    for space in spaces:
        if levels:
            LevelSearch(space, front, aims, allowed).run()
            continue
        alone = [float(_alone(space, Choice(0, (r,), {})).time_us) for r in space.given.order]
        Search(space, front, aims, allowed).run(orders_of(space.given.order, alone))


def _whole_us(space: Space) -> float:
    """Return the mean time of a frame in which no guard stops anything."""
    return float(_alone(space, Choice(0, space.given.order, {})).time_us)


def _aims(whole_us: float, price: float, limits: Means) -> list[Aim]:
    """Return aims at each trade of time for error, and at the limits with some margin."""
    over_us = OVER * whole_us
    free = limits._replace(error=inf)
    prices = (whole_us / price * np.geomspace(0.3, 3000.0, N_PRICES)).tolist()
    aims = [Aim(p, free, over_us) for p in prices]
    if limits.error < inf:
        aims += [Aim(0.0, limits._replace(error=m * limits.error), over_us) for m in MARGINS]
    return aims


def _alone(space: Space, choice: Choice) -> Means:
    found = space.cascade.predicted(space.table, choice.order, choice.chosen)
    return found.means(space.table.truths)
