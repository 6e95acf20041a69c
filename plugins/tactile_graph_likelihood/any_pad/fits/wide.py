"""What a wide outline's rim tells of elements, looked at without most of what it covers whole."""

from __future__ import annotations

import math

from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.large_pads.in_part import in_part
from tactile_graph_likelihood.single.any_pressure import EVEN
from tactile_graph_likelihood.single.density.element_terms import LEAST
from tactile_graph_likelihood.single.model import Likeliest
from tactile_graph_likelihood.single.readings import Readings


def completed_on_wide(
    fits: AnyPad, readings: Readings, even: Likeliest
) -> tuple[Readings, dict[str, Likeliest]]:
    """Return what `AnyPad.completed` does of a wide outline, on elements as large as they tell.

    Parameters
    ----------
    fits : AnyPad
    readings : Readings
        Of more than 4096 touched elements.
    even : Likeliest
        As one attempt found it.

    Returns
    -------
    Readings
        Those that tell it, `in_part`.
    dict of str to Likeliest
        Of an even face alone: no other pressure is looked at.

    Raises
    ------
    Degenerate
        If no outline of this kind is possible.
    """
    strays = fits.strays(readings, even)
    knowing = fits.knowing(strays) if strays else fits
    found, its = sized_in_part(knowing, readings, even)
    if its.unsure:
        other = fits.completed(readings, even)[EVEN]
        if other.mode is not even.mode:
            found, its = sized_in_part(knowing, readings, other)
    return found, {EVEN: its}


def sized_in_part(fits: AnyPad, readings: Readings, even: Likeliest) -> tuple[Readings, Likeliest]:
    """Return readings in part, on elements as large as they tell, and a wide outline on them.

    Parameters
    ----------
    fits, readings, even
        As in `completed_on_wide`.

    Returns
    -------
    Readings, Likeliest
        The same where no outline was found.
    """
    if even.mode.height == -math.inf:
        return readings, even
    point = fits.told.point_of(even)
    problem = fits.fit(EVEN).problem(readings)
    quiet = readings.with_states(problem.states)._replace(least_log=float(problem.noise[LEAST]))
    some = in_part(fits.told.kind, quiet, point)
    return fits.sized(some, fits.near(some, point))
