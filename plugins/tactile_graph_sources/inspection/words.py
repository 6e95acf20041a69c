"""What was found in a recording, in lines for people and as plain data for programs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from statistics import median
from typing import Any

import numpy as np

from tactile_graph.quantities import unit_of
from tactile_graph.steps.injected import MOST_TOLD
from tactile_graph.wires import Frame
from tactile_graph_pads.circuits.ghosts import ghosts_told
from tactile_graph_sources.inspection.look import Looked, Sensor
from tactile_graph_sources.inspection.measure import Cells, Measured

SHADES = " .:-=+*#%@"
WIDEST, HIGHEST = 72, 32
MOST_CELLS_NAMED = 8


def data_of(looked: Looked) -> dict[str, Any]:
    """Return what was found as plain data, for JSON."""
    sensors = []
    for sensor in looked.sensors:
        image = sensor.frames[0].image
        measured = asdict(sensor.measured)
        measured["n_frames"] = sensor.n_frames
        measured["fullest"] = fullest(sensor).index
        if (falls := sensor.measured.falls) is not None:
            measured["falls"] = falls._asdict()
        sensors.append(
            {
                "label": sensor.label,
                "pitch_cm": list(image.pitch_cm),
                "pitch_assumed": looked.pitch_assumed,
                "quantity": image.quantity,
                "n_measured": len(sensor.frames),
                **measured,
            }
        )
    return {
        "file": str(looked.path),
        "format": looked.format,
        "why": looked.why,
        "n_frames": looked.n_frames,
        "assumed": list(looked.assumed),
        "counts": looked.counts,
        "troubles": [{"where": a, "what": b} for a, b in looked.troubles],
        "sessions": [session._asdict() for session in looked.sessions],
        "sensors": sensors,
    }


def lines_of(looked: Looked) -> Iterator[str]:
    """Yield what was found in lines for people."""
    yield f"{looked.path}{f', sensor {looked.chosen}' if looked.chosen else ''}"
    yield _line("format", looked.format + (f" ({looked.why})" if looked.why else ""))
    yield from _recorded(looked)
    for what in looked.assumed:
        yield _line("assumed", what.replace("whose pitch is assumed to be 1 cm", "a pitch of 1 cm"))
    for sensor in looked.sensors:
        yield from _sensor(sensor, looked)
    for what, n in looked.counts.items():
        yield _line("counted", f"{what}: {n}")
    for where, what in looked.troubles[:MOST_TOLD]:
        yield _line("", f"{where}: {what}")
    if len(looked.troubles) > MOST_TOLD:
        yield _line("", f"… and {len(looked.troubles) - MOST_TOLD} more")


def _sensor(sensor: Sensor, looked: Looked) -> Iterator[str]:
    measured, image = sensor.measured, sensor.frames[0].image
    unit = unit_of(image.quantity)
    x, y = image.pitch_cm
    known = "assumed: give pitch_cm" if looked.pitch_assumed else "known"
    if sensor.label:
        yield _line("sensor", sensor.label)
    only = f", of which {len(sensor.frames)} are measured here"
    yield _line(
        "frames", f"{sensor.n_frames}{only if sensor.n_frames > len(sensor.frames) else ''}"
    )
    yield _line("rate", _rate(measured))
    yield _line("grid", f"{image.rows} rows x {image.columns} columns")
    yield _line("pitch", f"{x:.4g} x {y:.4g} cm ({known}), so {_size(sensor)}")
    if image.origin_cm != (0.0, 0.0):
        yield _line("origin", "({:.6g}, {:.6g}) cm, its top left corner".format(*image.origin_cm))
    unsaid = ", as no unit that is known says what they mean" if image.quantity == "raw" else ""
    yield _line("quantity", f"{image.quantity}{unsaid}")
    yield _line("range", _range(measured, unit))
    yield _line("noise", _noise(measured, unit))
    spread = f"; {_number(measured.offset_spread)} between cells"
    yield _line("offset", f"{_number(measured.offset)} {unit} at rest{spread}")
    for name, cells in (
        ("dead", measured.dead),
        ("stuck", measured.stuck),
        ("noisy", measured.noisy),
        ("missing", measured.missing),
    ):
        yield _line(f"{name}", _cells(cells))
    if measured.n_gaps:
        yield _line("gaps", f"{measured.n_gaps} frames follow one")
    if measured.n_truths:
        yield _line("truth", f"known for {measured.n_truths} frames")
    n, stays = measured.n_contacts, measured.n_lasting
    lasting = f", {stays} of them in every frame" if stays and measured.n_frames > 1 else ""
    rise, above = ("rise", "above") if measured.falls is None else ("fall", "below")
    yield _line(
        "contacts",
        f"{median(n):g} a frame as a rule, {min(n)} to {max(n)}{lasting} (patches of two cells or"
        f" more that {rise} {_number(measured.contact_level)} {unit} {above} rest)",
    )
    if (falls := measured.falls) is not None:
        yield _line("falling", f"by up to {_number(falls.most)} {unit} in {falls.frames} frames,"
                    " and readings hardly rise in any; steps take those that")  # fmt: skip
        yield _line("", f"rise: --with invert_from={_number(measured.offset)} turns them round")
    if told := ghosts_told(measured.n_ghosts, measured.n_telling):
        yield _line("ghosts", told)


def _recorded(looked: Looked) -> Iterator[str]:
    sessions = looked.sessions
    for k, (frame, started) in enumerate(sessions[:MOST_TOLD]):
        since = f", from frame {frame} on" if frame else ""
        yield _line("" if k else "recorded", _wall_clock(started) + since)
    if n := len(sessions[MOST_TOLD:]):
        last = _wall_clock(sessions[-1].started)
        yield _line("", f"… and {n} more, the last {last}")


def _wall_clock(text: str) -> str:
    """Return an ISO 8601 time as people write it."""
    return f"{text[:10]} {text[11:19]} {text[19:]}"


def _line(name: str, text: str) -> str:
    return f"  {name:<9} {text}"


def _size(sensor: Sensor) -> str:
    image = sensor.frames[0].image
    return f"{image.columns * image.pitch_cm[0]:.4g} x {image.rows * image.pitch_cm[1]:.4g} cm"


def _rate(measured: Measured) -> str:
    if measured.rate_hz is None:
        return "unknown: the frames have no times"
    even = "in bursts of one time"
    if (jitter := measured.jitter) is not None:
        even = "even" if jitter < 0.02 else f"uneven by {jitter:.0%}"
    if n := measured.n_leaps:
        even += f" but for {n} {'leap' if n == 1 else 'leaps'} ahead or back"
    return f"{measured.rate_hz:.4g} frames a second, {even}, over {measured.duration_s:.4g} s"


def _range(measured: Measured, unit: str) -> str:
    text = f"{_number(measured.lowest)} to {_number(measured.highest)} {unit}"
    if measured.step is not None:
        text += f", in steps of {_number(measured.step)}"
    if measured.sign_lost:
        text += "; those just below 65536 look like negative numbers written without their sign"
    elif measured.full_scale is not None:
        text += f"; {measured.full_scale} is a converter's end: such readings may be cut off"
    return text


def _noise(measured: Measured, unit: str) -> str:
    if measured.noise is None:
        return "unknown: too few frames"
    if measured.noise == 0.0:
        return "0: readings at rest repeat, frame after frame"
    return (
        f"{_number(measured.noise)} {unit} from frame to frame (the quieter quarter of the cells)"
    )


def _cells(cells: Cells) -> str:
    if not cells:
        return "none"
    if len(cells) > 6 * MOST_CELLS_NAMED:
        return str(len(cells))
    named = ", ".join(f"({r}, {c})" for r, c in cells[:MOST_CELLS_NAMED])
    more = f", … {len(cells) - MOST_CELLS_NAMED} more" if len(cells) > MOST_CELLS_NAMED else ""
    return f"{len(cells)} at (row, column) {named}{more}"


def _number(value: float) -> str:
    return f"{value:.4g}"


def fullest(sensor: Sensor) -> Frame:
    """Return the frame in which most lies beyond the noise."""
    return sensor.frames[sensor.measured.fullest]


def shades_of(sensor: Sensor) -> Iterator[str]:
    """Yield a frame as lines of shaded characters, two a cell, the highest of those that merge."""
    frame = fullest(sensor)
    values = np.asarray(frame.image.filled(np.nan), dtype=np.float64)
    merged = max(1, -(-values.shape[0] // HIGHEST), -(-2 * values.shape[1] // WIDEST))
    measured = sensor.measured
    low, high = measured.offset, measured.highest
    most = np.max
    if measured.falls is not None:
        high, most = measured.lowest, np.min
    merge = f", {merged} x {merged} cells a character pair" if merged > 1 else ""
    yield (
        f"  frame {frame.index}, the fullest: {SHADES[1:]!r} from {_number(low)} to "
        f"{_number(high)}{merge}; x: no value"
    )
    yield "  +" + "-" * (2 * -(-values.shape[1] // merged)) + "+"
    for top in range(0, values.shape[0], merged):
        line = ""
        for left in range(0, values.shape[1], merged):
            block = values[top : top + merged, left : left + merged]
            block = block[np.isfinite(block)]
            line += 2 * ("x" if not block.size else _shade(float(most(block)), low, high))
        yield f"  |{line}|"
    yield "  +" + "-" * (2 * -(-values.shape[1] // merged)) + "+"


def _shade(value: float, low: float, high: float) -> str:
    share = (value - low) / (high - low) if high != low else 0.0
    return SHADES[min(len(SHADES) - 1, max(0, int(share * len(SHADES))))]
