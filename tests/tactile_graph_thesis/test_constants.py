"""Settings of the studies: how many readings, which levels, and from where on a finding is refuted.

Each constant of an item or a measurement stands in ``constants.yaml`` as a literal copy: with
``--quick``, in which the other tests make items, many of them would not be noticed.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import numpy as np
import yaml

import tactile_graph_thesis

HOME = Path(tactile_graph_thesis.__path__[0])
LITERAL = yaml.safe_load((Path(__file__).parent / "constants.yaml").read_text(encoding="utf-8"))


def modules() -> Iterator[str]:
    for room in ("items", "measure", "noise"):
        for path in sorted((HOME / room).rglob("*.py")):
            yield ".".join(path.relative_to(HOME).with_suffix("").parts)


def told(value: object) -> str | None:
    """Return numbers as text, also within tuples, mappings and arrays; None for anything else."""
    if isinstance(value, bool | int | float | np.integer | np.floating):
        return f"{value:.9g}"
    if isinstance(value, np.ndarray):
        return told(tuple(value.ravel().tolist()))
    if isinstance(value, tuple | list | dict):
        items = [*value, *value.values()] if isinstance(value, dict) else value
        texts = [told(one) if not isinstance(one, str) else one for one in items]
        return None if None in texts else f"({', '.join(str(t) for t in texts)})"
    return None


def constants(module: str) -> dict[str, str]:
    """Return the numbers that a module keeps at its top."""
    names = vars(import_module(f"tactile_graph_thesis.{module}"))
    found = {n: told(value) for n, value in names.items() if n.isupper() and n != "TYPE_CHECKING"}
    return {n: text for n, text in sorted(found.items()) if text is not None}


def test_every_constant_is_the_literal_one() -> None:
    found = {module: constants(module) for module in modules()}
    assert {module: some for module, some in found.items() if some} == LITERAL
