"""How the comparison was made, and how to make it again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tactile_graph.foreign_text import pasted, pasted_words
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.report.markup import Html, details, join, tag
from tactile_graph_compare.variants.request import as_yaml


def provenance(comparison: Comparison) -> Html:
    """Return the command, versions and source, and the pipelines folded away."""
    told = comparison.provenance
    rows = [
        *(told.get("versions") or {}).items(),
        *((f"plugins {k}", _plain(v)) for k, v in (told.get("plugins") or {}).items()),
        ("source", comparison.source),
        ("frames", comparison.frames.n),
        ("seed", told.get("seed", "")),
        ("took", f"{comparison.seconds:.3g} s"),
    ]
    body = tag("tbody", (_row(k, v) for k, v in rows))
    caption = tag("caption", tag("b", "Versions and source"))
    return join(
        _again(comparison),
        details("Versions and source", tag("table", caption, body, class_="data words")),
        [_variant(label, v) for label, v in (told.get("variants") or {}).items()],
        details("All of it, as data", tag("pre", _plain(told))),
    )


def _again(comparison: Comparison) -> Html:
    """Return the command that makes it again, or why there is none."""
    own = [v.label for v in comparison.variants if not v.given]
    if own and not _typed(comparison.provenance):
        told = "Made by a program, and no command makes it again, for no installed pipeline or file"
        return tag("p", f"{told} is what it ran as: {', '.join(own)}.")
    again = "To make it again:"
    if not _step(comparison.provenance):
        again = "The frames were handed in by a program. With a recording of them it is made by:"
    return join(tag("p", again), tag("pre", tag("code", command(comparison)), class_="command"))


def _typed(told: Mapping[str, Any]) -> list[str]:
    """Return the words of the command that was typed; none where a program compared."""
    typed = [str(w) for w in told.get("command") or ()]
    ours = typed and Path(typed[0]).stem in ("tactile-graph", "__main__") and "compare" in typed
    return typed if ours else []


def _row(name: str, value: object) -> Html:
    return tag("tr", tag("th", name, scope="row", class_="words"), tag("td", str(value)))


def _variant(label: str, told: Mapping[str, Any]) -> Html:
    return details(f"Pipeline of {label}", tag("pre", _plain(told.get("pipeline", told))))


def _plain(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, indent=2, default=str,
                                                           ensure_ascii=False)  # fmt: skip


def command(comparison: Comparison) -> str:
    """Return what to type: what was typed, or where nothing was, what amounts to it."""
    told = comparison.provenance
    if typed := _typed(told):
        return pasted_words(["tactile-graph", *typed[1:]])
    words = ["tactile-graph", "compare", *(v.given for v in comparison.variants)]
    if _step(told):
        words += ["--source", pasted(_step(told))]
        for key, value in (told["source"].get("with") or {}).items():
            if value is not None:
                words += ["--with", pasted(f"{key}={as_yaml(value)}")]
        words += ["--frames", _span(told, comparison.frames.n)]
    else:
        words.append("RECORDING")
    words += ["--seed", str(told.get("seed", 0))]
    return " ".join([*words, "--report", "report.html"])


def _step(told: Mapping[str, Any]) -> str:
    """Return the source step; empty where frames were handed in."""
    source = told.get("source")
    return str(source.get("step") or "") if isinstance(source, Mapping) else ""


def _span(told: Mapping[str, Any], n: int) -> str:
    """Return which frames of the source there were, as on a command line."""
    start = (told.get("frames") or {}).get("from", 0)
    return f"{start}:{start + n}" if start else str(n)
