"""``tactile-graph convert``: a recording in another format."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from tactile_graph.wires.frame import Frame

KINDS = (".zarr", ".npz", ".csv")


@click.command()
@click.argument("source", type=click.Path(exists=True, path_type=Path))
@click.argument("target", type=click.Path(path_type=Path))
@click.option("--rows", type=click.IntRange(min=1), help="Rows, where the file cannot tell.")
@click.option("--columns", type=click.IntRange(min=1), help="Columns, likewise.")
@click.option("--pitch-cm", type=click.FloatRange(min=0, min_open=True), help="Pitch, likewise.")
@click.option("--quantity", help="What the values mean, likewise.")
def convert(
    source: Path,
    target: Path,
    rows: int | None,
    columns: int | None,
    pitch_cm: float | None,
    quantity: str | None,
) -> None:
    """Convert the recording SOURCE to TARGET: .zarr, .npz or .csv by its name.

    SOURCE is a Zarr store or any file that the source 'recording' reads.
    """
    from tactile_graph.errors import UsageError
    from tactile_graph.files import check_target
    from tactile_graph.steps.injected import Report
    from tactile_graph_sources.recording import recording

    if target.suffix not in KINDS:
        raise click.UsageError(f"TARGET must end in {', '.join(KINDS)}, got {target.name!r}")
    if target.exists():
        raise click.UsageError(f"{target} is there already")
    check_target("TARGET", target)
    told: dict[str, Any] = {
        "rows": rows,
        "columns": columns,
        "pitch_cm": pitch_cm,
        "quantity": quantity,
    }
    report = Report()
    kept = _Kept()
    try:
        frames = recording(path=source, report=report, **told)
        n = _write(target, kept.watch(frames), source)
    except ValueError as error:
        raise UsageError(str(error)) from error
    click.echo(f"{target}: {n} frame{'s' if n != 1 else ''}")
    for where, what in report.troubles:
        click.echo(f"{where}: {what}", err=True)
    if target.suffix == ".csv" and kept.names:
        click.echo(f"left out, as a table has no place for it: {', '.join(kept.names)}", err=True)


def _write(target: Path, frames: Iterator[Frame], source: Path) -> int:
    from tactile_graph_sources.writers.write_csv import write_csv
    from tactile_graph_sources.writers.write_npz import write_npz
    from tactile_graph_sources.writers.write_store import StoreWriter

    if target.suffix == ".npz":
        return write_npz(target, frames)
    if target.suffix == ".csv":
        return write_csv(target, frames)
    with StoreWriter(target, about={"converted_from": source.name}) as store:
        for frame in frames:
            store.write(frame)
    return store.n_frames


class _Kept:
    """Notes what frames carry that a table cannot."""

    def __init__(self) -> None:
        self.names: dict[str, None] = {}

    def watch(self, frames: Iterator[Frame]) -> Iterator[Frame]:
        for frame in frames:
            for name, there in (
                ("truth", frame.truth is not None),
                ("device time", frame.device_time_s is not None),
                ("gaps", frame.gap),
                ("labels", bool(frame.label)),
            ):
                if there:
                    self.names[name] = None
            yield frame
