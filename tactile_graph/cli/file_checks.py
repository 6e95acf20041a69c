"""Files that plugins look through for ``check``: what is wrong with them, and what was mended."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tactile_graph.plugins.registry import Registry

if TYPE_CHECKING:
    from rich.console import Console

    from tactile_graph.plugins.file_check import Checked, FileCheck


def check_for(found: Registry, name: str) -> FileCheck | None:
    """Return what looks such a file through; None if no plugin does."""
    path = Path(name)
    if not path.exists():
        return None
    checks: list[FileCheck] = [found.load("checks", kind) for kind in found.names("checks")]
    return next((c for c in checks if c.takes(path)), None)


def show_checked(out: Console, name: str, checked: Checked, repair: bool) -> bool:
    """Print what came of looking through a file; return whether it is right."""
    from rich.text import Text

    right = not checked.wrong
    verdict = (f"{name}: right", "bold green") if right else (f"{name}: wrong", "bold red")
    out.print(Text.assemble(verdict, f"  {checked.about}"), soft_wrap=True)
    for text in checked.mended:
        out.print(Text.assemble(("  mended  ", "green"), text), soft_wrap=True)
    for text in checked.wrong:
        out.print(Text.assemble(("  wrong   ", "red"), text), soft_wrap=True)
    for text in checked.left:
        out.print(Text.assemble(("  left    ", "yellow"), text), soft_wrap=True)
    if not right:
        hint = "this cannot be mended" if repair else "--repair mends what can be"
        out.print(Text(f"  {hint}", style="dim"), soft_wrap=True)
    elif checked.left:
        hint = "a writer was cut short; what the file holds is whole, and --repair clears this away"
        out.print(Text(f"  {hint}", style="dim"), soft_wrap=True)
    return right
