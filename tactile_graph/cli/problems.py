"""Show everything wrong with a pipeline: place, words, and the marked line."""

from __future__ import annotations

from rich.console import Console
from rich.text import Text

from tactile_graph.errors import PipelineError, Problem


def show_problems(console: Console, error: PipelineError) -> None:
    """Write each problem with its place and snippet, then how many there are."""
    for problem in error.problems:
        console.print(_text(problem), soft_wrap=True)
    n = len(error.problems)
    console.print(Text(f"{n} problem{'s' if n != 1 else ''}", style="bold red"))


def _text(problem: Problem) -> Text:
    text = Text()
    if problem.mark is not None:
        text.append(f"{problem.mark}: ", style="bold")
    else:
        text.append("error: ", style="bold red")
    text.append(problem.message)
    for line in problem.snippet.splitlines():
        text.append("\n")
        text.append(line, style="bold red" if line.strip() == "^" else "dim")
    return text
