"""Make a Jupyter notebook of a page of the docs: its code to run, its words between.

python docs/notebook.py docs/notebook.md press.ipynb
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

BLOCK = re.compile(r"^```(python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def notebook_of(page: str) -> dict[str, Any]:
    """Return the notebook (format 4.5) of a page in Markdown, as JSON holds it.

    Its Python blocks are cells of code, each with the block of text behind it as what it prints.
    """
    cells: list[dict[str, Any]] = []
    end = 0
    for block in BLOCK.finditer(page):
        _add_words(cells, page[end : block.start()])
        end = block.end()
        language, text = block.groups()
        if language == "python":
            cells.append(_cell("code", text, len(cells)) | {"execution_count": None, "outputs": []})
        else:
            printed = {"output_type": "stream", "name": "stdout", "text": text}
            cells[-1]["outputs"].append(printed)
    _add_words(cells, page[end:])
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": cells}


def _add_words(cells: list[dict[str, Any]], text: str) -> None:
    if text.strip():
        cells.append(_cell("markdown", text, len(cells)))


def _cell(kind: str, text: str, number: int) -> dict[str, Any]:
    return {"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": text.strip("\n")}


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(f"give the page and the notebook to write:\n{__doc__}")
    made = notebook_of(Path(sys.argv[1]).read_text(encoding="utf-8"))
    Path(sys.argv[2]).write_text(json.dumps(made, indent=1, ensure_ascii=False), encoding="utf-8")
