"""How a tuned pipeline was made, as it stands in its file and beside its figures."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.cli.arguments import Span
from tactile_graph.files import sha256_of
from tactile_graph.provenance import code_digest, provenance
from tactile_graph.steps.injected import Report
from tactile_graph_compare.run.summarise import source_told


def frames_of(
    pipeline: Pipeline, recordings: Sequence[str], held_out: Sequence[str], seed: int
) -> str:
    """Return where the frames come from, in words."""
    told = ", ".join(recordings) or source_told(pipeline.source)
    apart = f", held out: {', '.join(held_out)}" if held_out else ""
    return f"{told}{apart}, seed {seed}"


def how_made(
    pipeline: Pipeline,
    span: Span,
    seed: int,
    report: Report,
    held_out: Mapping[str, str],
    truth: Path | None,
) -> dict[str, Any]:
    """Return how to make it again, as of a run.

    Parameters
    ----------
    pipeline : Pipeline
        As it was given.
    span : Span
        Which of the source's frames.
    seed : int
    report : Report
        Of the source.
    held_out : mapping of str to str
        The recordings held out, and their digests.
    truth : Path, optional
        The file that tells the truth.
    """
    return provenance(
        pipeline, seed, report,
        command=["tactile-graph", *sys.argv[1:]], frames={"from": span.start, "to": span.stop},
        held_out=held_out, truth={} if truth is None else {str(truth): sha256_of(truth)},
        code=code_digest([pipeline]),
    )  # fmt: skip
