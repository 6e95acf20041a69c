"""CONTRIBUTING.md: its commands, files and examples are what is there and work."""

from __future__ import annotations

import re
import shlex
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from tactile_graph import Image, load
from tactile_graph.steps.signature import read_signature
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.devices.preset_file import load_preset

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "CONTRIBUTING.md"
pytestmark = pytest.mark.skipif(not PAGE.is_file(), reason="the page is not beside the tests")


def block(head: str) -> str:
    found = re.search(rf"^```{head}\n(.*?)^```", PAGE.read_text("utf-8"), re.M | re.S)
    assert found is not None, head
    return found[1]


def written(folder: Path, head: str) -> Path:
    path = folder / f"{head.split()[1]}.yaml"
    path.write_text(block(head), "utf-8")
    return path


def project() -> dict[str, Any]:
    data = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    return dict(data["project"])


def test_setting_up_installs_an_extra_there_is() -> None:
    steps = block("sh set up").strip().split(" && ")
    assert steps == ["python3 -m venv .venv", ".venv/bin/pip install -q -e '.[dev]'"]
    assert "dev" in project()["optional-dependencies"]


def test_every_check_shown_names_options_and_files_that_are_there() -> None:
    lines = [shlex.split(line, comments=True) for line in block("sh check").splitlines()]
    programs = {words[0] for words in lines}
    assert programs == {".venv/bin/pytest", ".venv/bin/ruff", ".ci/run"}
    assert (ROOT / ".ci/run").is_file()
    assert [
        w for line in lines for w in line if w.endswith(".py") and not (ROOT / w).is_file()
    ] == []


def test_the_tests_in_a_browser_are_named_and_what_they_need_is_an_extra() -> None:
    (line,) = block("sh browser").splitlines()
    assert (ROOT / shlex.split(line, comments=True)[-1]).is_dir()
    extras = project()["optional-dependencies"]
    assert any(need.startswith("playwright") for need in extras["browser"])
    assert any("browser" in need for need in extras["dev"])
    assert not any("playwright" in need for need in project()["dependencies"])


def test_every_path_the_text_names_is_there() -> None:
    named = re.findall(
        r"`((?:plugins|pipelines|tests|benchmarks)/[\w/.-]*)`", PAGE.read_text("utf-8")
    )
    assert len(named) >= 6
    assert [n for n in named if not (ROOT / n).exists()] == []


def test_the_step_shown_is_a_step_and_does_what_it_says() -> None:
    names: dict[str, Any] = {}
    exec(compile(block("python"), str(PAGE), "exec"), names)
    step = names["at_most"]
    assert [s.name for s in read_signature("at_most", step).settings] == ["most"]
    image = Image(np.array([[0.5, 2.0]]), (1.0, 1.0), (0.0, 0.0), "volt")
    assert step(image, most=1.5).values.tolist() == [[0.5, 1.5]]


@pytest.mark.slow
def test_the_pipeline_shown_runs(tmp_path: Path) -> None:
    results = list(load(written(tmp_path, "yaml pipeline")).stream())
    assert len(results) == 6
    assert all(r.ok for r in results)


def test_the_pad_and_the_preset_shown_are_read(tmp_path: Path) -> None:
    pad = load_pad(str(written(tmp_path, "yaml pad")))
    assert (pad.geometry.rows, pad.geometry.columns) == (12, 32)
    assert load_preset(str(written(tmp_path, "yaml preset"))).preset == "my-mat"


def test_the_citation_names_the_version_and_the_licence_of_the_project() -> None:
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    about = project()
    assert (cited["version"], cited["license"]) == (about["version"], about["license"])
    assert cited["cff-version"] == "1.2.0"
    assert {"message", "title", "authors"} <= set(cited)
