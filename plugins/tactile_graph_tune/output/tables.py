"""What was found as tables for the terminal and for Markdown."""

from __future__ import annotations

from collections.abc import Iterator

from tactile_graph_compare.output.tables import Table
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.split import Interval
from tactile_graph_tune.tuned import ALWAYS, CHOSEN, GIVEN, Tuned, Weight


def heading(tuned: Tuned) -> str:
    """Return what was done, in a sentence."""
    return (
        f"{tuned.n_weighed} choices weighed on {tuned.n_choosing} frames; all numbers are of "
        f"{tuned.n_reporting} other frames ({tuned.how})"
    )


def verdict(tuned: Tuned) -> str:
    """Return what came of it, in a sentence."""
    ratio, off, unit = tuned.ratio, tuned.difference, tuned.judged.unit
    share = tuned.share_of_saving()
    told = f"{100 * share:.0f} % of what an oracle saves" if share == share else "no oracle to tell"
    return (
        f"tuned takes {ratio.mean:.2f} of the time as given ({ratio.low:.2f} to {ratio.high:.2f}), "
        f"error {off.mean:+.3g} {unit}".rstrip()
        + f" ({off.low:+.3g} to {off.high:+.3g}); it saves {told} at its error"
    )


def points_table(tuned: Tuned) -> Table:
    """Return time and error of the points that were run, and of the oracle."""
    judged = tuned.judged
    error = f"{judged.quantity}, {judged.unit}" if judged.unit else judged.quantity
    columns = ("variant", "µs a frame", "95 %", "predicted", error, "95 %  ", "of the saving")
    rows = []
    for label in (GIVEN, ALWAYS, CHOSEN):
        point = tuned.points[label]
        assert point.rerun is not None
        time_us, loss = point.rerun
        share = tuned.share_of_saving(label)
        told = f"{100 * share:.0f} %" if share == share else ""
        predicted = f"{point.weight.time_us.mean:.3g}"
        rows.append((label, f"{time_us.mean:.3g}", _bounds(time_us), predicted,
                     f"{loss.mean:.3g}", _bounds(loss), told))  # fmt: skip
    at = tuned.points[CHOSEN].weight.loss.mean
    rows.append(("everything", "", "", f"{tuned.everything_us:.3g}", "", "", "0 %"))
    rows.append(("oracle, error as tuned", "", "", f"{tuned.bound.time_at(at):.3g}", f"{at:.3g}",
                 "", "100 %"))  # fmt: skip
    note = (
        "µs a frame: run and timed as a whole, median of rounds; predicted: from the table of what "
        "every step took; always the best: the rung of least error in every frame, nothing "
        f"guarded; an error counts {judged.price:g} {judged.unit}".rstrip()
        + " at most, and as "
        "much where nothing answers, or something does where nothing lies; of the saving: of what "
        "an oracle that knows each frame's errors saves at the same error, against skipping "
        "nothing"
    )
    return Table("Time and error", columns, tuple(rows), note, ("95 %  ", "95 %", "predicted"))


def front_table(tuned: Tuned) -> Table:
    """Return the Pareto front, from the cheapest to the best."""
    rows = []
    for point in tuned.front:
        weight: Weight = point.weight
        told = (f"{weight.time_us.mean:.3g}", f"{weight.loss.mean:.3g}", words_of(point.choice))
        rows.append(told)
    error = f"{tuned.judged.quantity}, {tuned.judged.unit}".rstrip(", ")
    columns = ("µs predicted", error, "guard")
    note = "what no other choice beat on the frames that choose"
    return Table("Pareto front", columns, tuple(rows), note)


def guards_table(tuned: Tuned) -> Table:
    """Return what each guard saves and costs, and which other fields would have done."""
    columns = ("guard", "stops", "saved, µs", "share", "costs", "95 % from", "to")
    rows = []
    for worth in tuned.worths:
        told = " and ".join(c.text for c in worth.comparisons)
        cost = [f"{x:+.3g}" for x in worth.cost]
        saved = (f"{worth.saved_us.mean:.3g}", f"{100 * worth.saved_share:.0f} %")
        rows.append((f"{worth.place}: {told}", str(worth.n_stopped), *saved, *cost))
        for comparison, time_us, loss in worth.rivals:
            told = f"  or {comparison.text}: {time_us:.3g} µs, error {loss:.3g}"
            rows.append((told, "", "", "", "", "", ""))
    note = (
        "stops: frames in which it does not hold; saved and costs: against the same without it, "
        "predicted; or: the best other fields there, and what all would come to with them"
    )
    return Table("Guards", columns, tuple(rows), note, ("95 % from", "to"))


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


def _bounds(interval: Interval) -> str:
    return f"{interval.low:.3g} to {interval.high:.3g}"
