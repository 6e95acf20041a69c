"""The pictures of the tutorial: what its own commands draw when they are run."""

from __future__ import annotations

import hashlib
import re
import shutil
import tempfile
from pathlib import Path

from making.blocks import blocks_of, run_blocks
from making.demonstrations import code_of

DOCS = Path(__file__).parents[1]
PAGE = DOCS / "tutorial" / "index.md"
SHOWN = re.compile(r"\.\./catalogue/tutorial/([\w.-]+)")


def write_pictures(into: Path, kept: Path) -> int:
    """Run the tutorial, keep the pictures it shows, and return how many there are.

    Raises
    ------
    LookupError
        If one of its blocks does not do what the page says, or draws no such picture.
    """
    text = PAGE.read_text("utf-8")
    names = sorted(set(SHOWN.findall(text)))
    key = hashlib.sha256((text + code_of("")).encode()).hexdigest()[:32]
    folder = kept / f"tutorial-{key}"
    if not folder.is_dir():
        with tempfile.TemporaryDirectory() as work:
            troubles = run_blocks(blocks_of(PAGE), Path(work))
            if troubles:
                raise LookupError("\n".join(troubles))
            folder.mkdir(parents=True)
            for name in names:
                shutil.copy(Path(work) / name, folder / name)
    (into / "tutorial").mkdir(parents=True, exist_ok=True)
    for name in names:
        shutil.copy(folder / name, into / "tutorial" / name)
    return len(names)
