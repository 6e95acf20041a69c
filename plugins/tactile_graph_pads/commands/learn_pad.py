"""``tactile-graph learn-pad``: from recordings of a pad to the file that describes it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import reader_settings, with_option
from tactile_graph.cli.say import say

if TYPE_CHECKING:
    from tactile_graph_pads.learning.learn import LearnedPad
    from tactile_graph_pads.learning.pad_file import Making
    from tactile_graph_pads.learning.recordings import Stack


@click.command("learn-pad")
@click.argument("recordings", nargs=-1, metavar="[FILE | FILE=GRAMS]...")
@click.option("-e", "--empty", multiple=True, type=click.Path(exists=True, path_type=Path),
              help="A recording of the pad with nothing on it; may be repeated.")  # fmt: skip
@click.option("-o", "--output", type=click.Path(dir_okay=False, path_type=Path),
              help="Where the pad goes (.yaml); without it, it is only said.")  # fmt: skip
@click.option("--overwrite", is_flag=True,
              help="Write the pad over files that are there, edited or not.")  # fmt: skip
@click.option("--plots", type=click.Path(dir_okay=False, path_type=Path),
              help="A page of plots that says how good it is (.html).")  # fmt: skip
@click.option("--places", type=click.Path(exists=True, dir_okay=False, path_type=Path),
              help="Where objects lay, where recordings do not say so themselves: CSV (recording, "
              "x_cm, y_cm, and frame if frames differ).")  # fmt: skip
@with_option
@click.option("--pad", "pad_name", help="A pad by name or file that has the same converter, "
              "circuit and law: gains and turn-on are then learned in grams.")  # fmt: skip
def learn_pad(
    recordings: tuple[str, ...],
    empty: tuple[Path, ...],
    output: Path | None,
    overwrite: bool,
    plots: Path | None,
    places: Path | None,
    source_settings: tuple[str, ...],
    pad_name: str | None,
) -> None:
    """Learn what a pad is like from recordings of it, and write a pad file.

    An empty recording tells noise, offset and stuck elements. Recordings with objects, known or
    not, tell dead elements and lines, relative gains, unevenness and turn-on; of known weight
    (FILE=GRAMS, or as the recording says) a law; at known places a correction of place.
    """
    from tactile_graph.errors import UsageError
    from tactile_graph_pads.learning.learn import learn_pad as learn
    from tactile_graph_pads.learning.pad_file import write_pad
    from tactile_graph_pads.pad import load_pad

    _check(recordings, empty, output, plots, overwrite)
    base = None if pad_name is None else load_pad(pad_name)
    if base is not None and base.learned is not None:
        raise UsageError(f"--pad {pad_name}: was learned itself; give the pad it was based on")
    stacks = _read(recordings, empty, places, source_settings)
    found = learn(*stacks, base)
    making = _making(stacks, pad_name or "")
    _say(found)
    if output is not None:
        for path in write_pad(output, found, base, making):
            say(f"wrote {path}")
    if plots is not None:
        from tactile_graph_pads.learning.page import write_page

        write_page(plots, found, making, "my-pad.yaml" if output is None else output.name)
        say(f"wrote {plots}")


def _check(
    recordings: Sequence[str],
    empty: Sequence[Path],
    output: Path | None,
    plots: Path | None,
    overwrite: bool,
) -> None:
    """Refuse before the work what cannot be done in the end."""
    from tactile_graph.cli.targets import check_targets, refuse_existing
    from tactile_graph.errors import UsageError
    from tactile_graph.files import check_target
    from tactile_graph_pads.learning.pad_file import files_of

    if not recordings and not empty:
        raise UsageError(
            "nothing to learn from: give an empty recording by --empty, recordings of objects, "
            "or both"
        )
    for option, path, endings in (
        ("-o", output, (".yaml", ".yml")),
        ("--plots", plots, (".html",)),
    ):
        if path is not None:
            check_target(option, path, endings, told_by_name=option == "-o")
    written = [("-o", path) for path in files_of(output)] if output is not None else []
    check_targets([*written, ("--plots", plots)])
    if not overwrite:
        refuse_existing(written)


def _read(
    recordings: Sequence[str], empty: Sequence[Path], places: Path | None, given_with: Sequence[str]
) -> tuple[Stack | None, Stack | None]:
    from tactile_graph.errors import UsageError
    from tactile_graph.foreign_text import tell
    from tactile_graph_pads.calibration.lists import parse_loaded
    from tactile_graph_pads.learning.recordings import SOURCE, off_pad, read_places, read_stack
    from tactile_graph_pads.same_pad import check_same_pad

    given = [parse_loaded(text) for text in recordings]
    both = {path.resolve() for path, _ in given} & {path.resolve() for path in empty}
    if both:
        raise UsageError(f"{sorted(both)[0]}: is given as empty and as a recording of objects")
    if places is not None and not given:
        raise UsageError("--places: tells where objects lay, but no recording of objects is given")
    told = None if places is None else read_places(places, [path.name for path, _ in given])
    settings = reader_settings(SOURCE, given_with)
    rest = read_stack([(path, None) for path in empty], None, settings) if empty else None
    objects = read_stack(given, told, settings) if given else None
    if objects is not None and (off := off_pad(objects)):
        tell(off)
    if rest is not None and objects is not None:
        check_same_pad(rest.image, objects.image, str(empty[0]), str(given[0].path))
    return rest, objects


def _making(stacks: Sequence[Stack | None], pad_name: str) -> Making:
    from datetime import UTC, datetime

    from tactile_graph.code_version import code_version
    from tactile_graph.foreign_text import pasted_words
    from tactile_graph_pads.learning.pad_file import Making

    digests = {name: d for s in stacks if s is not None for name, d in s.digests.items()}
    return Making(
        pasted_words(["tactile-graph", *sys.argv[1:]]),
        f"tactile-graph {code_version()}",
        datetime.now(UTC).isoformat(timespec="seconds"),
        digests,
        pad_name,
    )


def _say(found: LearnedPad) -> None:
    from rich.table import Table

    from tactile_graph.cli.terminal import console
    from tactile_graph_pads.learning.summary import summary

    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for name, text in summary(found):
        table.add_row(name, text)
    say: Any = console()
    say.print(table)
    for note in found.notes:
        say.print(note, soft_wrap=True, markup=False)
