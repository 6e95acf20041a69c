"""What goes into a pipe goes in pieces of whole lines."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from tactile_graph.cli.many.piped import PIECE, piped


class Pipe(io.RawIOBase):
    """Notes what is written at a time, of which it takes no more than a piece."""

    def __init__(self) -> None:
        self.pieces: list[bytes] = []

    def write(self, data: Any) -> int:
        self.pieces.append(bytes(data[:PIECE]))
        return len(self.pieces[-1])


def test_lines_are_whole_in_each_piece_that_they_fit_in() -> None:
    pipe = Pipe()
    short, long = b"x" * (PIECE // 3) + b"\n", b"y" * (3 * PIECE) + b"\n"
    text = short * 7 + long + short * 4
    assert piped(pipe).write(text) == len(text)  # type: ignore[arg-type]
    assert b"".join(pipe.pieces) == text
    assert max(map(len, pipe.pieces)) <= PIECE
    assert all(p.endswith(b"\n") for p in pipe.pieces if b"x" in p)


def test_a_plain_file_is_written_as_it_is(tmp_path: Path) -> None:
    with (tmp_path / "a.csv").open("wb") as file:
        assert piped(file) is file
