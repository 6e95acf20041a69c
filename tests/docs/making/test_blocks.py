"""Blocks of a page are run as a reader would run them; what goes wrong is told with its line."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[3] / "docs"
pytestmark = pytest.mark.skipif(not DOCS.is_dir(), reason="the docs are not beside the tests")
Run = Callable[[str], list[str]]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    monkeypatch.setattr(sys, "path", [str(DOCS), *sys.path])
    from making.blocks import blocks_of, run_blocks

    def troubles(text: str) -> list[str]:
        page, folder = tmp_path / "page.md", tmp_path / "work"
        folder.mkdir(exist_ok=True)
        page.write_text(text, "utf-8")
        return run_blocks(blocks_of(page), folder)

    return troubles


def test_python_blocks_share_their_names_and_what_they_print_is_held_against_the_page(
    run: Run,
) -> None:
    page = "```python\nx = 2\n```\n\n```python\nprint('x is', x, 'in 0.123 s')\n```\n"
    assert run(page + "\n```text\nx is 2 in … s\n```\n") == []
    (told,) = run(page + "\n```text\nx is 3 in … s\n```\n")
    assert told.startswith("page.md:9: nothing printed reads 'x is 3 in … s'; it was:\nx is 2")


def test_a_block_may_define_a_dataclass_as_a_module_does(run: Run) -> None:
    head = "from __future__ import annotations\nfrom dataclasses import dataclass\n"
    shape = "@dataclass\nclass Disc:\n    radius_cm: float\nprint(Disc(2.0))\n"
    assert run(f"```python\n{head}{shape}```\n```text\nDisc(radius_cm=2.0)\n```\n") == []


def test_lines_that_come_in_another_order_are_told(run: Run) -> None:
    page = "```sh\necho one; echo two\n```\n\n```text\n{}\n{}\n```\n"
    assert run(page.format("one", "two")) == []
    assert len(run(page.format("two", "one"))) == 1


def test_a_block_is_run_with_fewer_frames_where_the_page_says_so(run: Run) -> None:
    block = "```sh\necho $(cat n) --frames 400 --with frames=20 --frames-a-second 5\n```\n\n"
    first = "<!-- before:\necho 7 > n\n-->\n"
    fewer = "```text\n7 --frames 3 --with frames=3 --frames-a-second 5\n```\n"
    assert run(f"{first}<!-- run here with 3 frames -->\n{block}{fewer}") == []
    assert len(run(f"{first}{block}{fewer}")) == 1


def test_a_command_that_fails_is_told_and_the_next_block_still_runs(run: Run) -> None:
    (told,) = run("```sh\nfalse\necho never\n```\n\n```python\nprint(1)\n```\n```text\n1\n```\n")
    assert "page.md:1: ends with 1" in told
    assert "never" not in told.replace("echo never", "")


def test_an_exception_is_told_with_its_line(run: Run) -> None:
    (told,) = run("\n\n```python\n1 / 0\n```\n")
    assert told.startswith("page.md:3: fails:")
    assert "ZeroDivisionError" in told


@pytest.mark.slow
def test_a_named_file_is_written_and_checked(run: Run, tmp_path: Path) -> None:
    text = (
        "pipeline: p\nnodes:\n  m: {step: thershold, in: frame, with: {level: 1}}\noutputs: [m]\n"
    )
    (told,) = run(f"```yaml\n# mine.yaml\n{text}```\n")
    assert "did you mean 'threshold'" in told
    assert run(f"```yaml\n# mine.yaml\n{text.replace('thershold', 'threshold')}```\n") == []
    assert (tmp_path / "work" / "mine.yaml").is_file()


def test_yaml_that_says_not_what_it_is_is_refused(run: Run) -> None:
    (told,) = run("```yaml\nnodes: {}\n```\n")
    assert "says neither" in told
    assert run("```yaml\n# part of a pipeline file\nnodes: {}\n```\n") == []


def test_files_that_a_reader_has_are_made_before(run: Run) -> None:
    made = "<!-- before:\necho 7 > mine.csv\n-->\n"
    assert run(made + "```sh\ncat mine.csv\n```\n```text\n7\n```\n") == []
    (told,) = run("<!-- before:\nfalse\n-->\n```sh\necho never\n```\n")
    assert told.startswith("page.md:4: ends with 1")


def test_a_block_that_something_else_runs_is_left_to_it(run: Run) -> None:
    assert run("<!-- run by .ci/run -->\n```sh\nfalse\n```\n") == []
    (told,) = run("<!-- run by .ci/walk -->\n```sh\nfalse\n```\n")
    assert told == "page.md:2: there is no .ci/walk to run it"


def test_what_is_marked_is_not_run(run: Run) -> None:
    assert run("```sh\n# not run: needs a pad on a port\nfalse\n```\n") == []
