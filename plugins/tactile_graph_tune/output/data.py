"""What was found as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from tactile_graph.inspect import as_data, without_nan
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.tuned import CHOSEN, Point, Tuned


def as_json(tuned: Tuned, provenance: Mapping[str, Any]) -> str:
    """Return all figures as a JSON text.

    Parameters
    ----------
    tuned : Tuned
    provenance : mapping
        How to make it again.
    """
    data = {
        "judged": as_data(tuned.judged),
        "frames": {"choosing": tuned.n_choosing, "reporting": tuned.n_reporting, "how": tuned.how},
        "weighed": tuned.n_weighed,
        "points": {label: _point(p) for label, p in tuned.points.items()},
        "front": [_point(p) for p in tuned.front],
        "oracle_us": {label: tuned.oracle_us(label) for label in tuned.points},
        "everything_us": tuned.everything_us,
        "guards": [as_data(w) for w in tuned.worths],
        "settings": as_data(tuned.settings),
        "as_good": as_data(tuned.as_good),
        "time_ratio": as_data(tuned.ratio),
        "difference": as_data(tuned.difference),
        "share_of_saving": tuned.share_of_saving(CHOSEN),
        "provenance": provenance,
    }
    return json.dumps(without_nan(data), indent=1, ensure_ascii=False) + "\n"


def _point(point: Point) -> dict[str, Any]:
    told = {"predicted": as_data(point.weight), **_choice(point.choice)}
    return told if point.rerun is None else {**told, "run": as_data(point.rerun)}


def _choice(choice: Choice) -> dict[str, Any]:
    asked = {place: [c.text for c in cs] for place, cs in choice.chosen.items()}
    return {"order": list(choice.order), "guards": asked}
