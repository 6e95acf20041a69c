"""Values a setting is to take one after the other: ``0.005:0.03:0.0025`` or ``cross3, disc5``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, DecimalException
from itertools import product
from typing import Any

from tactile_graph.errors import UsageError, shown
from tactile_graph.inspect import plain
from tactile_graph.pipeline.document import read_document

MOST_VALUES = 500
_NUMBER = r"\s*[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\s*"
_RANGE = re.compile(f"({_NUMBER}):({_NUMBER}):({_NUMBER})")


@dataclass(frozen=True)
class Sweep:
    """A setting, ``node.setting``, and the values it takes in turn."""

    name: str
    values: tuple[Any, ...]


def parse_sweep(text: str) -> Sweep:
    """Return the sweep that ``node.setting=start:stop:step`` or ``node.setting=a,b,c`` spells.

    A range holds its stop where whole steps lead there; values of a list are YAML.

    Raises
    ------
    UsageError
        If it is none of them, never ends, or holds more than `MOST_VALUES` values.
    """
    name, sign, given = text.partition("=")
    name = name.strip()
    if not sign or "." not in name.strip("."):
        raise UsageError(
            f"--sweep {text}: must be node.setting=start:stop:step or node.setting=a,b,c"
        )
    found = _RANGE.fullmatch(given)
    values = _range(text, *found.groups()) if found else _list(text, given)
    if len(values) > MOST_VALUES:
        raise UsageError(f"--sweep {text}: more than {MOST_VALUES} values")
    return Sweep(name, values)


def _range(text: str, *parts: str) -> tuple[Any, ...]:
    try:
        start, stop, step = (Decimal(p.strip()) for p in parts)
        steps = (stop - start) / step if step else Decimal(0)
    except DecimalException:
        raise UsageError(f"--sweep {text}: this range is out of reach") from None
    if step == 0 or (stop - start) * step < 0:
        raise UsageError(f"--sweep {text}: a step of {step} does not lead from {start} to {stop}")
    if steps >= MOST_VALUES:  # before it is made an integer: that may have a million digits
        raise UsageError(f"--sweep {text}: more than {MOST_VALUES} values")
    whole = not any(c in p for p in parts for c in ".eE")
    values = [start + k * step for k in range(int(steps) + 1)]
    return tuple(int(v) if whole else float(v) for v in values)


def _list(text: str, given: str) -> tuple[Any, ...]:
    document = read_document(f"[{given}]", "--sweep")
    if document.problems or not document.data:
        raise UsageError(f"--sweep {text}: must be values as in YAML, parted by commas")
    values = document.data
    if any(values.count(v) > 1 for v in values):
        raise UsageError(f"--sweep {text}: a value stands there twice")
    return tuple(values)


def sweep_of(name: str, values: Any) -> Sweep:
    """Return the sweep of a setting over values that a program gives.

    Raises
    ------
    UsageError
        If they are no values one after the other, none, or one of them twice.
    """
    if isinstance(values, str | bytes | Mapping) or not isinstance(values, Iterable):
        raise UsageError(f"sweeps: {name} must be a list of values, got {shown(values)}")
    found = tuple(values)
    if not found:
        raise UsageError(f"sweeps: {name} has no values")
    plain_ones = [plain(v) for v in found]
    if any(plain_ones.count(v) > 1 for v in plain_ones):
        raise UsageError(f"sweeps: {name}: a value stands there twice")
    return Sweep(name, found)


def combinations(
    sweeps: Sequence[Sweep], crossed: bool, crosses: str = "--product"
) -> Iterator[Mapping[str, Any]]:
    """Yield the settings of each variant of several sweeps: side by side, or all with all.

    Parameters
    ----------
    sweeps : sequence of Sweep
    crossed : bool
    crosses : str
        What is given to cross them, for errors.

    Raises
    ------
    UsageError
        If sweeps that go side by side differ in length.
    """
    counts = {s.name: len(s.values) for s in sweeps}
    if not crossed and len(set(counts.values())) > 1:
        told = ", ".join(f"{name} has {n} values" for name, n in counts.items())
        raise UsageError(
            f"sweeps go side by side, but {told}; {crosses} crosses every value with every other"
        )
    rows = product(*(s.values for s in sweeps)) if crossed else zip(*(s.values for s in sweeps),
                                                                     strict=True)  # fmt: skip
    for row in rows:
        yield {s.name: v for s, v in zip(sweeps, row, strict=True)}
