"""The built site: its links lead somewhere, every step has its page, and search needs no network.

``TACTILE_GRAPH_SITE`` names the folder of a build; without it these are skipped.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path
from urllib.parse import unquote

import pytest

from tactile_graph.plugins.registry import installed

SITE = Path(os.environ.get("TACTILE_GRAPH_SITE", "no such folder"))
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not SITE.is_dir(), reason="no site is built: TACTILE_GRAPH_SITE names one"),
]
TARGET = re.compile(r'(?:href|src)="([^"]+)"')
BROWSER = (
    "chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--dump-dom",
    "--virtual-time-budget=10000", "--host-rules=MAP * ~NOTFOUND",
)  # fmt: skip
"""A browser that prints what a page came to, and reaches no host."""
IDS = re.compile(r'\bid="([^"]+)"')


@cache
def text(page: Path) -> str:
    return page.read_text("utf-8")


@cache
def ids(page: Path) -> frozenset[str]:
    return frozenset(IDS.findall(text(page)))


def trouble(page: Path, target: str) -> str:
    """Return what is wrong with a link of a page; nothing for one to another place."""
    if re.match(r"[a-z]+:|//", target) or target in ("#", ""):
        return ""
    path, _, anchor = target.partition("#")
    to = (page.parent / unquote(path.partition("?")[0])).resolve() if path else page
    if not to.is_file():
        return f"{page.relative_to(SITE)}: nothing at {target}"
    if anchor and to.suffix == ".html" and unquote(anchor) not in ids(to):
        return f"{page.relative_to(SITE)}: no place {target}"
    return ""


def test_every_link_and_picture_is_there() -> None:
    pages = [p for p in sorted(SITE.rglob("*.html")) if SITE / "_static" not in p.parents]
    assert len(pages) > 250
    targets = [(page, target) for page in pages for target in set(TARGET.findall(text(page)))]
    assert len(targets) > 10_000
    assert [told for page, target in targets if (told := trouble(page, target))] == []


def test_nothing_is_loaded_from_another_place() -> None:
    loads = re.compile(r'<(?:script|img|iframe)[^>]+src="(https?:)?//|<link[^>]+href="(https?:)?//')
    assert [page.name for page in SITE.rglob("*.html") if loads.search(text(page))] == []


def test_every_step_has_its_page_with_a_picture_or_the_reason_why_not() -> None:
    steps = SITE / "catalogue" / "steps"
    for name in installed().names("steps"):
        page = text(steps / installed().offer("steps", name).plugin.name / f"{name}.html")
        assert (f"{name}-shown.svg" in page) != ("No picture." in page), name
        assert ("Cost" in page) or "No picture." in page or "What it gives" in page, name


def test_every_pipeline_has_its_page_with_its_graph_and_file() -> None:
    for name in installed().names("pipelines"):
        page = text(SITE / "catalogue" / "pipelines" / f"{name}.html")
        assert f"{name}-graph.svg" in page
        assert "outputs" in page


@pytest.mark.skipif(shutil.which("chromium") is None, reason="there is no chromium")
@pytest.mark.parametrize(
    ("words", "found"),
    [("hysteresis", "glossary.html"), ("fit_circle_taubin", "fit_circle_taubin.html")],
)
def test_search_finds_pages_from_the_disk_alone(words: str, found: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [*BROWSER, f"--user-data-dir={tmp_path}",
         f"{SITE.resolve().as_uri()}/search.html?q={words}"],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    _, _, results = done.stdout.partition('id="search-results"')
    assert re.search(r"found \d+ pages? matching|Search finished", results)
    assert found in results


@pytest.mark.skipif(shutil.which("chromium") is None, reason="there is no chromium")
@pytest.mark.parametrize("width_px", [360, 768, 1400])
def test_drawings_are_moved_along_not_made_too_small_to_read(width_px: int) -> None:
    """Their smallest letters are of 10 px at full size."""
    play = pytest.importorskip("playwright.sync_api")
    drawn = "[...document.querySelectorAll('main img')].filter(i => i.src.endsWith('.svg'))"
    scale = f"Math.min(...{drawn}.map(i => i.getBoundingClientRect().width / i.naturalWidth))"
    with play.sync_playwright() as played:
        browser = played.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
        )
        tab = browser.new_page(viewport={"width": width_px, "height": 900})
        for name in ("pipelines/identify-locate", "pipelines/circle-3", "steps/filters/erode"):
            tab.goto((SITE / "catalogue" / f"{name}.html").resolve().as_uri())
            assert 0.9 < tab.evaluate(scale) < 2, name
            assert tab.evaluate("document.documentElement.scrollWidth") <= width_px, name
        browser.close()


@pytest.mark.skipif(shutil.which("chromium") is None, reason="there is no chromium")
@pytest.mark.parametrize("width_px", [360, 1400])
def test_the_first_picture_is_seen_whole_where_there_is_room(width_px: int) -> None:
    play = pytest.importorskip("playwright.sync_api")
    picture = "document.querySelector('main figure.wide img')"
    with play.sync_playwright() as played:
        browser = played.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
        )
        tab = browser.new_page(viewport={"width": width_px, "height": 900})
        tab.goto((SITE / "index.html").resolve().as_uri())
        assert tab.evaluate(f"{picture}.width") > 1000
        moved_px = tab.evaluate(f"(f => f.scrollWidth - f.clientWidth)({picture}.parentElement)")
        assert (moved_px == 0) is (width_px == 1400)
        browser.close()
