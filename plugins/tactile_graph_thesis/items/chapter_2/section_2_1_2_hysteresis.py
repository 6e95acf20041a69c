"""Section 2.1.2: whether what elements keep of an earlier load matters for objects at rest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load
from tactile_graph.wires import Circle, TrueObject
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.law import ForceLaw
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.bench import Bench
from tactile_graph_thesis.measure.circles import signed_circle_errors
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
KEPT = 0.1
"""Share of the conductance gained under more load that stays: makers of FSRs state about 10 %."""
OVERSHOOT = 1.3
"""How much more than its weight an object presses while it is put down."""
SLID_CM = 2.6
"""Two elements."""
READINGS, QUICK_READINGS = 40, 12
"""Of each object in each case."""
CHANGED = 0.1
"""Share by which an error or a reading must change to matter."""
LOOP_G = np.geomspace(5.0, 1000.0, 60)[None]


class Case(NamedTuple):
    """How an object came to rest.

    Attributes
    ----------
    kept : float
        Share of the conductance that elements keep.
    overshoot : float
        How much more than its weight it pressed before.
    slid_cm : float
        From how far off to the left it was pushed to where it lies.
    """

    kept: float
    overshoot: float = 1.0
    slid_cm: float = 0.0


CASES = {
    "no hysteresis": Case(0.0),
    "put down": Case(KEPT, OVERSHOOT),
    "slid": Case(KEPT, 1.0, SLID_CM),
}


class Read(NamedTuple):
    """What readings of a case came to, means over all objects.

    Attributes
    ----------
    volts : float
        Sum over the elements of a reading.
    centre_cm, radius_cm : float
        Errors of circle-3.
    """

    volts: float
    centre_cm: float
    radius_cm: float


def retained_g(law: ForceLaw, load_g: Array, most_g: Array, kept: float) -> Array:
    """Return the loads that elements seem to bear which bore more before, shape as given.

    Parameters
    ----------
    law : ForceLaw
    load_g, most_g : ndarray
        What they bear, and the most they bore since they were at rest.
    kept : float
        Share of the conductance gained beyond ``load_g`` that stays.
    """
    now = law.conductance_s(load_g)
    most = np.maximum(law.conductance_s(most_g), now)
    return law.load_of(now + kept * (most - now))


def _hysteresis(work: Work) -> Made:
    n = QUICK_READINGS if work.quick else READINGS
    read = {name: _read(work, case, n) for name, case in CASES.items()}
    rows = [(name, *CASES[name], *one) for name, one in read.items()]
    columns = ("case", *Case._fields, *Read._fields)
    return Made(
        findings=(at_rest(read["no hysteresis"], read["put down"]),
                  moved(read["no hysteresis"], read["slid"])),
        table=Table(columns, rows),
        figure=_figure(work.pad.law, read),
    )  # fmt: skip


def _read(work: Work, case: Case, n: int) -> Read:
    """Return what a case comes to; all cases see the same pad, places and noise."""
    pad, rng = work.pad, np.random.default_rng(work.seed)
    bench = Bench(pad, rng)
    frames: list[Frame] = []
    volts = []
    for true in _discs(work, n):
        disc = true.shape
        assert isinstance(disc, Circle)
        gains, weight_g = bench.gains(), float(true.weight_g or 0.0)
        before = Circle(disc.x_cm - case.slid_cm, disc.y_cm, disc.radius_cm)
        rests = bench.load_g(disc, weight_g, gains)
        most = bench.load_g(before, case.overshoot * weight_g, gains)
        read = bench.volts(retained_g(pad.law, rests, most, case.kept))
        volts.append(float(read.sum()))
        frames.append(Frame(pad.image(read), len(frames), 0.0, (true,)))
    names = sorted({f.truth[0].name for f in frames if f.truth})
    errors = signed_circle_errors(frames, [load("circle-3").runner()], names)[0].reshape(-1, 3)
    off = np.hypot(errors[:, 0], errors[:, 1])
    return Read(float(np.mean(volts)), float(off.mean()), float(np.abs(errors[:, 2]).mean()))


def _discs(work: Work, n: int) -> list[TrueObject]:
    """Return the discs of the thesis where the scene puts them, on the pad when they slid too."""
    width = work.pad.geometry.size_cm[0]
    found = []
    for frame in work.frames("discs", 3 * n):
        assert frame.truth is not None
        true = frame.truth[0]
        disc = true.shape
        assert isinstance(disc, Circle)
        room = width - 2.0 * disc.radius_cm
        x = disc.radius_cm + min(max(disc.x_cm - disc.radius_cm, min(SLID_CM, room)), room)
        shape = Circle(float(x), disc.y_cm, disc.radius_cm)
        found.append(TrueObject(shape, true.weight_g, true.name))
    return found


def at_rest(none: Read, put_down: Read) -> Finding:
    """Return whether hysteresis changes little for objects that are put down and stay.

    Parameters
    ----------
    none, put_down : Read
        Without hysteresis and with it.
    """
    shares = _changes(none, put_down)
    return Finding(
        "objects do not move, so hysteresis is no significant effect",
        f"put down with {100 * (OVERSHOOT - 1):.0f} % more than their weight: {_words(shares)}",
        f"readings or an error that changes by {100 * CHANGED:.0f} % or more",
        all(abs(share) < CHANGED for share in shares.values()),
    )


def moved(none: Read, slid: Read) -> Finding:
    """Return whether hysteresis changes much for objects that were pushed to where they lie.

    Parameters
    ----------
    none, slid : Read
        Without hysteresis and with it.
    """
    shares = _changes(none, slid)
    return Finding(
        "(not in the thesis) where objects move, it is",
        f"pushed {SLID_CM:g} cm to where they lie: {_words(shares)}",
        f"readings and errors of which none changes by {100 * CHANGED:.0f} %",
        not all(abs(share) < CHANGED for share in shares.values()),
    )


def _changes(none: Read, other: Read) -> Mapping[str, float]:
    """Return by which share readings and errors change."""
    names = ("readings", "error of the centre", "error of the radius")
    return {name: b / a - 1.0 for name, a, b in zip(names, none, other, strict=True)}


def _words(shares: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {100 * share:+.1f} %" for name, share in shares.items())


def _figure(law: ForceLaw, read: Mapping[str, Read]) -> Figure:
    figure = new_figure(10.0, 4.4)
    loop, errors = figure.subplots(1, 2)
    _draw_loop(loop, law)
    at = np.arange(len(read))
    for k, (name, field) in enumerate((("centre", "centre_cm"), ("radius", "radius_cm"))):
        values = [getattr(one, field) for one in read.values()]
        drawn = errors.bar(at + 0.4 * k - 0.2, values, 0.38, label=name)
        errors.bar_label(drawn, fmt="%.2f", fontsize="small")
    errors.set_xticks(at, list(read))
    errors.set(ylabel="mean error / cm", title="circle-3 on objects put down, and slid")
    errors.margins(y=0.15)
    errors.grid(alpha=0.3, axis="y")
    errors.legend()
    return figure


def _draw_loop(axes: Axes, law: ForceLaw) -> None:
    """Draw an element's conductance under rising and then falling load."""
    down = retained_g(law, LOOP_G, np.full_like(LOOP_G, LOOP_G.max()), KEPT)
    for loads, line, words in ((LOOP_G, "-", "load rises"), (down, "--", "load falls again")):
        axes.loglog(LOOP_G[0], 1e6 * law.conductance_s(loads)[0], line, label=words)
    axes.set(xlabel="load on an element / g", ylabel="conductance / µS", title="One element")
    axes.grid(alpha=0.3, which="both")
    axes.legend()


ITEMS = (
    Item(
        "hysteresis",
        "Hysteresis",
        f"An element that keeps {100 * KEPT:.0f} % of what it gained under more load, and what "
        "circle-3 finds of discs that are put down and of discs that are pushed to where they lie.",
        _hysteresis,
        "The thesis gives no numbers. The shipped pads have no hysteresis; it is added here.",
        after="2.1.2",
    ),
)
