"""The pictures of docs/live.md and the moving one of the README, made anew from the running page.

    python docs/making/live_pictures.py [-o FOLDER]

Runs `tactile-graph live` on a disc that is moved about a simulated pad and taken off again, opens
the page in Chromium without a window (needs playwright and Chromium), and writes live-day.png,
live-night.png, live-phone.png and live.gif into the folder, docs/pictures if not given. In the
moving picture a node is opened, a setting moved, and the pipeline file saved wrong, then right
again with a node more.
"""

from __future__ import annotations

import argparse
import io
import math
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

PICTURES = Path(__file__).parents[1] / "pictures"
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
OPTIONS = [
    "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-sync",
    "--disable-component-update", "--no-first-run", "--disable-quic",
]  # fmt: skip
RATE_HZ = 12
N_PLACES = 96
N_EMPTY = 10
WINDOW_PX = (1440, 1010)
GIF_PX = (800, 561)
GIF_MS = 110
GIF_COLOURS = 160
RARE = 0.35
"""Power by which a colour's pixels count for the palette."""
WARM_S = 75.0
"""Until the charts, of the last minute, have left the beginning behind."""
PIPELINE = """\
pipeline: disc
about: A disc that is moved about, found by the corners of its hull
source: {step: simulate, with: {scene: moved.yaml, frames: 106}}
conditions:
  touched: footprint.count > 4
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  fine: {step: subdivide, in: footprint, with: {factor: 2}, when: touched}
  boundary: {step: boundary_scan, in: fine}
  hull: {step: hull, in: boundary}
  circle: {step: fit_circle, in: hull}
outputs: [circle]
"""
WRONG = PIPELINE.replace("{factor: 2}", "{factor: two}").replace("in: boundary}", "in: boundry}")
MORE = PIPELINE.replace(
    "outputs: [circle]",
    "  outline: {step: fit_ellipse, in: hull}\noutputs: [circle, outline]",
)  # fmt: skip


def scene() -> str:
    """Return the scene: a disc goes once along a figure of eight, then the pad is empty."""
    lines = ["about: a disc that is moved about and taken off", "in_turn:"]
    for number in range(N_PLACES):
        turn = 2 * math.pi * number / N_PLACES
        x, y = 10.25 + 4.2 * math.sin(turn), 10.25 + 3.4 * math.sin(2 * turn)
        lines.append(
            f"  - - {{shape: disc, name: disc, weight_g: 4000, radius_cm: 4.8, "
            f"place: [{x:.3f}, {y:.3f}]}}"
        )
    return "\n".join([*lines, *["  - []"] * N_EMPTY]) + "\n"


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve the page on the scene; gives its address."""
    (folder / "moved.yaml").write_text(scene())
    (folder / "disc.yaml").write_text(PIPELINE)
    words = ["live", "disc.yaml", "--rate", str(RATE_HZ), "--http-port", "0"]
    process = subprocess.Popen(
        [sys.executable, "-u", "-m", "tactile_graph", *words],
        cwd=folder, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        yield "http" + line.rpartition(" http")[2].strip()
    finally:
        process.terminate()
        process.communicate(timeout=30)


def opened(browser: Any, address: str, size: tuple[int, int], scheme: str) -> Any:
    """Return a page that draws."""
    width, height = size
    context = browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=scheme,
        device_scale_factor=1 if width > 500 else 1.5,
    )  # fmt: skip
    page = context.new_page()
    page.goto(address, timeout=120_000)
    page.locator("#nodes .badge[data-fate=ran]").first.wait_for(timeout=120_000)
    page.locator("#pad-canvas").hover(position={"x": 2, "y": 2})
    return page


def shot(page: Any) -> Image.Image:
    """Return what the window shows."""
    with Image.open(io.BytesIO(page.screenshot())) as seen:
        return seen.convert("RGB")


def still(page: Any, path: Path) -> None:
    """Write what the window shows with something on the pad, in few colours."""
    for _ in range(60):
        if page.locator("#nodes [data-name=circle] .badge[data-fate=ran]").count():
            break
        page.wait_for_timeout(200)
    shot(page).quantize(256, dither=Image.Dither.NONE).save(path, optimize=True)


def story(page: Any, file: Path) -> Iterator[None]:
    """Do what the moving picture shows, a bit at a time."""
    yield from (None for _ in range(14))
    page.locator("#nodes [data-name=footprint]").click()
    yield from (None for _ in range(7))
    slider = page.locator("#node-settings").get_by_role("slider").first
    for level in (0.012, 0.016, 0.02, 0.024, 0.028, 0.032, 0.036, 0.04):
        slider.fill(str(level))
        yield
    yield from (None for _ in range(3))
    page.locator("#node-close").click()
    file.write_text(WRONG)
    yield from (None for _ in range(14))
    file.write_text(MORE)
    yield from (None for _ in range(20))


def save(page: Any, file: Path, text: str) -> None:
    """Save the file, and wait until the page shows its graph."""
    before = page.locator("html").get_attribute("data-graph")
    file.write_text(text)
    page.locator(f"html:not([data-graph='{before}'])").wait_for(state="attached", timeout=120_000)


def compiled(page: Any, file: Path) -> None:
    """Have compiled what the moving picture runs: it is to show what editing is like, not that."""
    save(page, file, MORE)
    save(page, file, PIPELINE)


def common_palette(seen: list[Image.Image]) -> Image.Image:
    """Return one palette for all frames, so that nothing flickers; colours that are rare count."""
    step = max(1, len(seen) // 6)
    counts: dict[Any, float] = {}
    for frame in seen[::step]:
        for count, colour in frame.getcolors(frame.width * frame.height) or []:
            counts[colour] = counts.get(colour, 0.0) + count
    dots = [c for c, count in counts.items() for _ in range(math.ceil(count**RARE))]
    sheet = Image.new("RGB", (len(dots), 1))
    sheet.putdata(dots)
    return sheet.quantize(GIF_COLOURS, dither=Image.Dither.NONE)


def moving(page: Any, file: Path, path: Path) -> None:
    """Write the moving picture."""
    seen = []
    for _ in story(page, file):
        began = time.monotonic()
        seen.append(shot(page).resize(GIF_PX, Image.Resampling.LANCZOS))
        # Not by sleeping: what a page receives goes through here too, and would hold it up.
        page.wait_for_timeout(max(1.0, GIF_MS - 1e3 * (time.monotonic() - began)))
    palette = common_palette(seen)
    few = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in seen]
    few[0].save(path, save_all=True, append_images=few[1:], duration=GIF_MS, loop=0, optimize=True)


def main() -> None:
    """Make all four pictures."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=PICTURES, metavar="FOLDER")
    given = parser.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if program is None:
        sys.exit(f"no browser found: {', '.join(BROWSERS)}")
    with (
        tempfile.TemporaryDirectory() as name,
        served(Path(name)) as address,
        sync_playwright() as started,
    ):
        browser = started.chromium.launch(executable_path=program, args=OPTIONS)
        page = opened(browser, address, WINDOW_PX, "light")
        compiled(page, Path(name) / "disc.yaml")
        page.wait_for_timeout(1e3 * WARM_S)
        still(page, given.output / "live-day.png")
        moving(page, Path(name) / "disc.yaml", given.output / "live.gif")
        save(page, Path(name) / "disc.yaml", PIPELINE)
        page.context.close()
        page = opened(browser, address, WINDOW_PX, "dark")
        page.locator("#nodes [data-name=hull]").click()
        page.wait_for_timeout(8000)
        still(page, given.output / "live-night.png")
        page.context.close()
        page = opened(browser, address, (360, 740), "light")
        page.wait_for_timeout(4000)
        still(page, given.output / "live-phone.png")
        browser.close()
    for name in ("live-day.png", "live-night.png", "live-phone.png", "live.gif"):
        path = given.output / name
        print(f"wrote {path}, {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
