"""Section 5.4.1: what start temperature, cooling, iterations and state space do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.simulated_rectangle import (
    CHOSEN,
    HOT,
    QUICK,
    VARIED,
    Annealed,
    StateSpace,
    schedules,
    state_spaces,
)
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

IMAGES, QUICK_IMAGES = 16, 8
NOTHING_LEVELS = 1.0
"""Change in the error (rms, of 200 levels) that is no effect: a level off looks the same."""
FROZEN = 1.1
"""Times the energy of slow cooling from which a state is stuck in a minimum above it."""
UNITS = {1.0: "squared levels", 0.001: "thousands of squared levels"}
"""Units of the energy by the factor on it; what the thesis concludes is tried in the first."""


def _images(work: Work) -> int:
    return QUICK_IMAGES if work.quick else IMAGES


# -- the annealing schedule ------------------------------------------------------------------


def _annealing(work: Work) -> Made:
    n = _images(work)
    found = {scale: schedules(work.seed, n, scale, (HOT, QUICK)) for scale in UNITS}
    chosen, *varied, hot, quick = found[1.0]
    rows = [
        (UNITS[scale], *one.schedule, one.rms_levels.mean(), one.rms_levels.std(),
         one.off_chosen_levels, one.energy)
        for scale, of_unit in found.items()
        for one in of_unit
    ]  # fmt: skip
    columns = (
        "unit", "start temperature", "cooling", "sweeps", "rms_levels", "sd_levels",
        "off the chosen_levels", "energy",
    )  # fmt: skip
    told = zip(VARIED, varied, strict=True)
    return Made(
        findings=(
            *(no_effect(what, one, chosen) for what, one in told),
            Finding(
                "(not in the thesis) a start temperature that is hot beside squared levels has one",
                f"{hot.schedule}: {hot.rms_levels.mean():.1f} levels off instead of "
                f"{chosen.rms_levels.mean():.1f}",
                f"an error less than {NOTHING_LEVELS:g} level smaller",
                hot.off_chosen_levels < -NOTHING_LEVELS,
            ),
            freezes(quick, hot),
        ),
        table=Table(columns, [tuple(r) for r in rows]),
        figure=_schedule_figure(found, n),
        notes=(
            f"Over {n} images of figure 5.8, with lines. In thousands of squared levels the chosen "
            f"schedule is {found[0.001][0].rms_levels.mean():.1f} levels off, and 2 instead of 5 "
            f"changes that by {found[0.001][1].off_chosen_levels:+.1f}.",
        ),
    )


def no_effect(what: str, one: Annealed, chosen: Annealed) -> Finding:
    """Return whether one change of the schedule leaves the error as it is.

    Parameters
    ----------
    what : str
    one, chosen : Annealed
    """
    return Finding(
        f"{what}: {one.schedule} instead of {chosen.schedule} does not affect the results much",
        f"{one.rms_levels.mean():.2f} levels off the original (rms) instead of "
        f"{chosen.rms_levels.mean():.2f}",
        f"a change of more than {NOTHING_LEVELS:g} level",
        abs(one.off_chosen_levels) <= NOTHING_LEVELS,
    )


def freezes(quick: Annealed, slow: Annealed) -> Finding:
    """Return whether quick cooling from the same temperature ends at a higher energy.

    Parameters
    ----------
    quick, slow : Annealed
    """
    return Finding(
        "too quick a cooling freezes in a local minimum",
        f"{quick.schedule}: energy {quick.energy:.0f} instead of {slow.energy:.0f} by "
        f"{slow.schedule.cooling:g}",
        f"an energy less than {FROZEN:g} times that of the slow cooling",
        quick.energy >= FROZEN * slow.energy,
    )


def _schedule_figure(found: dict[float, list[Annealed]], n: int) -> Figure:
    figure = new_figure(7.5, 4.2)
    axes = figure.subplots()
    for k, (scale, of_unit) in enumerate(found.items()):
        means = [one.rms_levels.mean() for one in of_unit]
        errors = [2.0 * one.rms_levels.std() / np.sqrt(n) for one in of_unit]
        at = np.arange(len(of_unit)) + 0.12 * (2 * k - 1)
        axes.errorbar(means, at, xerr=errors, fmt="o", color=f"C{k}", capsize=3, label=UNITS[scale])
    axes.set_yticks(range(len(found[1.0])), [str(one.schedule) for one in found[1.0]])
    axes.invert_yaxis()
    axes.set_xlim(left=0.0)
    axes.set_xlabel("off the original (rms) / levels of 200; bars are two standard errors")
    axes.set_title("Restored with lines, by schedule and unit of the energy")
    axes.legend()
    axes.grid(alpha=0.3)
    return figure


# -- the state space -------------------------------------------------------------------------


def _state_space(work: Work) -> Made:
    found = state_spaces(work.seed, _images(work))
    by = {one.n_levels: one for one in found}
    return Made(
        findings=(
            little_difference(by[200], by[250]),
            Finding(
                "(not in the thesis) between 50 and 250 levels there is one",
                f"{by[50].off_finest:.2f} of 200 levels (rms)",
                f"less than {NOTHING_LEVELS:g} level",
                by[50].off_finest >= NOTHING_LEVELS,
            ),
        ),
        table=Table(StateSpace._fields, [tuple(one) for one in found]),
        figure=_state_figure(found),
        notes=(
            "Whether steps of 0.7 % of the range are clearly visible and such of 0.5 % are not, "
            "numbers do not tell. More levels do not take longer here: a draw needs a few "
            f"exponentials whatever their number ({by[200].time_us:.0f} µs with 200, "
            f"{by[250].time_us:.0f} with 250).",
        ),
    )


def little_difference(one: StateSpace, finer: StateSpace) -> Finding:
    """Return whether a finer state space leaves the image as it is.

    Parameters
    ----------
    one, finer : StateSpace
    """
    return Finding(
        f"from {one.n_levels} to {finer.n_levels} levels there is little or no difference",
        f"{one.off_finest:.2f} of 200 levels (rms)",
        f"a difference of {NOTHING_LEVELS:g} level",
        one.off_finest < NOTHING_LEVELS,
    )


def _state_figure(found: list[StateSpace]) -> Figure:
    figure = new_figure(6.4, 4.2)
    axes = figure.subplots()
    sizes = [one.n_levels for one in found]
    axes.plot(sizes, [one.off_finest for one in found], "o-", label="off the image of 250 (rms)")
    axes.plot(sizes, [2.0 * one.step_percent for one in found], "s--", label="one step")
    axes.axhline(NOTHING_LEVELS, color="0.5", ls=":", label="taken for no difference")
    axes.set(
        xlabel="size of the state space",
        ylabel="levels of 200",
        title="Restored without lines, by state space",
    )
    axes.set_xticks(sizes)
    axes.set_ylim(bottom=0.0)
    axes.legend()
    axes.grid(alpha=0.3)
    return figure


ITEMS = (
    Item(
        "annealing",
        "Start temperature, cooling, iterations",
        f"Figure 5.8's image restored with lines by other schedules than {CHOSEN}, one number "
        f"changed at a time, by {HOT}, and by {QUICK}; the energy in squared levels, and in "
        "thousands of them.",
        _annealing,
        "Each conclusion is tried on the energy in squared levels, in which the thesis' start "
        "temperatures are both so cold that lines stay where they start.",
        after="5.4.1",
    ),
    Item(
        "state-space",
        "Size of the state space",
        "Figure 5.8's image restored without lines with 50 to 250 levels.",
        _state_space,
        "The thesis judged by eye.",
        after="5.4.1",
    ),
)
