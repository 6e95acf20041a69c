"""A summary as plain data, for programs."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

from tactile_graph.cli.summary.summary import SHARES, Group, Quantity, Summary


def as_data(summary: Summary) -> dict[str, Any]:
    """Return a summary as plain data; what there is none of is None."""
    return {
        "frames": summary.frames,
        "lasts_s": summary.lasts_s,
        **_group(summary.all),
        "recordings": [
            {
                "recording": name,
                "frames": g.frames,
                "lasts_s": g.times.lasts_s,
                **_group(g),
            }
            for name, g in summary.recordings.items()
        ],
    }


def _group(group: Group) -> dict[str, Any]:
    n_units = Counter(quantity.key for quantity in group.numbers)
    return {
        "outcomes": {output: dict(words) for output, words in group.outcomes.items()},
        "quantities": {
            _name(q) if n_units[q.key] > 1 else q.key: _numbers(group, q) for q in group.numbers
        },
        "texts": {key: dict(words) for key, words in group.texts.items()},
    }


def _name(quantity: Quantity) -> str:
    """Return the name of a column that is there in several units."""
    return f"{quantity.key} [{quantity.unit or '?'}]"


def _numbers(group: Group, quantity: Quantity) -> dict[str, Any]:
    numbers, found = group.numbers[quantity], group.statistics(quantity)
    told = {
        "unit": quantity.unit,
        "n": numbers.n,
        "not_finite": numbers.n_not_finite,
        "mean": found.mean,
        "least": found.least,
        "most": found.most,
    }
    if quantity in group.signed:
        told["bias"] = group.signed[quantity].mean
    for share, value in zip(SHARES, found.quantiles, strict=True):
        told["median" if share == 0.5 else f"p{100 * share:g}"] = float(value)
    return {k: _known(v) for k, v in told.items()}


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value
