"""How large elements are, by how readings fall off over the rims of all outlines on a pad."""

from __future__ import annotations

import math

from tactile_graph_likelihood.any_pad.pad_effects.gap import SLOPE, Tried
from tactile_graph_likelihood.several.joint.joint_posterior import JointProblem
from tactile_graph_likelihood.several.pad import OnPad
from tactile_graph_likelihood.single.readings import Gap, Readings, is_row


def sized(
    problem: JointProblem, readings: Readings, found: OnPad, guess: Gap
) -> tuple[JointProblem, OnPad, float]:
    """Return the problem on elements as large as readings tell, and the outlines on them.

    Parameters
    ----------
    problem : JointProblem
        Of the whole pad.
    readings : Readings
    found : OnPad
        Under the noise that it leaves.
    guess : Gap
        What is believed of elements' gap.

    Returns
    -------
    (JointProblem, OnPad)
        The same where the gap was told of the pad, on a single row, through foam, and where a
        limit holds readings.
    float
        The deviation of radii and half sides that is left, as nobody knows the gap better.
    """
    if guess.is_told or is_row(readings) or readings.through_foam is not None:
        return problem, found, 0.0
    if readings.unheld is not None:
        return problem, found, SLOPE * guess.std_cm
    even = found.settled_on(float(readings.grid[3]))
    if even.height == -math.inf:
        return problem, found, 0.0
    tried = Tried(
        lambda its, near: near.settled_on(float(its.grid[3])),
        lambda its: its.height,
        readings,
        even,
        guess,
    )
    its, on_it, std_cm = tried.likeliest(lambda its: float(its.outlines.points[:, 2].mean()))
    if on_it.height == -math.inf:
        return problem, found, 0.0
    return problem._replace(grid=its.grid), on_it, std_cm
