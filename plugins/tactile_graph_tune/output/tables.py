"""What was found as tables for the terminal and for Markdown."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tactile_graph_compare.output.tables import Table
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.split import Interval
from tactile_graph_tune.tuned import ALWAYS, CHOSEN, GIVEN, Tuned

DISTURBED = 2.0
"""Times that steps may take together of what they take in a run, whose own time comes on top."""


def heading(tuned: Tuned) -> str:
    """Return what was done, in a sentence."""
    return (
        f"{tuned.n_weighed} choices weighed on {tuned.n_choosing} frames; all numbers are of "
        f"{tuned.n_reporting} other frames ({tuned.how})"
    )


def verdict(tuned: Tuned) -> str:
    """Return what came of it, in a sentence."""
    ratio, share = tuned.ratio, tuned.share_of_saving()
    if tuned.saved.low <= 0.0:
        told = "what it saves against skipping nothing is not clear of chance"
    elif share == share:
        told = f"it saves {100 * share:.0f} % of what an oracle saves at its error"
    elif math.isnan(tuned.oracle_us()):
        told = "no oracle errs as little, to tell what could be saved"
    else:
        told = "at its error an oracle saves nothing either"
    return (
        f"tuned takes {ratio.mean:.2f} of the time as given ({ratio.low:.2f} to {ratio.high:.2f}), "
        f"{tuned.difference.told(tuned.judged.unit)}; {told}"
    )


def settings_told(tuned: Tuned) -> Iterator[str]:
    """Yield what was chosen of each free setting, and what would have been as good."""
    for name in dict.fromkeys([*tuned.settings, *tuned.as_good]):
        told = f"{name} = {tuned.settings[name]}" if name in tuned.settings else f"{name} as it was"
        alike = tuned.as_good.get(name, ())
        yield f"{told}; as good: {', '.join(map(str, alike))}" if len(alike) > 1 else told


def doubt(tuned: Tuned) -> str:
    """Return what is to be said where the times that chose are not those of the run; else ""."""
    for label in (GIVEN, CHOSEN):
        point = tuned.points[label]
        assert point.rerun is not None
        predicted, timed = point.weight.time_us.mean, point.rerun.time_us.mean
        if predicted > DISTURBED * timed:
            return (
                f"{label} was predicted to take {predicted:.3g} µs a frame and took {timed:.3g}: "
                "something else took the processor while steps were timed, and what was chosen may "
                "come of that; tune again with more --rounds, or when the machine is quiet"
            )
    return ""


def points_table(tuned: Tuned) -> Table:
    """Return time and each kind of error of the points that were run, and of the oracle."""
    judged = tuned.judged
    columns = ("variant", "µs a frame", "95 %", "predicted", _error(tuned), "95 %  ", "missed",
               "false", "of the saving")  # fmt: skip
    rows = []
    for label in (GIVEN, ALWAYS, CHOSEN):
        point = tuned.points[label]
        assert point.rerun is not None
        time_us, error, missed, false = point.rerun
        predicted = f"{point.weight.time_us.mean:.3g}"
        rows.append((label, f"{time_us.mean:.3g}", _bounds(time_us), predicted,
                     f"{error.mean:.3g}", _bounds(error), _share(missed.mean), _share(false.mean),
                     _share(tuned.share_of_saving(label))))  # fmt: skip
    own, known = tuned.points[CHOSEN].weight, tuned.share_of_saving() == tuned.share_of_saving()
    none, all_of_it = ("0 %", "100 %") if known else ("", "")
    rows.append(("everything", "", "", f"{tuned.everything_us:.3g}", "", "", "", "", none))
    rows.append(("oracle, error as tuned", "", "", f"{tuned.oracle_us():.3g}",
                 f"{own.error.mean:.3g}", "", _share(own.missed.mean), "", all_of_it))  # fmt: skip
    price = f"{judged.price:g} {judged.unit}".rstrip()
    note = (
        "µs a frame: run and timed as a whole, median of rounds; predicted: from the table of what "
        f"every step took; {_error(tuned)}: of frames where something lies; missed: share of these "
        f"without an answer within {price}, each counted as {price}; false: share of the frames "
        "where nothing lies that are answered; always the best: the rung of least error in every "
        "frame, nothing guarded; of the saving: of what an oracle that knows each frame's errors "
        "saves at the same error and misses, against skipping nothing; empty where that is nothing"
    )
    return Table("Time and error", columns, tuple(rows), note, ("95 %  ", "95 %", "predicted"))


def front_table(tuned: Tuned) -> Table:
    """Return the Pareto front, from the cheapest to the best."""
    rows = []
    for point in tuned.front:
        time_us, error = (f"{i.mean:.3g}" for i in point.weight[:2])
        shares = (_share(point.weight.missed.mean), _share(point.weight.false.mean))
        rows.append((time_us, error, *shares, words_of(point.choice)))
    columns = ("µs predicted", _error(tuned), "missed", "false", "guard")
    note = (
        "what no other choice beat on the frames that choose, of those that missed no more there, "
        "and answered no more empty frames, than is allowed"
    )
    return Table("Pareto front", columns, tuple(rows), note, ("false", "missed"))


def guards_table(tuned: Tuned) -> Table:
    """Return what each guard saves and costs, and which other fields would have done."""
    costs = ("costs", "from", "to", "missed", "false")
    columns = ("guard", "stops", "saved, µs", "share", *costs)
    rows = []
    for worth in tuned.worths:
        told = " and ".join(c.text for c in worth.comparisons)
        more = worth.cost
        cost = [f"{x:+.3g}" for x in more.error]
        shares = (_share(more.missed.mean, "+"), _share(more.false.mean, "+"))
        saved = (f"{-more.time_us.mean:.3g}", _share(worth.saved_share))
        rows.append((f"{worth.place}: {told}", str(worth.n_stopped), *saved, *cost, *shares))
        for its in worth.known:
            told = f"  {its.text}"
            rows.append((told, "", "", "", "", "", "", "", ""))
        for comparison, time_us, error in worth.rivals:
            told = f"  or {comparison.text}: {time_us:.3g} µs, error {error:.3g}"
            rows.append((told, "", "", "", "", "", "", "", ""))
    note = (
        "stops: frames in which it does not hold; saved, costs (in error where something lies, 95 "
        "% from, to), missed and false: against the same without it, predicted; is as good: "
        "in 95 of 100 resamples of the frames that choose, the other numbers as they are; or: the "
        "best other fields there, and what all would come to with them"
    )
    return Table("Guards", columns, tuple(rows), note, ("from", "to", "share"))


def words_of(choice: Choice) -> str:
    """Return a choice in a line."""
    return "; ".join(_words(choice)) or "nothing guarded"


def _words(choice: Choice) -> Iterator[str]:
    if len(choice.order) > 1:
        yield " > ".join(choice.order)
    elif choice.order:
        yield f"{choice.order[0]} alone"
    for place, comparisons in choice.chosen.items():
        yield f"{place}: " + " and ".join(c.text for c in comparisons)


def _error(tuned: Tuned) -> str:
    judged = tuned.judged
    return f"{judged.quantity}, {judged.unit}" if judged.unit else judged.quantity


def _share(share: float, sign: str = "") -> str:
    return f"{round(100 * share):{sign}d} %" if share == share else ""


def _bounds(interval: Interval) -> str:
    return f"{interval.low:.3g} to {interval.high:.3g}"
