"""The report in a browser: it opens, shows all, fits a phone and paper, and asks nobody."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from helpers_browser import BROWSER, QUIET
from helpers_html import read_html
from tactile_graph_compare import Comparison, compare
from tactile_graph_compare.report import write_report

pytestmark = [
    pytest.mark.slow,  # a browser starts for each
    pytest.mark.usefixtures("hand_made"),
    pytest.mark.skipif(BROWSER is None, reason="no Chromium on the PATH"),
]
OPTIONS = (
    "--headless",
    *QUIET,
    "--hide-scrollbars",
    "--host-resolver-rules=MAP * ~NOTFOUND",
)


def browse(page: Path, *options: str) -> str:
    """Open a page, and return what the browser prints."""
    profile = page.parent / "profile"
    command = [str(BROWSER), *OPTIONS, f"--user-data-dir={profile}", *options, page.as_uri()]
    done = subprocess.run(command, capture_output=True, timeout=60, check=True)
    return done.stdout.decode()


def asked(log: Path) -> list[str]:
    """Return the addresses that a page itself asked for; the browser asks some of its own."""
    told = json.loads(log.read_text())
    start = told["constants"]["logEventTypes"]["URL_REQUEST_START_JOB"]
    jobs = [e["params"] for e in told["events"] if e["type"] == start and "params" in e]
    jobs = [j for j in jobs if "url" in j]  # a job's end has none
    return [j["url"] for j in jobs if "file:" in j.get("network_isolation_key", "file:")]


@pytest.fixture
def made() -> Comparison:
    """A comparison in which something is skipped, fails and is worst."""
    return compare(["discs", "next.yaml"], source_settings={"empty": [0]}, n_frames=10)


@pytest.fixture
def report(made: Comparison, tmp_path: Path) -> Path:
    path = tmp_path / "report.html"
    write_report(made, path)
    return path


def test_it_opens_without_a_request_and_shows_what_it_should(
    made: Comparison, report: Path, tmp_path: Path
) -> None:
    log = tmp_path / "net.json"
    root = read_html(browse(report, f"--log-net-log={log}", "--dump-dom"))
    assert asked(log) == []
    assert len(root.all("section")) == 10
    body = root.one("body").text
    for label in made.labels:
        assert label in body
    assert [s.one("h2").text for s in root.all("section")][:2] == ["Summary", "The merged graph"]
    assert root.all("svg", "plot")
    assert not root.all("parsererror")


def test_the_check_sees_a_request_where_there_is_one(tmp_path: Path) -> None:
    page, log = tmp_path / "page.html", tmp_path / "net.json"
    page.write_text('<!doctype html><title>x</title><img src="http://example.invalid/x.png">')
    browse(page, f"--log-net-log={log}", "--dump-dom")
    assert asked(log) == ["http://example.invalid/x.png"]


def test_the_page_forbids_requests_even_were_one_smuggled_in(report: Path, tmp_path: Path) -> None:
    log = tmp_path / "net.json"
    smuggled = (
        '<img src="http://example.invalid/x.png"><script>document.title="run"</script></body>'
    )
    report.write_text(report.read_text().replace("</body>", smuggled))
    shown = browse(report, f"--log-net-log={log}", "--dump-dom")
    assert "example.invalid" in shown
    assert asked(log) == []
    assert "<title>run</title>" not in shown


def picture(path: Path) -> np.ndarray:
    from PIL import Image

    with Image.open(path) as shown:
        return np.asarray(shown.convert("RGB"))


@pytest.mark.parametrize("width", [390, 1280])
def test_a_screenshot_shows_it_and_nothing_hangs_over_the_edge(
    width: int, report: Path, tmp_path: Path
) -> None:
    shot = tmp_path / "shot.png"
    browse(report, f"--screenshot={shot}", f"--window-size={width},3000")
    seen = picture(shot)
    assert seen.shape == (3000, width, 3)
    page = seen[-1, 0]
    assert tuple(page) == (255, 255, 255)
    inked = (seen != page).any(axis=2)
    assert 0.02 < inked.mean() < 0.9
    assert not inked[:, -8:].any()  # what is wide scrolls in its own frame
    colours = np.unique(seen.astype(np.int64) @ (1 << 16, 1 << 8, 1))
    assert len(colours) > 50  # those of the plots among them


def test_pixels_of_heat_maps_stay_sharp(report: Path, tmp_path: Path) -> None:
    """A picture of 6 by 4 cells shows few colours between those of its cells."""
    text = report.read_text()
    root = read_html(text)
    uri = root.all("image")[0].attributes["href"]
    page, shot = tmp_path / "one.html", tmp_path / "one.png"
    style = text[text.index("<style>") : text.index("</style>") + 8]
    page.write_text(
        f'<!doctype html>{style}<body style="margin:0"><svg width="300" height="200" '
        f'viewBox="0 0 300 200"><image width="300" height="200" href="{uri}"/></svg>'
    )
    browse(page, f"--screenshot={shot}", "--window-size=300,200")
    assert len(np.unique(picture(shot)[:196].reshape(-1, 3), axis=0)) <= 6


def test_on_paper_nothing_is_folded_away(report: Path, tmp_path: Path) -> None:
    def pictures() -> int:
        paper = tmp_path / "report.pdf"
        browse(report, "--no-pdf-header-footer", f"--print-to-pdf={paper}")
        return paper.read_bytes().count(b"/Subtype /Image")

    folded = pictures()
    text = report.read_text()
    assert '<details id="frame-' in text  # some frame is folded on the screen
    report.write_text(text.replace("<details id=", "<details open id="))
    assert folded == pictures() > 10
