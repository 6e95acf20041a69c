"""The notebook page runs from its first block to its last, and gives what it shows."""

from __future__ import annotations

import ast
import json
import re
import runpy
import sys
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "notebook.md"
RICH = ("_repr_html_", "_repr_png_", "_repr_svg_")
pytestmark = pytest.mark.skipif(not PAGE.is_file(), reason="the docs are not beside the tests")


def cells() -> list[tuple[str, str | None]]:
    """Return each block of code, and the text that the page shows below it."""
    blocks = re.findall(r"^```(python|text)\n(.*?)^```", PAGE.read_text("utf-8"), re.M | re.S)
    found: list[tuple[str, str | None]] = []
    for language, block in blocks:
        if language == "python":
            found.append((block, None))
        else:
            found[-1] = (found[-1][0], block)
    return found


def run(code: str, space: dict[str, Any]) -> tuple[str, Any]:
    """Run a cell as notebooks do; return what it prints and what its last line comes to."""
    tree = ast.parse(code)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    shown = None
    with redirect_stdout(StringIO()) as printed:
        exec(compile(tree, "notebook.md", "exec"), space)
        if last is not None:
            shown = eval(compile(ast.Expression(last.value), "notebook.md", "eval"), space)
    return printed.getvalue(), shown


@pytest.mark.slow
def test_every_cell_runs_prints_what_is_shown_and_shows_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pandas")
    import matplotlib

    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    space: dict[str, Any] = {"__name__": "shown"}
    pictures = 0
    for code, text in cells():
        printed, shown = run(code, space)
        assert printed == (text or ""), code
        rich = [name for name in RICH if hasattr(shown, name)]
        pictures += bool(rich)
        for name in rich:
            assert len(getattr(shown, name)()) > 1000
    space["plt"].close("all")
    assert pictures == 3
    assert {p.name for p in tmp_path.iterdir()} == {
        "press.csv", "path.png", "strip.png", "report.html",
    }  # fmt: skip


@pytest.mark.slow
def test_the_refusal_the_page_quotes_is_the_one_that_inspect_gives(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from click.testing import CliRunner

    from tactile_graph.cli import cli

    monkeypatch.chdir(tmp_path)
    run(cells()[0][0], {})
    (quoted,) = re.findall(r"`(give rows .*?)`", PAGE.read_text("utf-8"))
    assert quoted in CliRunner().invoke(cli, ["inspect", "press.csv"]).output


def test_the_page_becomes_a_notebook_with_the_same_code_and_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = PAGE.with_suffix(".py")
    monkeypatch.setattr(sys, "argv", [str(script), str(PAGE), str(tmp_path / "press.ipynb")])
    runpy.run_path(str(script), run_name="__main__")
    made = json.loads((tmp_path / "press.ipynb").read_text("utf-8"))
    assert (made["nbformat"], made["nbformat_minor"]) == (4, 5)
    code = [cell for cell in made["cells"] if cell["cell_type"] == "code"]
    assert [cell["source"] + "\n" for cell in code] == [block for block, _ in cells()]
    printed = ["".join(o["text"] for o in cell["outputs"]) or None for cell in code]
    assert printed == [text for _, text in cells()]
    words = "\n".join(c["source"] for c in made["cells"] if c["cell_type"] == "markdown")
    assert "# In a notebook" in words
    assert "```" not in words
    ids = [cell["id"] for cell in made["cells"]]
    assert len(set(ids)) == len(ids)
