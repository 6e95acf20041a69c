"""Write a comparison for programs: CSV and JSON, whole files or none."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tactile_graph.files import said, write_whole
from tactile_graph.foreign_text import csv_line, visible
from tactile_graph.inspect import plain, without_nan
from tactile_graph_compare.records.comparison import Comparison, Evolution, Variant
from tactile_graph_compare.records.scores import Score

Row = Sequence[Any]

ERRORS = ("frame", "time_s", "label", "variant", "quantity", "unit", "object", "error", "answered")
TIMES = ("frame", "time_s", "label", "variant", "time_us", "reused", "nodes_run", "nodes_not_run",
         "nodes_failed")  # fmt: skip
SCORES = ("variant", "quantity", "unit", "mean", "median", "p95", "largest", "bias", "n_answered",
          "n_missing", "n_extra", "pareto")  # fmt: skip
DIFFERENCES = ("variant", "reference", "quantity", "unit", "mean", "low", "high", "level",
               "method", "n_both", "n_only_variant", "n_only_reference", "n_neither",
               "verdict", "p")  # fmt: skip

AGREEMENTS = ("variant", "reference", "quantity", "unit", "mean", "median", "p95", "largest",
              "bias", "n_both", "n_only_variant", "n_only_reference", "n_neither")  # fmt: skip
APART = ("frame", "time_s", "label", "variant", "reference", "quantity", "unit", "difference")


IN_FOLDER = ("errors.csv", "times.csv", "scores.csv", "differences.csv", "agreement.csv",
             "apart.csv")  # fmt: skip


def csv_files(path: str | Path) -> list[Path]:
    """Return the files that `write_csv` may write."""
    path = Path(path)
    return [path] if path.suffix.lower() == ".csv" else [path / name for name in IN_FOLDER]


def write_csv(comparison: Comparison, path: str | Path) -> list[str]:
    """Write the errors to a ``.csv`` file, or all to a folder; return what was written.

    Parameters
    ----------
    comparison : Comparison
    path : str or Path
        A name that ends in ``.csv`` is a file: a row for each frame, variant, quantity and true
        object. Any other is a folder, made where there is none, that gets ``errors.csv`` (the
        same), ``times.csv`` (a row a frame and variant), ``scores.csv`` and ``differences.csv``;
        where variants were held against one another, ``apart.csv`` (a row for each pair of
        answers) and ``agreement.csv``.
    """
    path = Path(path)
    if path.suffix.lower() == ".csv":
        write_whole(path, csv_text(ERRORS, error_rows(comparison)))
        return [str(path)]
    with said(path):
        path.mkdir(exist_ok=True)
    files = {
        "errors.csv": csv_text(ERRORS, error_rows(comparison)),
        "times.csv": csv_text(TIMES, time_rows(comparison)),
        "scores.csv": csv_text(SCORES, (_fields(s, SCORES) for s in comparison.scores)),
        "differences.csv": csv_text(
            DIFFERENCES, (_fields(d, DIFFERENCES) for d in comparison.differences)
        ),
    }
    if comparison.agreements:
        rows = (_fields(a, AGREEMENTS) for a in comparison.agreements)
        files["agreement.csv"] = csv_text(AGREEMENTS, rows)
        files["apart.csv"] = csv_text(APART, apart_rows(comparison))
    for name, text in files.items():
        write_whole(path / name, text)
    return [str(path / name) for name in files]


def error_rows(comparison: Comparison) -> Iterator[Row]:
    """Yield a row for each target; the object's number and the error are empty where unknown."""
    for score in comparison.scores:
        for position, number, error in zip(
            score.positions.tolist(), score.objects.tolist(), score.errors.tolist(), strict=True
        ):
            known = not math.isnan(error)
            of_object = number if number >= 0 else ""
            yield (*_frame(comparison, position), score.variant, score.quantity, score.unit,
                   of_object, error if known else "", int(known))  # fmt: skip


def apart_rows(comparison: Comparison) -> Iterator[Row]:
    """Yield a row for each pair of answers."""
    for a in comparison.agreements:
        for position, off in zip(a.positions.tolist(), a.differences.tolist(), strict=True):
            yield (*_frame(comparison, position), a.variant, a.reference, a.quantity, a.unit, off)


def time_rows(comparison: Comparison) -> Iterator[Row]:
    """Yield a row for each variant and frame."""
    for v in comparison.variants:
        ran, not_run = v.timeline.ran.tolist(), v.timeline.not_run.tolist()
        failed = (v.timeline.states == 3).sum(axis=1).tolist()
        for i, time_us in enumerate(v.times.per_frame_us.tolist()):
            reused = bool(comparison.frames.reused[i])
            spent = 0.0 if reused else "" if math.isnan(time_us) else round(time_us, 3)
            yield (*_frame(comparison, i), v.label, spent, int(reused), ran[i], not_run[i],
                   failed[i])  # fmt: skip


def _frame(comparison: Comparison, position: int) -> Row:
    frames = comparison.frames
    time_s = float(frames.times_s[position])
    known = "" if math.isnan(time_s) else time_s
    return (int(frames.indices[position]), known, frames.labels[position])


def _fields(record: Any, names: Sequence[str]) -> Row:
    return [getattr(record, name) for name in names]


def csv_text(names: Row, rows: Iterable[Row]) -> str:
    """Return CSV with a line of names."""
    return "".join(map(csv_line, (names, *rows)))


# -- JSON ------------------------------------------------------------------------------------


def as_json(comparison: Comparison) -> str:
    """Return all but images and rows per frame as one JSON object, ``null`` where nothing is."""
    c = comparison
    data = {
        "source": c.source,
        "frames": {
            "n": c.frames.n,
            "n_reused": int(c.frames.reused.sum()),
            "n_without_truth": int((c.frames.n_true < 0).sum()),
            "n_left_out": c.n_left_out,
        },
        "complete": not c.interrupted,
        "notes": list(c.notes),
        "seconds": c.seconds,
        "fixed_us": c.fixed_us,
        "saving": {**asdict(c.saving), "share": c.saving.share},
        "variants": [_variant(v) for v in c.variants],
        "scores": [_named(s, SCORES) for s in c.scores],
        "differences": [_named(d, DIFFERENCES) for d in c.differences],
        "reference": c.reference or None,
        "agreements": [_named(a, AGREEMENTS) for a in c.agreements],
        "time_differences": [asdict(t) for t in c.time_differences],
        "lineage": [_evolution(e) for e in c.lineage],
        "nodes": [_node(n) for n in c.graph.nodes],
        "edges": [asdict(e) for e in c.graph.edges],
        "chosen": [
            {"frame": f.frame.index, "position": f.position, "why": [str(x) for x in f.choices],
             "errors": f.errors}
            for f in c.chosen
        ],
        "provenance": c.provenance,
    }  # fmt: skip
    text = json.dumps(without_nan(plain(data)), indent=1, ensure_ascii=False, allow_nan=False)
    return visible(text) + "\n"


def _named(record: Score | Any, names: Sequence[str]) -> dict[str, Any]:
    return dict(zip(names, _fields(record, names), strict=True))


def _variant(v: Variant) -> dict[str, Any]:
    ran, not_run = v.timeline.ran, v.timeline.not_run
    keys = ("state", "output", "origin", "reason", "frames")
    return {
        "label": v.label,
        "given": v.given,
        "asked": v.asked,
        "parent": v.parent or None,
        "median_us": v.times.median_us,
        "p95_us": v.times.p95_us,
        "mean_us": v.times.mean_us,
        "nodes_run": float(ran.mean()) if ran.size else None,
        "nodes_not_run": float(not_run.mean()) if not_run.size else None,
        "n_ok": v.n_ok,
        "n_skipped": v.n_skipped,
        "n_failed": v.n_failed,
        "reasons": [dict(zip(keys, row, strict=True)) for row in v.reasons],
    }


def _evolution(e: Evolution) -> dict[str, Any]:
    return {
        "parent": e.parent,
        "child": e.child,
        "added": e.added,
        "removed": e.removed,
        "changed": {n.node: {c.what: [c.before, c.after] for c in n.changes} for n in e.changed},
        "kept": e.kept,
        "time_ratio": e.time.ratio,
    }


def _node(node: Any) -> dict[str, Any]:
    names = ("name", "own_name", "kind", "what", "settings", "guard", "own_names", "new_in",
             "output_of", "stateful", "n_ran", "n_skipped", "n_failed", "n_not_asked", "time_us",
             "total_s")  # fmt: skip
    return _named(node, names)
