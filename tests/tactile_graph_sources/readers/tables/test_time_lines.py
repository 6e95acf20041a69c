"""Lines above matrices that tell a time or a number, as wide as a header or not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write

LOADED = np.random.default_rng(4).integers(0, 300, (6, 5, 4))


def text(above: str, separator: str = ",", n: int = 6) -> str:
    return "".join(
        above.format(k) + "".join(separator.join(map(str, row)) + "\n" for row in frame) + "\n"
        for k, frame in enumerate(LOADED[:n])
    )


@pytest.mark.parametrize("n", [1, 6])
@pytest.mark.parametrize(
    ("above", "separator"),
    [
        ("Time,0.{},,\n", ","),
        ("Time (s);0.{};;\n", ";"),
        ("t = 0.{} s\n", ","),
        ("t = 0.{} s\n", " "),
        ("t = 0.{} s\n", "\t"),
    ],
)
def test_a_time_above_a_matrix_is_no_header(
    above: str, separator: str, n: int, tmp_path: Path
) -> None:
    settings = {} if n > 1 else {"rows": 5, "columns": 4}
    frames, _ = frames_of(write(tmp_path, text(above, separator, n)), **settings)
    assert np.array_equal([frame.image.values for frame in frames], LOADED[:n])
    if n > 1:
        assert np.allclose([frame.time_s for frame in frames], np.arange(n) / 10)


@pytest.mark.parametrize("word", ["Index", "Step"])
def test_numbers_above_matrices_are_no_header(word: str, tmp_path: Path) -> None:
    frames, report = frames_of(write(tmp_path, text(word + ",{},,\n")))
    assert np.array_equal([frame.image.values for frame in frames], LOADED)
    assert not any("left out" in told for told in report.counts)


@pytest.mark.parametrize("header", ["c0,c1,c2,c3\n", "Index,c1,c2,c3\n"])
def test_names_that_do_not_change_are_a_header(header: str, tmp_path: Path) -> None:
    n = int("Index" in header)
    numbered = LOADED.copy()
    numbered[:, :, :n] = np.arange(30).reshape(6, 5, 1)
    lines = header + "".join(",".join(map(str, row)) + "\n" for row in numbered.reshape(-1, 4))
    frames, _ = frames_of(write(tmp_path, lines), rows=1, columns=4 - n)
    assert np.array_equal([f.image.values[0] for f in frames], numbered.reshape(-1, 4)[:, n:])


@pytest.mark.parametrize("again", ["r0c1,r0c0,r1c0,r1c1\n", "r0C1,r0C0,r1C0,r1C1 \n"])
def test_a_header_may_come_again(again: str, tmp_path: Path) -> None:
    first, last = ("".join(",".join(map(str, row)) + "\n" for row in half) for half in LOADED[:2])
    frames, _ = frames_of(write(tmp_path, f"r0c1,r0c0,r1c0,r1c1\n{first}{again}{last}"))
    true = LOADED[:2].reshape(-1, 4)[:, [1, 0, 2, 3]].reshape(-1, 2, 2)
    assert np.array_equal([frame.image.values for frame in frames], true)
