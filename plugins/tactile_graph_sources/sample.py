"""The source step ``sample``: small recordings that come with the project."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

from tactile_graph.errors import UsageError, did_you_mean, one_of
from tactile_graph.steps import Quantity, Report
from tactile_graph.wires import Frame
from tactile_graph_sources.recording import recording

FOLDER = Path(__file__).parent / "samples"


def sample(*, name: str = "discs", report: Report) -> Iterator[Annotated[Frame, Quantity("volt")]]:
    """Frames of a small recording that comes with the project, their truth beside them.

    Parameters
    ----------
    name : str
        ``discs``: the three discs of thesis table 4.2, each in two places, on an uneven pad.
    report : Report
        As for `recording`.

    Yields
    ------
    Frame
        With truth.

    Raises
    ------
    UsageError
        If there is no sample of that name.
    """
    names = sorted(p.stem for p in FOLDER.glob("*.npz"))
    if name not in names:
        raise UsageError(
            f"no sample named {name!r}, there are: {one_of(names)}{did_you_mean(name, names)}"
        )
    yield from recording(path=FOLDER / f"{name}.npz", report=report)
