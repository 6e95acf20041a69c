"""What is read with a pipeline is watched, also where it is not there, as long as it is of use."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tactile_graph.cli.watch import files_read, stamp
from tactile_graph_live.commands.live import read_source
from tactile_graph_live.server.watching import FileSense, Watched


@pytest.fixture
def main(tmp_path: Path) -> Path:
    (tmp_path / "main.yaml").write_text("1")
    (tmp_path / "used.yaml").write_text("2")
    return tmp_path / "main.yaml"


def watched(main: Path) -> Watched:
    return Watched(FileSense(stamp, files_read, read_source), [str(main)])


def reading(*paths: Path) -> Callable[[], object]:
    return lambda: [path.read_text() for path in paths]


def test_what_each_has_read_is_returned_and_watched(main: Path) -> None:
    used, files = main.with_name("used.yaml"), watched(main)
    first, second = files.take(reading(main, used), reading(used))
    assert list(first) == [str(main), str(used)]
    assert second == {str(used): stamp(str(used))}
    assert not files.changed()
    used.write_text("changed")
    assert files.changed()
    files.take(reading(main, used))
    assert not files.changed()


def test_a_file_that_is_gone_is_one_change_and_its_return_another(main: Path) -> None:
    used, files = main.with_name("used.yaml"), watched(main)
    files.take(reading(main, used))
    used.unlink()
    for _ in range(2):
        assert files.changed()
        with pytest.raises(ZeroDivisionError):
            files.take(reading(main), lambda: 1 / 0)
        assert not files.changed()
        used.write_text("back")


def test_a_file_that_is_used_no_more_is_not_watched(main: Path) -> None:
    used, files = main.with_name("used.yaml"), watched(main)
    files.take(reading(main, used))
    files.take(reading(main))
    used.write_text("changed")
    assert not files.changed()


def test_a_file_that_is_saved_while_it_is_read_has_changed(main: Path) -> None:
    files = watched(main)
    files.take(reading(main), lambda: main.write_text("saved meanwhile"), reading(main))
    assert files.changed()
