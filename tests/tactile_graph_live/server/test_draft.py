"""The pipeline that is worked on, and its YAML."""

from __future__ import annotations

from pathlib import Path

import pytest

import tactile_graph as tg
from helpers_live import FLOW
from tactile_graph.errors import PipelineError, UsageError
from tactile_graph_live.server.draft import Draft, faults, save

NESTED = """\
pipeline: nested
source: {step: sample, with: {name: discs}}
nodes:
  cheap: {use: circle-1, with: {footprint.level_v: 0.02}}  # quick
  middle:
    use: circle-3
  print: {step: threshold, in: frame, with: {level_v: 0.01}}
  areas: {step: split_contacts, in: [frame, print]}
  each_one: {use: circle-2, in: areas.contacts, each: true}
outputs: [cheap, middle, each_one]
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("node", "told"),
    [
        ("cheap/footprint", "{use: circle-1, with: {footprint.level_v: 0.03}}  # quick"),
        ("middle/footprint", "use: circle-3\n    with: {footprint.level_v: 0.03}\n"),
        ("each_one/footprint", "each: true, with: {footprint.level_v: 0.03}}"),
    ],
)
def test_a_setting_within_a_pipeline_that_is_used_is_written_where_it_is_used(
    tmp_path: Path, node: str, told: str
) -> None:
    draft = opened(tmp_path, NESTED).with_value(node, "level_v", 0.03)
    assert told in draft.text
    assert tg.loads(draft.text).key == draft.pipeline.key != tg.loads(NESTED).key
    assert draft.without_values(node, "level_v").text == NESTED


def opened(tmp_path: Path, text: str = FLOW) -> Draft:
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    return Draft.of(tg.load(path))


def test_what_is_set_runs_and_stands_in_the_yaml(tmp_path: Path) -> None:
    draft = opened(tmp_path).with_value("footprint", "level_v", 0.03)
    assert draft.pipeline.nodes["footprint"].settings["level_v"] == 0.03
    assert "level_v: 0.03" in draft.text
    assert tg.loads(draft.text).key == draft.pipeline.key
    assert draft.without_values().text == draft.file_text == FLOW


def test_one_setting_is_taken_back(tmp_path: Path) -> None:
    one = opened(tmp_path).with_value("footprint", "level_v", 0.03)
    both = one.with_value("footprint", "above", True)
    assert both.without_values("footprint", "above").text == one.text
    assert both.without_values("footprint", "nothing").text == both.text


def test_what_is_not_allowed_is_refused_and_named(tmp_path: Path) -> None:
    with pytest.raises(PipelineError, match=r"footprint\.level_v.*'high'"):
        opened(tmp_path).with_value("footprint", "level_v", "high")
    with pytest.raises(PipelineError, match="no node"):
        opened(tmp_path).with_value("footprnt", "level_v", 1)


def test_the_command_lines_settings_and_source_outlast_the_file(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(FLOW)
    pipeline = tg.load(path).with_settings({"footprint.level_v": 0.5}, ("simulate", {"frames": 3}))
    path.write_text(FLOW.replace("low_pass", "low_pass, with: {}"))
    again = Draft.of(pipeline).read_again().pipeline
    assert again.nodes["footprint"].settings["level_v"] == 0.5
    assert again.source is not None
    assert again.source.name == "simulate"


def test_the_file_wins_over_what_the_page_set(tmp_path: Path) -> None:
    draft = opened(tmp_path).with_value("footprint", "level_v", 0.03)
    again = draft.read_again()
    assert again.pipeline.nodes["footprint"].settings["level_v"] == 0.01
    assert again.set_here == {}


def test_another_source_is_noticed(tmp_path: Path) -> None:
    draft = opened(tmp_path)
    assert draft.same_source(draft.with_value("footprint", "level_v", 0.5))
    (tmp_path / "mine.yaml").write_text(FLOW.replace("sample, with: {name: discs}", "simulate"))
    assert not draft.same_source(draft.read_again())


def test_what_is_wrong_has_its_line_and_column(tmp_path: Path) -> None:
    draft = opened(tmp_path)
    path = draft.pipeline.file
    Path(path).write_text(FLOW.replace("threshold,", "treshold,").replace("low_pass", "lowpass"))
    with pytest.raises(PipelineError) as caught:
        draft.read_again()
    found = faults(caught.value, path)
    assert [(f.line, f.column) for f in found] == [(4, 18), (5, 21)]
    assert "did you mean 'threshold'" in found[1].text


def test_an_error_without_a_place_is_told_without_one() -> None:
    (fault,) = faults(ValueError("odd\x1b"), "x.yaml")
    assert (fault.line, fault.column, fault.text) == (0, 0, "ValueError: odd\\u001b")


def test_a_pipeline_is_saved_under_a_plain_name_only(tmp_path: Path) -> None:
    assert save(tmp_path, "mine", FLOW, "mine.yaml") == tmp_path / "mine.yaml"
    assert (tmp_path / "mine.yaml").read_text() == FLOW
    with pytest.raises(UsageError, match="there already"):
        save(tmp_path, "mine.yaml", FLOW, "mine.yaml")


def test_a_pipeline_saved_elsewhere_still_finds_what_it_uses(tmp_path: Path) -> None:
    (tmp_path / "pipes").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "pipes/inner.yaml").write_text(FLOW)
    text = "pipeline: outer   # mine\nnodes:\n  a: {use: inner.yaml, in: frame}\noutputs: [a]\n"
    path = save(tmp_path / "out", "saved", text, str(tmp_path / "pipes/outer.yaml"))
    assert path.read_text() == text.replace("inner.yaml", "../pipes/inner.yaml")
    assert tg.load(path).outputs


def test_a_pipeline_that_would_be_wrong_where_it_is_saved_is_not_written(tmp_path: Path) -> None:
    text = FLOW.replace("threshold", "treshold")
    with pytest.raises(UsageError, match="not written"):
        save(tmp_path, "mine", text, "mine.yaml")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "name",
    [
        "",
        "..",
        ".",
        ".hidden",
        "../out",
        "/etc/x",
        "a/b",
        "a\\b",
        "a b",
        "-o",
        "nul\0",
        "ä",
        "x" * 200,
    ],
)
def test_no_name_leads_out_of_the_folder(tmp_path: Path, name: str) -> None:
    with pytest.raises(UsageError, match="a name is of letters"):
        save(tmp_path, name, FLOW, "mine.yaml")
    assert list(tmp_path.iterdir()) == []


def test_a_name_that_is_too_long_is_told_so(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"'x{20}…': .* 100 at most, got 300"):
        save(tmp_path, "x" * 300 + ".yaml", FLOW, "mine.yaml")


READS = """\
pipeline: mine
source: {step: sample, with: {name: discs}}
nodes:
  footprint: {step: locate_disc, in: frame, with: {pad: pad.yaml}}
outputs: [footprint]
"""


def test_the_page_names_no_file_outside_the_folders(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    inside, secret = tmp_path / "inside", tmp_path / "secret.yaml"
    inside.mkdir()
    secret.write_text("password: hunter2\n")
    (inside / "pad.yaml").write_text("about: ours\n")
    (inside / "other.yaml").write_text("about: another\n")
    (inside / "link.yaml").symlink_to(secret)
    (inside / "mine.yaml").write_text(READS)
    monkeypatch.chdir(inside)
    draft = Draft.of(tg.load(inside / "mine.yaml"))
    for name in (str(secret), "../secret.yaml", "link.yaml", "~root/x", "/no/such", "x/../../y"):
        for value in (name, [name], {"a": name}):
            with pytest.raises(UsageError, match="leads out of") as caught:
                draft.with_value("footprint", "pad", value)
            assert "hunter2" not in str(caught.value)
    for name in ("other.yaml", str(inside / "other.yaml"), "./other.yaml", "thesis"):
        draft.with_value("footprint", "pad", name)
    given = Draft(draft.pipeline, draft.base, {"footprint": {"pad": str(secret)}})
    with pytest.raises(PipelineError):  # what the command line named may be named again
        given.with_value("footprint", "pad", str(secret))
