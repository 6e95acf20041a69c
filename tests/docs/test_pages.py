"""What the pages show: commands, pipelines, code, names in tables, and some of the numbers."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
from importlib.util import find_spec
from inspect import signature
from itertools import takewhile
from pathlib import Path
from types import ModuleType
from typing import Any

import click
import numpy as np
import pytest
from click.testing import CliRunner

from helpers_learning import MadeUpPad, untold
from tactile_graph import Circle, load, loads
from tactile_graph.cli import cli
from tactile_graph.errors import DataError, PipelineError
from tactile_graph.pipeline.conditions.conditions import FUNCTIONS
from tactile_graph.pipeline.declaration import NODE_KEYS, TOP_KEYS
from tactile_graph.plugins.core import tactile_graph_quantities
from tactile_graph.plugins.registry import installed
from tactile_graph.steps.signature import Kind, read_signature
from tactile_graph.testing import BrokenPromises, check_step
from tactile_graph_pads.circuits import Circuit, Divider, Feedback, Floating
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.devices.preset_file import load_preset
from tactile_graph_sources.writers.write_npz import write_npz
from tactile_graph_thesis.catalogue import chosen, items

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
MADE = DOCS / "catalogue"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
PAGES += [p for p in sorted(DOCS.rglob("*.md")) if MADE not in p.parents]
FILES = (".npz", ".npy", ".csv", ".zarr", ".yaml", ".html", ".md", ".jsonl")
pytestmark = pytest.mark.skipif(not DOCS.is_dir(), reason="the docs are not beside the tests")


def text(page: str) -> str:
    return (DOCS / f"{page}.md").read_text("utf-8")


def fenced(page: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", text(page), re.M | re.S)


def commands(page: Path) -> list[list[str]]:
    """Return the words of each ``tactile-graph`` command a page shows in a block."""
    found = []
    blocks = re.findall(
        r"^```(?:sh|console)[^\n]*\n(.*?)^```", page.read_text("utf-8"), re.M | re.S
    )
    for line in "".join(blocks).replace("\\\n", " ").splitlines():
        for part in line.split("&&"):
            words = shlex.split(part.removeprefix("$ "), comments=True)
            if words and words[0].endswith("tactile-graph"):
                found.append(list(takewhile(lambda w: w not in (">", "|", "||", "&"), words[1:])))
    return found


SHOWN = [(p.name, words) for p in PAGES for words in commands(p)]


@pytest.mark.parametrize(("page", "words"), SHOWN, ids=lambda v: v if isinstance(v, str) else v[0])
def test_every_command_shown_is_understood_and_what_it_names_exists(
    page: str, words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for word in words:
        if word.endswith(FILES) and "=" not in word:
            Path(word).touch()
    command = cli.get_command(click.Context(cli), words[0])
    assert command is not None, words
    context = command.make_context(words[0], list(words[1:]))  # raises at a wrong value or option
    given: dict[str, Any] = context.params
    names = [given[k] for k in ("pipeline", "source") if isinstance(given.get(k), str)]
    names += [w.split()[0] for w in given.get("variants", ())]
    found = installed()
    known = [n for n in names if found.has("pipelines", n) or found.has("steps", n)]
    assert [n for n in names if n not in known and not n.endswith(FILES)] == []
    if words[0] == "reproduce":
        chosen(given["names"])  # raises at a name that is none


# -- pipeline files --------------------------------------------------------------------------


def test_keys_functions_and_quantities_of_a_pipeline_file_are_all_told() -> None:
    page = text("pipelines")
    told = re.findall(r"^\| `(\w+)` \|", page, re.M)
    assert set(told) == {*TOP_KEYS, *NODE_KEYS}
    assert f"`+ - * / // %`, numbers, texts, `{' '.join(FUNCTIONS)}`" in page
    assert [q for q in tactile_graph_quantities() if f"`{q}`" not in page] == []


def test_the_pipelines_shown_within_others_run(tmp_path: Path) -> None:
    inner = next(block for block in fenced("pipelines", "yaml") if "my-shape" in block[:40])
    (tmp_path / "my-shape.yaml").write_text(inner)
    nodes = next(block for block in fenced("pipelines", "yaml") if "use: circle-3" in block)
    text = f"pipeline: p\n{nodes}outputs: [first, each]\n"
    result = loads(text, str(tmp_path / "p.yaml")).run(next(load("circle-3").frames()))
    assert isinstance(result["first"], Circle)
    assert any(isinstance(circle, Circle) for circle in result["each"])
    assert load(tmp_path / "my-shape.yaml").run(result.frame)["circle"].radius_cm > 1.0


def test_the_choice_shown_hands_over_from_cheap_to_careful() -> None:
    (nodes,) = (block for block in fenced("pipelines", "yaml") if "careful" in block)
    before = """pipeline: p
source: {step: sample}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: footprint}
  hull: {step: hull, in: boundary}
"""
    pipeline = loads(before + nodes.removeprefix("nodes:\n") + "outputs: [circle]\n")
    for result in pipeline.stream():
        good = result["cheap"].rms_cm < 0.3
        assert result["circle"] == (result["good"] if good else result["careful"])


def test_a_condition_with_a_comma_is_right_in_quotes() -> None:
    (condition,) = re.findall(r'`{…, (when: "max.*?")}`', text("pipelines"))
    frame = "pipeline: p\nsource: {step: sample}\nnodes:\n"
    contacts = "  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}\n"
    contacts += "  contacts: {step: contacts, in: [frame, footprint]}\n"
    node = f"  fine: {{step: subdivide, in: footprint, {condition}}}\noutputs: [fine]\n"
    assert loads(frame + contacts + node).nodes["fine"].guard is not None


def test_the_source_shown_for_recordings_is_allowed() -> None:
    (source,) = fenced("recordings", "yaml")
    rest = "nodes:\n  load: {step: load, in: frame}\noutputs: [load]\n"
    pipeline = loads(f"pipeline: p\n{source}{rest}")
    assert pipeline.source is not None
    assert pipeline.source.settings["rows"] == 12


def test_the_restorers_shown_are_allowed_and_a_wrong_setting_is_told_as_shown() -> None:
    first, second, wrong = fenced("fields", "yaml")
    head, tail = "pipeline: p\nsource: {step: sample}\n", "outputs: [restored]\n"
    model = loads(head + first + tail).nodes["restored"].settings["model"]
    assert (model.lambda_d, model.lines) == (2, "marginal")
    circle = "nodes:\n  circle: {use: circle-3, in: frame}\n"
    prior = loads(head + circle + second + tail).nodes["restored"].settings["model"]
    assert prior.lambda_prior == 1
    (told,) = re.findall(r"^```\n(mine\.yaml:.*?)\n```", text("fields"), re.M | re.S)
    with pytest.raises(PipelineError) as caught:
        loads(wrong, "mine.yaml")
    assert told in str(caught.value)


def test_the_presets_shown_are_presets(tmp_path: Path) -> None:
    n_cells = []
    for preset in fenced("devices", "yaml"):
        (tmp_path / "mine.yaml").write_text(preset, "utf-8")
        n_cells.append(load_preset(str(tmp_path / "mine.yaml")).geometry.n_cells)
    assert n_cells == [64, 256]


# -- code ------------------------------------------------------------------------------------


def test_the_plugin_shown_is_one() -> None:
    shown = [block for block in fenced("plugins", "python") if ".stacked = " not in block]
    spaces: list[dict[str, Any]] = [{"__name__": "shown"} for _ in shown]
    for code, space in zip(shown, spaces, strict=True):
        exec(compile(code, "plugins.md", "exec"), space)
    assert spaces[0]["tactile_graph_steps"]() == {"median": "tactile_graph_median.median:median"}
    target = spaces[1]["part"]
    target.__globals__.update(spaces[1])
    read = read_signature("part", target)
    assert [p.name for p in read.ports] == ["image"]
    assert [s.name for s in read.settings] == ["share"]
    assert read.fields == ("mask", "level")
    assert read.ports[0].quantity is not None
    assert read.ports[0].quantity.names == ("volt", "gram")
    ramp = spaces[2]["ramp"]
    ramp.__globals__.update(spaces[2])
    assert read_signature("ramp", ramp).kind is Kind.SOURCE
    frames = list(ramp(frames=3, rows=4))
    assert [(f.index, f.time_s, f.image.peak) for f in frames] == [
        (k, 0.01 * k, k) for k in range(3)
    ]
    (isolated,) = [s["tactile_graph_isolated"] for s in spaces if "tactile_graph_isolated" in s]
    assert isolated().keys() <= spaces[0]["tactile_graph_steps"]().keys()
    assert set(spaces[4]["alone"].times_us) < set(spaces[4]["both"].times_us)


def test_the_step_shown_keeps_the_promises_of_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    (code,) = (block for block in fenced("plugins", "python") if "def part(" in block)
    shown = ModuleType("shown_step")
    monkeypatch.setitem(sys.modules, "shown_step", shown)
    exec(compile(code, "plugins.md", "exec"), vars(shown))
    check_step(shown.part)


@pytest.mark.slow
def test_the_tests_shown_for_plugins_pass(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    (code,) = (block for block in fenced("plugins", "python") if "def test_" in block)
    shown = ModuleType("shown_tests")
    monkeypatch.setitem(sys.modules, "shown_tests", shown)
    exec(compile(code, "plugins.md", "exec"), vars(shown))
    tests = [(n, f) for n, f in vars(shown).items() if n.startswith("test_")]
    assert len(tests) == 3
    for _, test in tests:
        wanted = [] if hasattr(test, "hypothesis") else signature(test).parameters
        test(**{name: request.getfixturevalue(name) for name in wanted})


def test_the_stacked_form_shown_answers_as_its_step_does(monkeypatch: pytest.MonkeyPatch) -> None:
    (code,) = (block for block in fenced("plugins", "python") if ".stacked = " in block)
    shown = ModuleType("shown_stacked")
    monkeypatch.setitem(sys.modules, "shown_stacked", shown)
    exec(compile(code, "plugins.md", "exec"), vars(shown))
    shown.spread.stacked = lambda image, *, factor: shown.Answered(
        shown.Column(image.values[:, 0, 0])
    )
    with pytest.raises(BrokenPromises):
        shown.check_step(shown.spread)


@pytest.mark.slow
@pytest.mark.skipif(not find_spec("mypy"), reason="mypy is missing")
def test_the_steps_shown_have_the_types_that_a_new_package_checks(tmp_path: Path) -> None:
    shown = [code for code in fenced("plugins", "python") if "def test_" not in code]
    shown.append("\n".join(fenced("how-to/write-a-plugin", "python")))
    files = [tmp_path / f"shown_{k}.py" for k in range(len(shown))]
    for file, code in zip(files, shown, strict=True):
        file.write_text(code)
    got = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", *files],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert got.returncode == 0, got.stdout


def test_the_files_shown_of_a_new_package_are_those_it_has(tmp_path: Path) -> None:
    shown = [b for b in fenced("how-to/write-a-plugin", "text") if "pyproject.toml" in b]
    words = ["new", "tactile-graph-smooth", "--kind", "filter", "--into", str(tmp_path)]
    assert CliRunner().invoke(cli, words).exit_code == 0
    files = [p.relative_to(tmp_path).as_posix() for p in tmp_path.rglob("*") if p.is_file()]
    assert [b.split() for b in shown] == [sorted(files)]


@pytest.mark.slow  # takes seconds
def test_the_comparison_from_python_runs(capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = fenced("compare", "python")
    short = code.replace("n_frames=200", "n_frames=12")
    assert short != code
    exec(compile(short, "compare.md", "exec"), {"__name__": "shown"})
    assert "better" in capsys.readouterr().out


# -- names in tables -------------------------------------------------------------------------


@pytest.mark.parametrize("page", ["objects", "fields", "how-to/localise-anything"])
def test_pipelines_and_steps_that_head_rows_exist(page: str) -> None:
    tables = re.findall(r"^\| (pipeline|step) \|.*\n\|[-| ]+\n((?:\|.*\n)+)", text(page), re.M)
    for kind, rows in tables:
        names = re.findall(r"^\| `([\w-]+)`", rows, re.M)
        assert names
        assert [n for n in names if not installed().has(f"{kind}s", n)] == []


def test_every_preset_stands_in_the_table_of_kits() -> None:
    (rows,) = re.findall(r"^\| preset \| kit \|.*\n\|[-| ]+\n((?:\|.*\n)+)", text("devices"), re.M)
    told: set[str] = set()
    for row in rows.splitlines():
        first, *more = re.findall(r"`([\w-]+)`", row.split("|")[1])
        told |= {first, *((first.rsplit("-", 1)[0] + m) if m.startswith("-") else m for m in more)}
    assert told == set(installed().names("presets"))


def test_as_many_items_are_listed_as_told() -> None:
    assert f"# lists all {len(items())}\n" in text("reproduce")


# -- numbers ---------------------------------------------------------------------------------


def three_discs() -> tuple[np.ndarray, np.ndarray]:
    """Return the grams and conductances of the scene that docs/pad.md tells of."""
    pad = load_pad("plain")
    load = np.zeros(pad.geometry.shape)
    for x, y, radius, grams in ((4.5, 4.5, 4.3, 675), (14.2, 9.0, 6.1, 1090), (5, 15.5, 3.8, 1280)):
        covered = coverage_cm2(Circle(x, y, radius), pad.geometry)
        load += grams * covered / covered.sum()
    return load, pad.conductance_s(load)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [Divider, Floating, Feedback])
@pytest.mark.parametrize("driver_ohm", [0.0, 100.0])
def test_conductances_are_found_back_as_the_page_says(kind: type[Any], driver_ohm: float) -> None:
    load, siemens = three_discs()
    circuit: Circuit = kind(driver_ohm=driver_ohm)
    found = circuit.inverse(circuit.ratio(siemens))
    on = load > 10.0
    assert f"load {on.sum()} elements beyond the turn-on" in " ".join(text("pad").split())
    assert found.valid[on].all()
    np.testing.assert_allclose(found.siemens[on], siemens[on], rtol=1e-13)


def test_what_ignoring_the_circuit_costs_is_as_the_page_says() -> None:
    load, siemens = three_discs()
    on, idle = load > 10.0, load == 0.0

    def apparent(circuit: Circuit) -> np.ndarray:
        ratio = circuit.ratio(siemens)
        return np.asarray(ratio / (1.0 - ratio) / circuit.bias_ohm)

    off = np.abs(apparent(Divider())[on] / siemens[on] - 1.0).mean()
    ghost = apparent(Floating())[idle].max() / siemens.max()
    page = " ".join(text("pad").split())
    assert f"errs by {100 * off:.0f} % on average in the divider" in page
    assert f"seems to conduct {ghost:.1f} times as much as the most loaded one" in page


# -- a pad learned ---------------------------------------------------------------------------


@pytest.mark.slow
def test_the_commands_that_learn_a_pad_and_the_pipeline_on_it_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    pad = MadeUpPad(lean_cells=2.0, dead=((5, 6),))
    pad.recorded(tmp_path, n_empty=20, n_objects=60)
    for grams, height in ((500, 150.0), (1000, 250.0), (2000, 400.0)):
        name = {500: "500g", 1000: "1kg", 2000: "2kg"}[grams]
        frames = [pad.frame(((6.0 + k, 7.0, height),), k) for k in range(3)]
        write_npz(f"{name}.npz", untold(iter(frames)))
    Path("places.csv").write_text("recording,frame,x_cm,y_cm\nobjects.npz,0,5.1,4.4\n")
    page = DOCS / "how-to" / "learn-a-pad.md"
    learning = [words for words in commands(page) if words[0] == "learn-pad"]
    assert len(learning) == 5
    *here, told = [words for words in learning if "old-empty.npz" not in words]
    for words in reversed(here):
        done = CliRunner().invoke(cli, words, catch_exceptions=False)
        assert done.exit_code == 0, done.output
    assert Path("my-pad.html").stat().st_size > 10_000
    with pytest.raises(DataError, match="has 16 x 16 elements, the recordings have 14 x 20"):
        CliRunner().invoke(cli, told, catch_exceptions=False, standalone_mode=False)
    (pipeline,) = fenced("how-to/learn-a-pad", "yaml")
    result = next(iter(loads(pipeline).stream()))
    (contact,) = result["placed"].contacts
    assert contact.x_std_cm > 0.0


@pytest.mark.slow
def test_the_comparison_on_the_page_of_learned_pads_comes_out_as_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shown = commands(DOCS / "how-to" / "learn-a-pad.md")
    (worn,) = fenced("how-to/learn-a-pad", "python")
    (learn,) = (words for words in shown if "old-empty.npz" in words)
    (compare,) = (words for words in shown if words[0] == "compare")
    recordings = [words for words in shown if words[0] == "convert"]
    assert len(recordings) == 3
    for words in recordings:
        assert CliRunner().invoke(cli, words).exit_code == 0
    exec(worn, {})
    for words in (learn, [*compare, "--json", "found.json"]):
        done = CliRunner().invoke(cli, words, catch_exceptions=False)
        assert done.exit_code == 0, done.output
    told = json.loads(Path("found.json").read_text())
    assert [difference["verdict"] for difference in told["differences"]] == ["better", "better"]
    shipped, learned = (
        [score["mean"] for score in told["scores"] if score["variant"] == variant["label"]]
        for variant in told["variants"]
    )
    assert len(learned) == 2
    assert all(b < 0.5 * a for a, b in zip(shipped, learned, strict=True))


@pytest.mark.parametrize(
    "name", ["__getitem__", "get", "outcome", "times_us", "Results", "to_pandas"]
)
def test_the_page_for_programs_tells_what_a_stream_gives(name: str) -> None:
    told = re.findall(r"^ *\.\. auto\w+:: (?:\S+\.)?(\w+)$", (DOCS / "api.md").read_text(), re.M)
    assert name in told
