"""Where the files of a run go: a folder for everything, or one table and one picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tactile_graph_thesis.item import Item, Made
    from tactile_graph_thesis.making import Outcome

BOOK = "book.html"
STDOUT = "-"


@dataclass(frozen=True)
class Targets:
    """Where the files of a run go.

    Parameters
    ----------
    folder : Path, optional
        Takes every item's files, and the book.
    csv : str, optional
        Takes the table of one item; ``-`` is stdout.
    plot : Path, optional
        Takes the figure of one item.
    """

    folder: Path | None
    csv: str | None = None
    plot: Path | None = None

    def check(self, items: Sequence[Item]) -> None:
        """Find out before the work whether everything can be written.

        Parameters
        ----------
        items : sequence of Item
            Those that will be made.

        Raises
        ------
        UsageError
            If a name, a folder or the number of items does not fit.
        """
        from tactile_graph.cli.targets import check_targets
        from tactile_graph.errors import UsageError
        from tactile_graph_pads.calibration.plot import check_picture

        for option, path in (("--csv", self.csv), ("--plot", self.plot)):
            if path is not None and len(items) != 1:
                some = ", ".join(item.id for item in items[:3])
                more = ", …" if len(items) > 3 else ""
                raise UsageError(f"{option} takes one item, {len(items)} are named: {some}{more}")
        if self.csv not in (None, STDOUT):
            self._check_csv(str(self.csv))
        if self.plot is not None:
            check_picture(self.plot)
        check_targets([("--csv", self.csv), ("--plot", self.plot)])
        if self.folder is not None:
            self._check_folder(self.folder)

    @staticmethod
    def _check_csv(path: str) -> None:
        from tactile_graph.errors import UsageError
        from tactile_graph.files import check_target

        if not path.lower().endswith(".csv"):
            raise UsageError(f"--csv {path}: its name must end in .csv, or be - for stdout")
        check_target("--csv", Path(path))

    @staticmethod
    def _check_folder(folder: Path) -> None:
        from tactile_graph.errors import UsageError
        from tactile_graph.files import check_target

        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            reason = error.strerror or error
            raise UsageError(f"-o {folder}: cannot be made: {reason}") from error
        check_target("-o", folder / BOOK)

    def write(self, outcome: Outcome) -> bytes | None:
        """Write an item's files and return its figure as SVG, for the book.

        Parameters
        ----------
        outcome : Outcome

        Raises
        ------
        UsageError
            If the item has no table or figure, and one was asked for.
        """
        item, made = outcome.item, outcome.made
        if made is None:
            return None
        if self.csv is not None:
            self._write_csv(item, made, self.csv)
        if self.plot is not None:
            self._write_plot(item, made, self.plot)
        return self._write_files(item, made)

    def _write_files(self, item: Item, made: Made) -> bytes | None:
        from tactile_graph_thesis.book.files import files_of, write_all

        if self.folder is None:
            return None
        files = files_of(item.id, made)
        write_all(self.folder, files)
        return files.get(f"{item.id}.svg")

    @staticmethod
    def _write_csv(item: Item, made: Made, to: str) -> None:
        from tactile_graph.cli.say import hand_over
        from tactile_graph.errors import UsageError
        from tactile_graph.files import write_whole
        from tactile_graph_thesis.book.files import csv_text

        if made.table is None:
            raise UsageError(f"--csv: {item.name} has no table")
        text = csv_text(made.table.columns, made.table.rows)
        if to == STDOUT:
            hand_over(text)
        else:
            write_whole(to, text)

    @staticmethod
    def _write_plot(item: Item, made: Made, path: Path) -> None:
        from tactile_graph.errors import UsageError
        from tactile_graph.files import write_whole
        from tactile_graph_thesis.book.pictures import pictures

        kind = path.suffix.lower().removeprefix(".")
        if made.figure is not None:
            write_whole(path, pictures(made.figure, (kind,))[kind])
        elif made.svg and kind == "svg":
            write_whole(path, made.svg)
        else:
            drawn = "is drawn as .svg only" if made.svg else "has no figure"
            raise UsageError(f"--plot {path}: {item.name} {drawn}")

    def written(self, book: bool) -> list[str]:
        """Return the names of what was written.

        Parameters
        ----------
        book : bool
            Whether the folder holds one.
        """
        named = [str(path) for path in (self.csv, self.plot) if path not in (None, STDOUT)]
        if self.folder is None:
            return named
        return [*named, str(self.folder / BOOK if book else self.folder)]
