"""A summary as plain data, for programs."""

from __future__ import annotations

import math
from typing import Any

from tactile_graph.cli.summary.quantiles import Numbers
from tactile_graph.cli.summary.summary import SHARES, Group, Summary

TURNS = ("°", "rad")
"""Units of angles, whose mean is none where they wrap."""


def as_data(summary: Summary) -> dict[str, Any]:
    """Return a summary as plain data; what there is none of is None."""
    return {
        "frames": summary.frames,
        "lasts_s": summary.lasts_s,
        **_group(summary, summary.all),
        "recordings": [
            {
                "recording": name,
                "frames": g.frames,
                "lasts_s": g.times.lasts_s,
                **_group(summary, g),
            }
            for name, g in summary.recordings.items()
        ],
    }


def _group(summary: Summary, group: Group) -> dict[str, Any]:
    return {
        "outcomes": {output: dict(words) for output, words in group.outcomes.items()},
        "quantities": {key: _numbers(summary, group, key) for key in group.numbers},
        "texts": {key: dict(words) for key, words in group.texts.items()},
    }


def _numbers(summary: Summary, group: Group, key: str) -> dict[str, Any]:
    numbers, unit = group.numbers[key], summary.unit(key)
    told = {
        "unit": unit,
        "n": numbers.n,
        "not_finite": numbers.n_not_finite,
        "mean": mean_of(numbers, unit),
        "least": numbers.least,
        "most": numbers.most,
    }
    if key in group.signed:
        told["bias"] = group.signed[key].mean
    for share, value in zip(SHARES, numbers.quantiles(SHARES), strict=True):
        told["median" if share == 0.5 else f"p{100 * share:g}"] = float(value)
    return {k: _known(v) for k, v in told.items()}


def mean_of(numbers: Numbers, unit: str) -> float:
    """Return the mean; NaN of angles, which have none."""
    return math.nan if unit in TURNS else numbers.mean


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value
