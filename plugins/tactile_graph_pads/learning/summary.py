"""What a learned pad is like, in lines for people."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tactile_graph_pads.learned import GOOD, STATES
from tactile_graph_pads.learning.learn import LearnedPad
from tactile_graph_pads.learning.place_fit import HeldOut

UNITS = {
    "volt": "V", "siemens": "S", "gram": "g", "kilopascal": "kPa", "counts": "counts",
    "raw": "raw", "level": "levels",
}  # fmt: skip
MOST_NAMED = 8


def summary(found: LearnedPad) -> Iterator[tuple[str, str]]:
    """Yield what each line is about, and the line."""
    learned, rest = found.learned, found.resting
    unit = UNITS[learned.reading]
    offset = found.elements.offset[found.elements.good]
    source = "of the empty pad" if rest.from_empty else "in all, each element where untouched"
    pitch = " x ".join(f"{p:.4g}" for p in learned.pitch_cm)
    yield "pad", f"{learned.rows} x {learned.columns} elements, pitch {pitch} cm, in {unit}"
    yield (
        "noise",
        f"{learned.noise:.3g} {unit} (median element), from {rest.frames} frames {source}",
    )
    if offset.size:
        low, middle, high = np.quantile(offset, [0.0, 0.5, 1.0])
        yield "offset", f"{middle:.4g} {unit} (median), {low:.4g} to {high:.4g}"
    yield "elements", _states(found)
    yield "touched", _touched(found, unit)
    yield from _by_objects(found)
    if found.place is not None and found.place.helps:
        yield "place", _place(found)


def _touched(found: LearnedPad, unit: str) -> str:
    learned = found.learned
    text = f"from {learned.touched_from:.3g} {unit} above the offset"
    if found.counted_right is None:
        return text
    return f"{text}: contacts counted right in {found.counted_right:.0%} of the frames told"


def _states(found: LearnedPad) -> str:
    state = found.elements.state
    texts = [f"{int((state == GOOD).sum())} good"]
    lines = () if found.silence is None else (
        *(f"row {r}" for r in found.silence.dead_rows),
        *(f"column {c}" for c in found.silence.dead_columns),
    )  # fmt: skip
    for name in STATES[1:]:
        at = [(int(r), int(c)) for r, c in np.argwhere(state == name)]
        unsure = name == "dead" and found.silence is not None and found.silence.dead.any()
        called = "dead, or never loaded" if unsure else name
        if name == "dead" and lines:
            texts.append(f"{len(at)} {called} ({', '.join(lines)} among them)")
        elif at:
            named = ", ".join(str(a) for a in at[:MOST_NAMED])
            texts.append(f"{len(at)} {called}: {named}{', …' if len(at) > MOST_NAMED else ''}")
    return "; ".join(texts)


def _by_objects(found: LearnedPad) -> Iterator[tuple[str, str]]:
    learned = found.learned
    if found.gains is not None and found.gains.stand_out and found.silence is not None:
        good = found.elements.good
        low, high = np.quantile(found.elements.gain[good], [0.05, 0.95])
        compared = int(np.isfinite(found.gains.halves[0]).sum())
        yield (
            "gains",
            f"{low:.2f} to {high:.2f} (5 to 95 % of elements) in {UNITS[found.loads]}; two halves "
            f"of the frames agree by {found.gains.alike:.2f}, of the {compared} of {good.size} "
            "elements that both compare with their neighbours often",
        )
    if found.gains is not None and np.isfinite(found.gains.sigma) and found.silence is not None:
        own = f"{found.gains.fixed:.0%} of its variance the pad's own"
        if not found.gains.stand_out:  # the halves are too little alike to tell
            own = "how much of it is the pad's own is not told"
        yield (
            "unevenness",
            f"{found.gains.sigma:.2f} in the logarithm of {UNITS[found.loads]}, {own}; "
            f"{found.silence.voids:.0%} of covered elements void",
        )
    if learned.turn_on is not None:
        yield "turn-on", f"{learned.turn_on.reading:.3g} {UNITS[learned.turn_on.of]}"
    if found.curve is not None:
        yield (
            "law",
            f"{len(found.curve.points)} points up to {found.curve.points[-1][0]:.4g} "
            f"{UNITS[learned.reading]}; held-out weights off by {found.curve.off_percent:.0f} %",
        )
    if learned.saturated_from is not None:
        yield "full scale", f"{learned.saturated_from:g} {UNITS[learned.reading]}, was reached"


def _place(found: LearnedPad) -> str:
    assert found.place is not None
    halves = found.place.halves
    return (
        f"{len(found.place.blocks.off)} places in {found.place.n_groups} recordings or stretches; "
        f"held out {errors_told(found.place.blocks)}; halves of the recordings unlike each other "
        f"{errors_told(halves)}"
    )


def errors_told(held: HeldOut) -> str:
    """Return the median error before and after a correction, in cells."""
    before, after = np.median(held.off_before), np.median(held.off)
    return f"{before:.2f} to {after:.2f} cells (median)"
