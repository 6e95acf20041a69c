"""docs/hooks.md: every example is a plugin that works."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from click.testing import CliRunner

from tactile_graph import Frame, Image, loads
from tactile_graph.cli import cli
from tactile_graph.draw.display import display_list
from tactile_graph.draw.paint_svg import SvgPicture, View
from tactile_graph.draw.strip import strip_figure
from tactile_graph.engine.tables.columns import columns_of, values_of
from tactile_graph.errors import PipelineError, PluginError
from tactile_graph.plugins import registry as registry_module
from tactile_graph.plugins.names import OWN
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.injected import Report
from tactile_graph.testing.plugin_check import examine_plugin
from tactile_graph_compare import compare
from tactile_graph_compare.output import tables
from tactile_graph_compare.report.page import page
from tactile_graph_sources.recording import recording
from tactile_graph_stress.judge import Judge
from tactile_graph_stress.study import cases_of
from tactile_graph_stress.subject import subjects
from tactile_graph_stress.trial import Trial
from tactile_graph_stress.verdict import Outcome

PAGE = Path(__file__).parents[2] / "docs" / "hooks.md"
pytestmark = pytest.mark.skipif(not PAGE.is_file(), reason="the docs are not beside the tests")
Plugin = Callable[[str], Registry]


def sections() -> dict[str, str]:
    """Return the Python code below each heading of the page."""
    parts = re.split(r"^## (.+)$", PAGE.read_text("utf-8"), flags=re.M)
    bodies = dict(zip(parts[1::2], parts[2::2], strict=True))
    found = {
        head: re.findall(r"^```python\n(.*?)^```", b, re.M | re.S) for head, b in bodies.items()
    }
    return {head: "\n".join(code) for head, code in found.items() if code}


@pytest.fixture
def plugin(monkeypatch: pytest.MonkeyPatch) -> Iterator[Plugin]:
    """Yield what installs the example of a section beside the project's own plugins."""
    own = [row for row in registry_module.found_plugins() if row[1] == OWN]

    def install(head: str) -> Registry:
        module = ModuleType("mypad")
        monkeypatch.setitem(sys.modules, "mypad", module)
        exec(compile(sections()[head], f"hooks.md, {head}", "exec"), vars(module))
        rows = [*own, ("mypad", "my-package", "1.0", lambda: module)]
        monkeypatch.setattr(registry_module, "found_plugins", lambda: rows)
        installed.cache_clear()
        return installed()

    yield install
    installed.cache_clear()


def mypad() -> ModuleType:
    return sys.modules["mypad"]


@pytest.mark.parametrize("head", sections())
def test_every_example_passes_the_check_of_plugins(plugin: Plugin, head: str) -> None:
    found = plugin(head)
    mine = next(p for p in found.plugins if p.name == "mypad")
    report = examine_plugin(mine, found)
    assert report.broken == []
    assert report.n_offers > 0


STROKES = """
pipeline: strokes
source: {step: strokes}
nodes:
  pressed: {step: threshold, in: frame, with: {level_v: 0.5}}
  at: {step: mask_points, in: pressed}
  stroke: {step: fit_stroke, in: at}
outputs: [stroke]
"""


def test_every_hook_told_of_is_there_and_has_an_example() -> None:
    told = re.findall(r"^\| \[`(\w+)`\]\((\S*)#\S+\)", PAGE.read_text("utf-8"), re.M)
    assert len(told) > 8
    assert {kind for kind, _ in told} <= set(installed().kinds)
    shown = {"": "\n".join(sections().values())}
    for _, where in told:
        shown.setdefault(where, (PAGE.parent / where).read_text("utf-8") if where else "")
    assert [k for k, where in told if f"def tactile_graph_{k}(" not in shown[where]] == []


def test_a_quantity_is_checked_along_the_wires_and_has_its_unit(plugin: Plugin) -> None:
    found = plugin("Quantities")
    text = """
        pipeline: forces
        nodes: {{force: {{step: newtons, in: frame}}, {}}}
        outputs: [{}]
    """
    pipeline = loads(text.format("all: {step: load, in: force}", "force"), registry=found)
    result = pipeline.run(Frame.of(np.full((3, 4), 100.0), quantity="gram"))
    force: Image = result["force"]
    assert (force.quantity, force.unit) == ("newton", "N")
    assert force.total == pytest.approx(12 * 0.980665)
    with pytest.raises(PipelineError, match=r"takes counts.*at port .image., got newton"):
        loads(text.format("v: {step: volts, in: force}", "v"), registry=found)


def test_a_unit_stands_over_every_column_whose_name_ends_in_it(plugin: Plugin) -> None:
    found = plugin("Units")
    text = "{pipeline: p, nodes: {p: {step: pressures, in: frame}}, outputs: [p]}"
    (columns,) = columns_of(loads(text, registry=found), ("p",))
    assert [(c.field, c.unit) for c in columns.values] == [("mean", "mmHg"), ("peak", "mmHg")]


@pytest.mark.slow
def test_a_shape_of_ones_own_has_errors_in_run_and_compare(plugin: Plugin) -> None:
    found = plugin("Shapes of your own")
    pipeline = loads(STROKES, registry=found)
    (columns,) = columns_of(pipeline, ("stroke",))
    assert [(c.key, c.unit) for c in columns.errors] == [
        ("stroke.centre_error_cm", "cm"),
        ("stroke.length_error_cm", "cm"),
    ]
    result = pipeline.run(next(pipeline.frames()))
    values = values_of(result, columns)
    assert values["stroke.length_error_cm"] == pytest.approx(0.0)
    compared = compare([pipeline], n_frames=3, registry=found)
    score = compared.score("strokes", "length")
    assert score is not None
    assert (score.unit, score.n_answered, score.mean) == ("cm", 3, pytest.approx(0.0))
    assert "length cm" in {row[0] for row in tables.errors(compared).rows}
    assert "length 0.000 cm" in page(compared).replace("+", "")


@pytest.mark.slow
def test_a_shape_of_ones_own_is_drawn_in_strips_and_reports(plugin: Plugin) -> None:
    found = plugin("Shapes of your own")
    stroke = mypad().Stroke(1.0, 2.0, 4.0, 2.0)
    records = display_list(stroke, "true")
    assert [type(r).__name__ for r in records] == ["Area", "Outline", "Label"]
    assert {getattr(r, "role", "") for r in records} == {"true"}
    picture = SvgPicture(View.of(Image(np.zeros((5, 5)))), records)
    assert [line.split()[0] for line in picture.lines] == ["<path"] * 3 + ["<text"] * 2
    assert ">3.0 cm</text>" in picture.lines[-1]
    pipeline = loads(STROKES, registry=found)
    axes = strip_figure([pipeline.run(next(pipeline.frames()))]).axes
    drawn = next(a for a in axes if a.get_title().startswith("stroke"))
    assert [t.get_text() for t in drawn.texts] == ["3.0 cm"]
    assert len(drawn.patches) == 1


@pytest.mark.slow
def test_a_format_is_recognised_read_and_written(plugin: Plugin, tmp_path: Path) -> None:
    plugin("Recordings, read and written")
    path = tmp_path / "any.name"
    path.write_text("MYPAD 2 3 0.5\n1 2 3 4 5 6\n1 2\n6 5 4 3 2 1\n")
    first, second = recording(path=path, flip="rows", report=Report())
    assert first.image.values.tolist() == [[4, 5, 6], [1, 2, 3]]
    assert (first.image.pitch_cm, first.image.quantity) == ((0.5, 0.5), "volt")
    assert (second.index, second.gap) == (1, True)
    target = tmp_path / "back.mypad"
    got = CliRunner().invoke(cli, ["convert", str(path), str(target)])
    assert got.exit_code == 0, got.output
    assert "left out, as a .mypad has no place for it: gaps" in got.output
    back = [*recording(path=target, report=Report())]
    assert [f.image.values.tolist() for f in back] == [
        [[1, 2, 3], [4, 5, 6]],
        [[6, 5, 4], [3, 2, 1]],
    ]


def test_a_format_that_fails_to_recognise_is_told_by_plugin(
    plugin: Plugin, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plugin("Recordings, read and written")
    bad = mypad().FORMAT._replace(recognises=lambda head: head.nothing)
    monkeypatch.setattr(mypad(), "FORMAT", bad)
    path = tmp_path / "x"
    path.write_text("hello")
    told = r"format \"mypad's .mypad\" of plugin 'mypad' .* cannot tell whether .*x is one: Attr"
    with pytest.raises(PluginError, match=told):
        next(iter(recording(path=path, report=Report())))


def test_inspect_names_file_and_line_where_a_format_fails_to_read(
    plugin: Plugin, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plugin("Recordings, read and written")

    def read(reading: object) -> None:
        raise ValueError("row is odd")

    bad = mypad().FORMAT._replace(recognises=lambda head: True, read=read)
    monkeypatch.setattr(mypad(), "FORMAT", bad)
    path = tmp_path / "x"
    path.write_text("hello")
    got = CliRunner().invoke(cli, ["inspect", str(path)])
    assert got.exit_code == 2
    assert f"{path}: its reader breaks: ValueError: row is odd ({__file__}:" in got.output


def test_a_format_that_fails_to_recognise_leaves_the_others_to_be_asked(
    plugin: Plugin,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    plugin("Recordings, read and written")
    bad = mypad().FORMAT._replace(recognises=lambda head: 1 / 0)
    monkeypatch.setattr(mypad(), "FORMAT", bad)
    path = tmp_path / "table.csv"
    path.write_text("1,2\n3,4\n")
    for _ in range(2):
        (frame,) = recording(path=path, rows=2, columns=2, report=Report())
        assert frame.image.values.tolist() == [[1, 2], [3, 4]]
    (line,) = capsys.readouterr().err.splitlines()  # once, however often it is asked
    assert line.startswith("recording format \"mypad's .mypad\" of plugin 'mypad' ")
    assert line.endswith(
        "is one: ZeroDivisionError: division by zero; the other formats were asked"
    )


def test_a_format_that_cannot_be_imported_leaves_the_others_to_be_asked(
    plugin: Plugin,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    plugin("Recordings, read and written")
    monkeypatch.delattr(mypad(), "FORMAT")
    path = tmp_path / "table.csv"
    path.write_text("1,2\n3,4\n")
    (frame,) = recording(path=path, rows=2, columns=2, report=Report())
    assert frame.image.shape == (2, 2)
    assert "mypad has no 'FORMAT'; the other formats are asked" in capsys.readouterr().err


SILENT = """
pipeline: silent
source: {step: sample, with: {name: discs}}
nodes:
  pressed: {step: threshold, in: frame, with: {level_v: 0.01}}
  many: {step: mask_points, in: pressed, when: pressed.count > 1000}
outputs: [many]
"""


@pytest.mark.slow
def test_a_section_stands_in_the_report_before_how_it_was_made(plugin: Plugin) -> None:
    found = plugin("Report sections")
    told = page(compare([loads(SILENT, registry=found)], n_frames=3))
    headings = re.findall(r"<h2>(.*?)</h2>", told)
    assert headings[0] == "Summary"
    assert headings[-2:] == ["Who was silent", "How it was made"]
    assert "<b>silent</b> gave nothing in 3 frames" in told


def test_a_section_that_fails_says_so_in_its_place(
    plugin: Plugin, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = plugin("Report sections")
    bad = mypad().SILENT._replace(body=lambda comparison, album: comparison.nothing)
    monkeypatch.setattr(mypad(), "SILENT", bad)
    told = page(compare([loads(SILENT, registry=found)], n_frames=1))
    assert "This section could not be made: AttributeError: " in told
    assert "How it was made" in told


@pytest.mark.slow
def test_an_exporter_writes_what_a_run_comes_to(plugin: Plugin, tmp_path: Path) -> None:
    plugin("Exporters")
    target = tmp_path / "circles.md"
    got = CliRunner().invoke(cli, ["run", "circle-3", "--frames", "2", "-o", str(target)])
    assert got.exit_code == 0, got.output
    head, rule, *rows = target.read_text().splitlines()
    assert "| circle.radius_cm | " in head
    assert set(rule) == set("| -")
    assert [row.split(" | ")[0] for row in rows] == ["| 0", "| 1"]
    got = CliRunner().invoke(cli, ["run", "circle-3", "-o", "x.md", "--full"])
    assert "--full: Markdown holds single numbers only" in got.output
    got = CliRunner().invoke(cli, ["run", "circle-3", "--format", "mdx"])
    assert "--format mdx: is none of jsonl" in got.output
    assert "did you mean 'md'?" in got.output


@pytest.mark.slow
def test_an_executor_is_named_by_on(plugin: Plugin, tmp_path: Path) -> None:
    plugin("Executors")
    one, two = tmp_path / "one.csv", tmp_path / "two.csv"
    words = ["run", "circle-1", "--frames", "40", "-o"]
    assert CliRunner().invoke(cli, [*words, str(one)]).exit_code == 0
    got = CliRunner().invoke(cli, [*words, str(two), "--on", "threads"])
    assert got.exit_code == 0, got.output
    assert two.read_bytes() == one.read_bytes()
    got = CliRunner().invoke(cli, [*words, str(two), "--on", "thread"])
    assert "did you mean 'threads'?" in got.output


@pytest.mark.slow
def test_a_device_is_listed_and_recorded_with(plugin: Plugin, tmp_path: Path) -> None:
    plugin("Capture devices")
    listed = CliRunner().invoke(cli, ["ports"])
    assert "left  a pad of 4 x 4 cells  --device bench" in listed.output
    target = tmp_path / "pad.zarr"
    words = ["record", str(target), "--device", "bench", "--port", "left", "--frames", "3"]
    got = CliRunner().invoke(cli, [*words, "--with", "gain=2"])
    assert got.exit_code == 0, got.output
    frames = [*recording(path=target, report=Report())]
    assert [f.image.total for f in frames] == [8.0, 16.0, 24.0]
    assert {f.label for f in frames} == {"left"}


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--device", "bench"], "Missing option '--port' (or '--source')"),
        (["--device", "bench", "--port", "left", "--baud", "9"],
         "--baud is nothing that --device bench takes"),
        (["--device", "bensh", "--port", "left"], "no device named 'bensh'; did you mean 'bench'?"),
    ],
)  # fmt: skip
def test_a_device_named_wrongly_is_told(
    plugin: Plugin, tmp_path: Path, words: list[str], told: str
) -> None:
    plugin("Capture devices")
    got = CliRunner().invoke(cli, ["record", str(tmp_path / "x.zarr"), *words])
    assert got.exit_code == 2
    assert told in got.output


@pytest.mark.slow
def test_steps_are_stressed_with_a_plugins_cases_too(plugin: Plugin) -> None:
    found = plugin("Stress cases")
    by_name = {subject.name: subject for subject in subjects(found)[0]}
    circle, ellipse = (
        cases_of(by_name[name], 0, quick=True) for name in ("fit_circle_kasa", "fit_ellipse")
    )
    assert {case.group for case in circle} >= {"scale", "turn", "NaN", "huge mat"}
    assert "huge mat" not in {case.group for case in ellipse}
    (mine,) = (case for case in circle if case.group == "huge mat")
    judge = Judge(Trial(by_name["fit_circle_kasa"], 0, found), np.random.default_rng(1))
    assert judge.of(mine).outcome in (Outcome.EXACT, Outcome.GOOD)


@pytest.mark.slow
def test_a_quantity_may_be_told_to_a_recording_and_is_offered_where_settings_are_shown(
    plugin: Plugin, tmp_path: Path
) -> None:
    plugin("Quantities")
    path = tmp_path / "forces.csv"
    path.write_text("1,2\n3,4\n")
    (frame,) = recording(path=path, quantity="newton", rows=2, report=Report())
    assert frame.image.unit == "N"
    page_of_step = CliRunner().invoke(cli, ["steps", "recording"]).output
    assert "newton" in page_of_step
    schema = CliRunner().invoke(cli, ["schema"]).output
    assert '"binary", "newton"' in " ".join(schema.split())
