"""A learned pad as files: YAML for the whole, a table of elements, the correction of place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from tactile_graph.files import write_whole
from tactile_graph_pads.learned import write_elements
from tactile_graph_pads.learning.learn import LearnedPad
from tactile_graph_pads.learning.place import write_place
from tactile_graph_pads.pad import Pad

MOST_NAMED, MOST_CHARACTERS = 5, 400
TOLD = ("geometry", "law", "circuit", "converter", "scan", "contact")


@dataclass(frozen=True)
class Making:
    """How a pad file came about, for its head.

    Parameters
    ----------
    command : str
        What was typed.
    made_by, made_at : str
    recordings : mapping
        SHA-256 by file name.
    pad : str
        The pad that was told; empty for none.
    """

    command: str
    made_by: str
    made_at: str
    recordings: Mapping[str, str]
    pad: str = ""


def files_of(path: Path) -> tuple[Path, Path, Path]:
    """Return the files of a learned pad: the YAML, and beside it its elements and its place."""
    elements, place = (path.with_name(f"{path.stem}.{e}") for e in ("elements.csv", "place.npz"))
    return path, elements, place


def write_pad(path: Path, found: LearnedPad, base: Pad | None, making: Making) -> list[Path]:
    """Write a learned pad, and return all files it lies in.

    Parameters
    ----------
    path : Path
        Of the YAML file; the others lie beside it under its name.
    found : LearnedPad
    base : Pad, optional
        The pad that was told.
    making : Making
    """
    _, table, place = files_of(path)
    files = [table]
    write_elements(table, found.elements)
    learned = replace(found.learned, elements=table.name)
    if found.place is not None and found.place.helps:
        write_place(place, found.place.correction)
        files.append(place)
        learned = replace(learned, place=place.name)
    write_whole(path, pad_text(replace(found, learned=learned), base, making))
    return [path, *files]


def pad_text(found: LearnedPad, base: Pad | None, making: Making) -> str:
    """Return the YAML text of a learned pad."""
    from tactile_graph.pipeline.document import in_yaml

    sections = _sections(found, base)
    body = in_yaml(
        _plain(sections), sort_keys=False, allow_unicode=True, default_flow_style=None, width=96
    )
    return _head(sections, making) + body


def _head(sections: Mapping[str, Any], making: Making) -> str:
    told = making.pad or "no pad"
    absent = [name for name in ("law", "circuit") if name not in sections]
    lines = [
        f"Made by {making.made_by} on {making.made_at}: {_cut(making.command)}",
        f"Told beforehand: {told}. Learned: noise and offset of each element and the rest of the "
        "section 'learned'.",
    ]
    if absent:
        lines.append(
            f"Nobody said its {' and '.join(absent)}: a step that asks for them takes the thesis'."
        )
    named = list(making.recordings.items())
    lines += [f"SHA-256 of {name}: {digest[:16]}…" for name, digest in named[:MOST_NAMED]]
    if len(named) > MOST_NAMED:
        of_all = sha256("".join(digest for _, digest in named).encode()).hexdigest()
        lines.append(f"SHA-256 of the digests of all {len(named)} recordings: {of_all[:16]}…")
    return "".join(f"# {line}\n" for line in lines)


def _cut(command: str) -> str:
    return command if len(command) <= MOST_CHARACTERS else f"{command[: MOST_CHARACTERS - 1]}…"


def _sections(found: LearnedPad, base: Pad | None) -> dict[str, Any]:
    told = {} if base is None else {name: asdict(getattr(base, name)) for name in TOLD}
    sections: dict[str, Any] = {"about": _about(found), **told}
    if base is None:
        sections["geometry"] = _geometry(found)
    if (noise_v := _noise_v(found, base)) is not None:
        sections["scan"] = {"samples": 1, "noise_v": noise_v}
        if base is None:
            sections["converter"] = {"bits": None}  # its rounding is within the noise as seen
    turn_on = found.learned.turn_on
    if turn_on is not None and turn_on.of == "gram" and "law" in sections:
        sections["law"]["turn_on_g"] = turn_on.reading
    if found.unevenness is not None:
        sections["unevenness"] = found.unevenness._asdict()
    sections["defects"] = _defects(found)
    return {**sections, "learned": asdict(found.learned)}


def _about(found: LearnedPad) -> str:
    learned = found.learned
    return f"{learned.rows} x {learned.columns} elements, learned from recordings"


def _geometry(found: LearnedPad) -> dict[str, Any]:
    """Return square elements without gaps as large as the recorded ones: all that is known."""
    learned = found.learned
    side = float(np.sqrt(learned.pitch_cm[0] * learned.pitch_cm[1]))
    return {
        "rows": learned.rows, "columns": learned.columns, "element_cm": side, "gap_cm": 0.0
    }  # fmt: skip


def _noise_v(found: LearnedPad, base: Pad | None) -> float | None:
    """Return the noise in volts without the rounding of the converter that is told."""
    learned = found.learned
    if learned.reading == "volt":
        noise_v = learned.noise
    elif learned.reading == "counts" and base is not None:
        noise_v = learned.noise * base.converter.step_v
    else:
        return None
    if base is None or base.converter.bits is None:
        return noise_v
    return float(np.sqrt(max(noise_v**2 - base.converter.step_v**2 / 12.0, 0.0)))


def _defects(found: LearnedPad) -> dict[str, Any]:
    dead = found.elements.state == "dead"
    if found.silence is None or not dead.any():
        return {}
    rows, columns = found.silence.dead_rows, found.silence.dead_columns
    single = dead.copy()
    single[list(rows), :] = False
    single[:, list(columns)] = False
    return {
        "dead_rows": list(rows),
        "dead_columns": list(columns),
        "dead_elements": [[int(r), int(c)] for r, c in np.argwhere(single)],
    }


def _plain(data: Any) -> Any:
    if isinstance(data, Mapping):
        return {str(k): _plain(v) for k, v in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(v) for v in data]
    if isinstance(data, np.generic):
        data = data.item()
    return float(f"{data:.6g}") if isinstance(data, float) else data
