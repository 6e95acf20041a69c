"""All that recordings teach about a pad, one thing after another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.quantities import unit_of
from tactile_graph_pads.circuits.ghosts import ghosts_in, ghosts_told
from tactile_graph_pads.defects import Defects
from tactile_graph_pads.falling import TURN_ROUND, fall_of, rest_among
from tactile_graph_pads.learned import GOOD, Elements, Learned, Reading, TurnOn
from tactile_graph_pads.learning.force_curve import ForceCurve, force_curve
from tactile_graph_pads.learning.gains import LEAST_ALIKE, Gains, gains
from tactile_graph_pads.learning.place_fit import (
    LEAST_GROUPS,
    LEAST_PLACES,
    KnownContacts,
    LearnedPlace,
    known_contacts,
    learned_place,
)
from tactile_graph_pads.learning.recordings import Stack
from tactile_graph_pads.learning.resting import (
    Resting,
    resting,
    resting_among_objects,
    step_of,
)
from tactile_graph_pads.learning.silent import Silence, silence
from tactile_graph_pads.learning.touching import best_level, filled, least_level, placements
from tactile_graph_pads.learning.turn_on import turn_on_of
from tactile_graph_pads.pad import Pad
from tactile_graph_pads.told_grid import close

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
SATURATED = 10
"""Readings equal to the largest one from which on that is full scale and no chance."""
LEAST_LEVELS = 50
"""Steps below the largest reading; coarser ones repeat by themselves."""
PRESSED = 3.0
"""Times the least reading that shows: between two such elements there is no valley of silence."""
STEPS = 8.0
"""Of the converter, below which single steps pass for where readings begin."""
DRIFTS = 3.0
"""Noises that the empty pad may move before it is said."""


LAWFUL = ("volt", "siemens")
"""Quantities of readings that steps turn into loads by a law, whose unevenness is another's."""


class Uneven(NamedTuple):
    """How unevenly loads come down, as `tactile_graph_pads.unevenness.Unevenness` names it."""

    sigma: float
    fixed: float
    voids: float


@dataclass(frozen=True, eq=False)
class LearnedPad:
    """A pad's record, and what it was made from, for whoever judges it.

    Parameters
    ----------
    learned : Learned
        Without the names of its files.
    elements : Elements
    resting : Resting
    silence : Silence, optional
        None where no objects were recorded, as for the next three.
    gains : Gains, optional
    loads : "gram" or the recordings' own quantity
        What the gains and the turn-on were learned in.
    under : ndarray
        Readings of elements under objects, for the distribution behind the turn-on.
    curve : ForceCurve, optional
    place : LearnedPlace, optional
    counted_right : float, optional
        Share of the frames with known places in which as many contacts are found.
    notes : tuple of str
        What could not be learned, and why; what is odd.
    """

    learned: Learned
    elements: Elements
    resting: Resting
    silence: Silence | None = None
    gains: Gains | None = None
    loads: Reading = "raw"
    under: Array | None = None
    curve: ForceCurve | None = None
    place: LearnedPlace | None = None
    counted_right: float | None = None
    notes: tuple[str, ...] = ()

    @property
    def unevenness(self) -> Uneven | None:
        """Of the loads that steps see; None where it is not known, or only that of readings."""
        if self.gains is None or self.silence is None or self.loads in LAWFUL:
            return None
        if not np.isfinite(self.gains.sigma):
            return None
        return Uneven(self.gains.sigma, self.gains.fixed, self.silence.voids)


def learn_pad(empty: Stack | None, objects: Stack | None, base: Pad | None = None) -> LearnedPad:
    """Return what recordings teach.

    Parameters
    ----------
    empty : Stack, optional
        Of the pad with nothing on it. Without it each element is taken where it is untouched.
    objects : Stack, optional
        With objects on it, known or not.
    base : Pad, optional
        A pad whose converter, circuit and law are those of the recorded one: gains and turn-on
        are then learned in grams.

    Raises
    ------
    DataError
        If the recordings do not hold what is needed.
    """
    notes: list[str] = []
    rest = _resting(empty, objects, notes)
    stack = objects if objects is not None else empty
    assert stack is not None
    if stack.pitch_assumed:
        notes.append("The pitch of 1 cm is assumed: no recording says it; give --with pitch_cm=…")
    if base is not None and base.geometry.shape != stack.shape:
        raise DataError(
            "--pad",
            f"has {base.geometry.rows} x {base.geometry.columns} elements, the recordings have "
            f"{stack.shape[0]} x {stack.shape[1]}",
        )
    if base is not None and not stack.pitch_assumed:
        _check_pitch(base.geometry.pitch_cm, stack.image.pitch_cm)
    bare, step = _bare(stack, rest), step_of(stack.values)
    shows_from = least_level(rest.noise[rest.good], max(step, rest.step), bare)
    rest = rest.stepped(step)
    if objects is None:
        notes.append("No objects were recorded: dead elements, gains and all else are not known.")
        return _of_empty(stack, rest, shows_from, notes)
    known = _known_pad(base, stack, rest)
    return _of_objects(objects, bare, shows_from, known, notes)


def _check_pitch(told_cm: float, recorded_cm: tuple[float, float]) -> None:
    """Refuse a pad the elements of which lie otherwise: the learned one would be laid out so."""
    if not close(told_cm, recorded_cm):
        x, y = recorded_cm
        raise DataError(
            "--pad",
            f"its elements are {told_cm:g} cm apart (element_cm and gap_cm), those of the"
            f" recordings {x:g} x {y:g} cm",
        )


def _known_pad(base: Pad | None, stack: Stack, rest: Resting) -> _KnownPad:
    """Return the pad that was told without its turn-on, which is to be learned."""
    if base is not None:
        base = replace(base, law=replace(base.law, turn_on_bend=0.0), defects=Defects())
    return _KnownPad(base, stack.image.quantity, rest)  # type: ignore[arg-type]


class _KnownPad(NamedTuple):
    """The pad that was told, if any, and what it makes of readings."""

    base: Pad | None
    quantity: Reading
    rest: Resting

    @property
    def loads(self) -> Reading:
        """Quantity of what `load_of` gives."""
        told = self.base is not None and self.quantity in ("volt", "counts")
        return "gram" if told else self.quantity

    def load_of(self, recorded: Array, touched: Flags) -> Array:
        """Return grams where the pad is told, else readings above the offset; 0 if untouched."""
        above = np.where(self.rest.good, recorded - self.rest.offset, 0.0)
        if self.base is None or self.loads != "gram":
            return np.where(touched, above, 0.0)
        scale = self.base.converter.step_v if self.quantity == "counts" else 1.0
        # A stuck element shadows its column as it reads; the zero of the others is no voltage.
        volts = scale * np.where(self.rest.stuck, recorded, np.where(touched, above, 0.0))
        loads = np.stack([self.base.backward(np.maximum(frame, 0.0)).load_g for frame in volts])
        return np.where(touched, loads, 0.0)

    def least_load(self, shows_from: float) -> float:
        """Return what one element alone bears that just shows, in the unit of `load_of`."""
        recorded, touched = self.rest.offset.copy(), np.zeros(self.rest.good.shape, np.bool_)
        alone = tuple(int(n) for n in np.argwhere(self.rest.good)[0])
        touched[alone] = True
        recorded[alone] += shows_from
        return float(self.load_of(recorded[None], touched[None])[0][alone])


def _resting(empty: Stack | None, objects: Stack | None, notes: list[str]) -> Resting:
    if empty is not None:
        rest = resting(empty.values, ", ".join(empty.names[:3]))
        if rest.left_out:
            notes.append(f"{rest.left_out} frames of the empty pad are left out: touched.")
        if abs(rest.drift) > DRIFTS * max(rest.usual_noise, rest.step) > 0.0:
            notes.append(
                f"The empty pad drifts by {rest.drift:.3g} over the recording, "
                f"{abs(rest.drift) / max(rest.usual_noise, rest.step):.0f} times the noise: let it "
                "warm up, or put the step tare with drift_s before everything else."
            )
        return rest
    assert objects is not None
    notes.append(
        "No recording of the empty pad: offset and noise are those of each element where it is "
        "untouched."
    )
    return resting_among_objects(objects.values, ", ".join(objects.names[:3]))


def _bare(stack: Stack, rest: Resting) -> Array:
    """Return readings above the offset, 0 where an element is no good or was not read."""
    above = np.where(rest.good, stack.values - rest.offset, 0.0)
    return np.where(np.isnan(above), 0.0, above)


def _of_empty(stack: Stack, rest: Resting, level: float, notes: list[str]) -> LearnedPad:
    elements = _elements(rest, None, np.ones(stack.shape))
    return LearnedPad(
        _record(stack, rest, level), elements, rest, loads=stack.image.quantity,  # type: ignore[arg-type]
        notes=tuple(notes),
    )  # fmt: skip


class _Pressed(NamedTuple):
    """What objects say of the elements, and all frames with that taken into account."""

    silence: Silence
    gains: Gains
    good: Flags
    under: Array
    turn_on: TurnOn | None
    evened: Array
    placements: int


def _pressed(objects: Stack, bare: Array, shows_from: float, known: _KnownPad) -> _Pressed:
    rest, touched = known.rest, bare >= shows_from
    _refuse_falling(touched, rest, objects)
    _refuse_untouched(touched, bare, shows_from, rest, objects)
    new = placements(touched)
    silent = silence(touched[new], bare[new] >= PRESSED * shows_from, rest.good)
    good = rest.good & ~silent.dead
    recorded = np.where(np.isnan(objects.values[new]), rest.offset, objects.values[new])
    loads = known.load_of(recorded, touched[new])
    found = gains(loads, touched[new], good)
    under = loads[touched[new] & good]
    begins = known.least_load(max(shows_from, STEPS * rest.step))
    evened = bare / found.gain if known.loads == objects.image.quantity else bare
    return _Pressed(
        silent, found, good, under, turn_on_of(under, begins, known.loads), filled(evened, good),
        len(new),
    )  # fmt: skip


def _of_objects(
    objects: Stack, bare: Array, shows_from: float, known: _KnownPad, notes: list[str]
) -> LearnedPad:
    rest, seen = known.rest, _pressed(objects, bare, shows_from, known)
    if not seen.gains.stand_out:
        n_touching = int((bare >= shows_from).any(axis=(1, 2)).sum())
        notes.append(_no_gains(seen.gains, seen.placements, n_touching))
    curve = force_curve(seen.evened.reshape(len(objects), -1), objects.weight_g, shows_from)
    places = _places(objects)
    level, right = _level(seen.evened, places, shows_from)
    learned = replace(
        _record(objects, rest, level),
        gain_of=known.loads if seen.gains.stand_out else None,
        turn_on=seen.turn_on,
        curve=() if curve is None else curve.points,
        saturated_from=_full_scale(objects.values, rest),
    )
    place = _place(objects, seen, places, learned.touched_from, notes)
    notes += _weights_note(objects, curve) + _turn_on_note(seen.turn_on)
    notes += _silence_note(seen.silence) + _unevenness_note(seen.gains, known.loads)
    notes += _ghosts_note(bare, shows_from, known)
    return LearnedPad(
        learned, _elements(rest, seen.silence, seen.gains.gain), rest, seen.silence, seen.gains,
        known.loads, seen.under, curve, place, right, tuple(notes),
    )  # fmt: skip


def _level(
    evened: Array, places: Sequence[Array | None], shows_from: float
) -> tuple[float, float | None]:
    """Return from where on contacts are to be looked for, and how often their number is right."""
    told = [(f, p) for f, p in zip(evened, places, strict=True) if p is not None]
    if not told:
        return shows_from, None
    return best_level([f for f, _ in told], [p for _, p in told], shows_from)


def _refuse_falling(touched: Flags, rest: Resting, objects: Stack) -> None:
    """Raise where readings fall under pressure; `_refuse_untouched` tells where none ever rises."""
    if rest.from_empty and not touched.any():
        return
    noise = max(rest.usual_noise, rest.step / np.sqrt(12.0))
    at_rest, read = (rest.offset, noise), rest.good
    if not rest.from_empty:
        at_rest, read = rest_among(objects.values, ~rest.missing, rest.step)[1:], ~rest.missing
    if (fell := fall_of(objects.values, *at_rest, read)) is None:
        return
    raise DataError(
        ", ".join(objects.names[:3]),
        f"in {fell.frames} of {len(objects)} frames readings fall under pressure, by up to "
        f"{fell.most:.4g} {unit_of(objects.image.quantity)}, and hardly rise in any; only readings "
        f"that rise are learned from: {TURN_ROUND}",
    )


def _refuse_untouched(touched: Flags, bare: Array, shows_from: float, rest: Resting,
                      objects: Stack) -> None:  # fmt: skip
    if touched.any():
        return
    where = ", ".join(objects.names[:3])
    if np.isnan(objects.values[:, rest.good]).all():
        raise DataError(where, f"no reading is valid in any of its {len(objects)} frames")
    n_below = int((bare <= -shows_from).any(axis=(1, 2)).sum())
    if n_below:
        raise DataError(where, _below(-float(bare.min()), n_below, rest, objects))
    if not rest.from_empty:
        _refuse_pressed_mostly(rest, objects)
    raise DataError(
        where,
        "nothing lies on the pad in any frame: every reading is within the empty pad's noise",
    )


def _refuse_pressed_mostly(rest: Resting, objects: Stack) -> None:
    """Raise where elements rest as the others do, but in less than half of the frames."""
    own, with_others, _ = rest_among(objects.values, ~rest.missing, rest.step)
    pressed = own != with_others
    if not pressed.any():
        return
    row, column = (int(np.median(at)) for at in np.nonzero(pressed))
    raise DataError(
        ", ".join(objects.names[:3]),
        f"{int(pressed.sum())} elements around row {row}, column {column} are pressed in more than "
        "half of the frames, so that the empty pad cannot be told; record it and give it by "
        "--empty",
    )


def _below(most: float, n_frames: int, rest: Resting, objects: Stack) -> str:
    """Return what to say of readings that lie below those of the empty pad, and never above."""
    unit = unit_of(objects.image.quantity)
    noise = rest.usual_noise
    times = f", {most / noise:.3g} times its noise" if noise > 0.0 else ""
    told = (
        f"no reading is above the empty pad's, and in {n_frames} of {len(objects)} frames readings "
        f"are below it, by up to {most:.4g} {unit}{times}: "
    )
    if noise == 0.0:
        level = float(np.median(rest.offset[rest.good]))
        return told + (
            f"the empty pad reads {level:.4g} {unit} without any noise, as at full scale; record "
            "it again with nothing on it, or below full scale"
        )
    return told + (
        "were the two recordings swapped, or has the pad drifted? Only readings that rise under "
        f"pressure are learned from; where they fall, {TURN_ROUND}"
    )


def _place(
    objects: Stack, seen: _Pressed, places: Sequence[Array | None], level: float, notes: list[str]
) -> LearnedPlace | None:
    told = [k for k, p in enumerate(places) if p is not None]
    if not told:
        notes.append("No places are known: no correction of place.")
        return None
    known = known_contacts(
        [seen.evened[k] for k in told],
        [p for p in places if p is not None],
        _groups(objects.recording)[told],
        level,
    )
    if known.n_told and known.unlike:
        notes.append(_unlike(known, objects))
        return None
    if n_lone := known.n_told - known.n_met:
        notes.append(f"{n_lone} of {known.n_told} known places met no contact, and do not count.")
    n, n_groups = len(known.true), len(np.unique(known.group))
    if n < LEAST_PLACES or n_groups < LEAST_GROUPS:
        notes.append(
            f"{n} known places in {n_groups} recordings or stretches of one: at least "
            f"{LEAST_PLACES} in {LEAST_GROUPS} are needed for a correction of place."
        )
        return None
    learned = learned_place(known, np.ones_like(seen.good))  # the bad ones are filled
    if not learned.helps:
        notes.append(
            "A correction of place would not help: recordings held out come out "
            f"{learned.halves.off.mean():.3g} cells off with it and "
            f"{learned.halves.off_before.mean():.3g} without; it is left out."
        )
    return learned


def _unlike(known: KnownContacts, objects: Stack) -> str:
    """Return why nothing is learned of places that are not those of the contacts."""
    met = f"{known.n_met} of {known.n_told} known places met a contact"
    if known.n_met:
        met += f", {known.off_cells:.3g} cells off (median)"
    pitch = "1 cm the pitch, which is assumed" if objects.pitch_assumed else "the pitch right"
    return (
        f"No correction of place: {met}, on contacts of about {known.radius_cells:.2g} cells "
        f"radius. Are the places those of these frames, in cm from the pad's top left corner, x "
        f"to the right and y down, and is {pitch}?"
    )


def _groups(recording: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return which frames are held out together: a recording, or stretches of a few long ones."""
    names, counts = np.unique(recording, return_counts=True)
    if len(names) >= LEAST_GROUPS:
        return recording
    stretches = -(-2 * LEAST_GROUPS // len(names))
    group = np.empty(len(recording), np.int64)
    for k, (name, n) in enumerate(zip(names, counts, strict=True)):
        group[recording == name] = k * stretches + np.arange(n) * stretches // n
    return group


def _places(objects: Stack) -> list[Array | None]:
    """Return known places as (column, row) in cells from the first cell's middle."""
    pitch, origin = np.array(objects.image.pitch_cm), np.array(objects.image.origin_cm)
    return [
        None if p is None else (np.array(p).reshape(-1, 2) - origin) / pitch - 0.5
        for p in objects.places_cm
    ]


def _elements(rest: Resting, silent: Silence | None, gain: Array) -> Elements:
    state = np.full(rest.offset.shape, GOOD, dtype="U8")
    if silent is not None:
        state[silent.dead] = "dead"
    state[rest.still] = "dead"
    state[rest.noisy], state[rest.stuck], state[rest.missing] = "noisy", "stuck", "missing"
    return Elements(rest.offset, rest.noise, np.where(state == GOOD, gain, 1.0), state)


def _record(stack: Stack, rest: Resting, level: float) -> Learned:
    image = stack.image
    return Learned(
        reading=image.quantity,  # type: ignore[arg-type]
        rows=image.rows,
        columns=image.columns,
        pitch_cm=image.pitch_cm,
        origin_cm=image.origin_cm,
        elements="",
        noise=rest.usual_noise,
        touched_from=level,
        drift=rest.drift,
    )


def _full_scale(values: Array, rest: Resting) -> float | None:
    """Return the reading at which elements stop, if any do."""
    read = values[:, rest.good]
    top = float(np.nanmax(read))
    at_top = read == top
    if rest.step == 0.0 or top - float(np.nanmin(read)) < LEAST_LEVELS * rest.step:
        return None
    return top if at_top.sum() >= SATURATED and at_top.any(axis=0).sum() > 1 else None


def _no_gains(found: Gains, n_placements: int, n_touching: int) -> str:
    alike = (
        f"two halves of them agree on gains by {found.alike:.2f}, at least {LEAST_ALIKE:g} is "
        "needed; put objects down more often, at other places"
    )
    return (
        f"Gains are not told by {n_placements} placements ({n_touching} frames, of which those "
        f"that touch nearly what another did count once): {found.lacks or alike}."
    )


def _weights_note(objects: Stack, curve: ForceCurve | None) -> list[str]:
    known = np.isfinite(objects.weight_g)
    n = int(known.sum())
    if curve is None and n == 0:
        return ["No weights are known: no law from readings to grams."]
    if curve is None:
        return [f"{n} known weights are too few or too much alike: no law from readings to grams."]
    n_loaded = int((known & (objects.weight_g > 0.0)).sum())
    n_unseen = n_loaded - len(curve.true_g)
    if n_unseen == 0:
        return []
    return [
        f"In {n_unseen} of {n_loaded} frames of known weight no reading is more than noise: they "
        "weigh 0 g, and do not count among the held-out weights."
    ]


def _silence_note(found: Silence) -> list[str]:
    n = int(found.dead.sum())
    if n == 0:
        return []
    told = "1 element reads" if n == 1 else f"{n} elements read"
    return [
        f"{told} nothing between others that objects press, and {'is' if n == 1 else 'are'} taken "
        "for dead. So does what nothing ever loads, as an insole under the arch: where that may "
        "be, press there, and learn again."
    ]


def _ghosts_note(bare: Array, shows_from: float, known: _KnownPad) -> list[str]:
    """Return what to say where readings hold ghosts that the told pad does not take out."""
    if known.base is not None and known.base.circuit.kind == "floating":
        return []
    told = ghosts_told(*ghosts_in(bare, shows_from, known.rest.good))
    return [f"{told}. Gains, unevenness and law are learned of ghosts, too."] if told else []


def _turn_on_note(found: TurnOn | None) -> list[str]:
    none = "No turn-on is seen: readings begin in the noise, or come on slowly."
    return [] if found is not None else [none]


def _unevenness_note(found: Gains, loads: Reading) -> list[str]:
    if loads not in LAWFUL or not np.isfinite(found.sigma):
        return []
    unit = unit_of(loads)
    told = "; a pad given by --pad tells it" if loads == "volt" else ""
    return [
        f"The unevenness is that of {unit}, not of the loads that a law makes of them, and so not "
        f"in the file{told}."
    ]
