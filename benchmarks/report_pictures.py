"""The two pictures of the report in the README, made anew: its top, and error against time.

    python benchmarks/report_pictures.py [--frames 500] [--seed 0] [--browser chromium] [-o FOLDER]

Writes report.png (of the command docs/compare.md shows) and error-against-time.png (circle-1 to
circle-3 and the costlier ways to find a circle, on the same scene) into the folder, docs/pictures
if not given, and prints the figures behind the second. Needs Chromium, which renders the pages
without a window.
"""

from __future__ import annotations

import argparse
import io
import shutil
import subprocess
import sys
import tempfile
from contextlib import redirect_stdout
from pathlib import Path

from PIL import Image

from tactile_graph.cli import cli
from tactile_graph_compare import Comparison, compare
from tactile_graph_compare.report.markup import Html, plots, tag
from tactile_graph_compare.report.scatter import scatter
from tactile_graph_compare.report.style import STYLE

SCENE = "discs"
LINEAGE = ("circle-1", "circle-2", "circle-3")
WAYS = (*LINEAGE, "circle-likelihood", "adaptive", "bayes-circle")
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
PICTURES = Path(__file__).parents[1] / "docs" / "pictures"


def report(page: Path, frames: int, seed: int) -> None:
    """Write the report on the thesis' three evolutions, by the command that anyone would type."""
    words = ["compare", *LINEAGE, "--source", "simulate", "--with", f"scene={SCENE}",
             "--frames", str(frames), "--seed", str(seed), "--report", str(page)]  # fmt: skip
    with redirect_stdout(io.StringIO()):
        cli.main(words, standalone_mode=False)


def compared(frames: int, seed: int) -> Comparison:
    """Return how all ways to find a circle compare on simulated discs."""
    settings = {"scene": SCENE}
    return compare(
        list(WAYS), source="simulate", source_settings=settings, n_frames=frames, seed=seed
    )


def browser(named: str | None) -> str:
    """Return the browser's program, or say that there is none."""
    found = next((p for n in ([named] if named else BROWSERS) if (p := shutil.which(n))), None)
    if found is None:
        sys.exit(f"no browser found: {named or ', '.join(BROWSERS)}; name one with --browser")
    return found


def shoot(program: str, page: Path, size: tuple[int, int], scale: float, picture: Path) -> None:
    """Render the top of a page, ``size`` in CSS pixels, into a PNG of few colours."""
    raw = page.with_suffix(".png")
    subprocess.run(
        [program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
         "--no-first-run", "--disable-background-networking",
         "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={page.parent / 'profile'}",
         f"--window-size={size[0]},{size[1]}", f"--force-device-scale-factor={scale}",
         f"--screenshot={raw}", page.as_uri()],
        check=True, capture_output=True, timeout=120,
    )  # fmt: skip
    with Image.open(raw) as shot:
        few = shot.convert("RGB").quantize(128, dither=Image.Dither.NONE)
    few.save(picture, optimize=True)


def scatter_page(found: Comparison) -> str:
    """Return a page of nothing but error against time, as the report draws it."""
    drawn = plots(*(scatter(found, q) for q in found.quantities))
    body = tag("body", drawn, style="margin: 10px")
    return f"<!doctype html>\n<meta charset=utf-8>{tag('style', Html(STYLE))}{body}\n"


def told(found: Comparison) -> None:
    """Print mean error and median time of each way."""
    print(f"{found.frames.n} frames of the scene {SCENE}")
    print(f"{'':20}{'centre cm':>10}{'radius cm':>10}{'time us':>10}")
    for v in found.variants:
        scores = (found.score(v.label, q) for q in ("centre", "radius"))
        errors = "".join(f"{s.mean:10.3f}" if s and s.mean is not None else " " * 10
                         for s in scores)  # fmt: skip
        print(f"{v.label:20}{errors}{v.times.median_us:10.0f}")


def main() -> None:
    """Make both pictures."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--frames", type=int, default=500)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--browser", help="Chromium or a program that takes its options")
    parser.add_argument("-o", "--output", type=Path, default=PICTURES, metavar="FOLDER")
    given = parser.parse_args()
    program = browser(given.browser)
    given.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "report.html"
        report(page, given.frames, given.seed)
        shoot(program, page, (1320, 985), 1.5, given.output / "report.png")
        page = Path(folder) / "scatter.html"
        found = compared(given.frames, given.seed)
        page.write_text(scatter_page(found), encoding="utf-8")
        shoot(program, page, (810, 350), 2.0, given.output / "error-against-time.png")
    told(found)
    for name in ("report.png", "error-against-time.png"):
        print(f"wrote {given.output / name}")


if __name__ == "__main__":
    main()
