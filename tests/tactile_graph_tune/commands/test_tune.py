"""``tactile-graph tune`` as people call it."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import pytest

from helpers_cli import call
from helpers_tune import LADDER

INNER = """\
pipeline: inner
nodes:
  circle: {step: disc, in: frame.mask}
outputs: [circle]
"""
QUICK = ("--rounds", "1", "--field", "load.total", "--field", "first.radius_cm")


@pytest.mark.slow
def test_a_ladder_comes_out_with_its_numbers_its_file_its_plot_and_all_figures(hand_made):
    got = call("tune", "ladder.yaml", "--frames", "24", *QUICK, "-o", "out.yaml", "--plot",
               "out.svg", "--json", "out.json")  # fmt: skip
    assert got.exit_code == 0, got.output
    for text in ("choices weighed on", "Time and error", "as given", "always the best", "tuned",
                 "oracle", "Pareto front", "of the time as given"):  # fmt: skip
        assert text in got.output
    assert Path("out.yaml").read_text().startswith("# Guards and order by 'tactile-graph tune")
    assert call("check", "out.yaml").exit_code == 0
    assert call("audit", "out.yaml", "--frames", "8").exit_code in (0, 2)
    drawn = Path("out.svg").read_text()
    assert "<svg" in drawn
    data = json.loads(Path("out.json").read_text())
    assert data["weighed"] > 100
    assert data["points"]["tuned"]["run"]["error"]["mean"] <= 2.0
    made = data["provenance"]
    assert (made["seed"], made["source"]["step"], made["held_out"]) == (0, "made", {})
    assert {"code", "command", "frames", "versions", "plugins", "truth", "file"} <= set(made)
    head = " ".join(Path("out.yaml").read_text().replace("# ", "").split())
    assert "frames of made (frames: 24, empty: [3, 7]), seed 0" in head


@pytest.mark.slow
def test_a_file_written_elsewhere_still_finds_what_it_uses(hand_made):
    Path("sub").mkdir()
    Path("out").mkdir()
    Path("sub/inner.yaml").write_text(INNER)
    Path("outer.yaml").write_text(LADDER.replace("{step: disc, in: merged, with: {fail_at_x: 1}}",
                                                 "{use: sub/inner.yaml, in: merged}"))  # fmt: skip
    got = call("tune", "outer.yaml", "--frames", "24", *QUICK[:4], "-o", "out/t.yaml")
    assert got.exit_code == 0, got.output
    assert "use: ../sub/inner.yaml" in Path("out/t.yaml").read_text()
    assert call("check", "out/t.yaml").exit_code == 0


@pytest.mark.slow
def test_shares_of_the_frames_to_come_are_told(hand_made):
    empty = ",".join(str(k) for k in range(0, 24, 2))
    got = call("tune", "ladder.yaml", "--source", "made", "--with", "frames=24", "--with",
               f"empty=[{empty}]", *QUICK, "--share", "empty=0.9")  # fmt: skip
    assert got.exit_code == 0, got.output
    assert "weighed so that empty 90 % of all" in " ".join(got.output.split())


@pytest.mark.slow
def test_what_is_to_be_kept_is_kept(hand_made):
    words = ("ladder.yaml", "--frames", "24", *QUICK, "--field", "footprint.count")
    goal = ("--error-at-most", "2", "--missed-at-most", "1", "--false-at-most", "1")
    assert call("tune", *words, *goal, "-o", "out.yaml").exit_code == 0
    got = call("tune", *words, *goal, "--keep", "touched", "-o", "kept.yaml")
    assert got.exit_code == 0, got.output
    kept, free = Path("kept.yaml").read_text(), Path("out.yaml").read_text()
    assert "touched: footprint.count > 0" in kept
    assert "touched: footprint.count > 0\n" not in free


@pytest.mark.slow
def test_a_free_setting_is_chosen_where_it_errs_less(hand_made):
    wrong = LADDER.replace("level_v: 0.5", "level_v: 1.5")  # nothing is that heavy
    Path("wrong.yaml").write_text(wrong)
    got = call("tune", "wrong.yaml", "--frames", "16", *QUICK, "--free",
               "footprint.level_v=0.4,0.6", "--error-at-most", "1.5")  # fmt: skip
    assert got.exit_code == 0, got.output
    assert "footprint.level_v = 0." in got.output


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (("ladder.yaml", "--frames", "1"), "1 frame with a known truth"),
        (("ladder.yaml", "--field", "load.totl"), "no node of pipeline 'ladder' has it"),
        (("ladder.yaml", "--answer", "circel"), "did you mean 'circle'"),
        (("ladder.yaml", "--error", "angel"), "did you mean 'angle'"),
        (("ladder.yaml", "--free", "footprint.level_x=1:2"), "did you mean 'footprint.level_v'"),
        (("ladder.yaml", "--keep", "tuoched"), "did you mean 'touched'"),
        (("ladder.yaml", "--share", "empty"), "must be empty=SHARE or LABEL=SHARE"),
        (("ladder.yaml", "--share", "film=0.5"), "--share film=0.5: no frame is of it"),
        (("ladder.yaml", "-o", "ladder.yaml"), "is there already; name another file"),
        (("ladder.yaml", "-o", "out.txt"), "a pipeline file ends in .yaml"),
        (("ladder.yaml", "--plot", "out.txt"), "its name must end in .png"),
        (("ladder.yaml", "--plot", os.devnull), "its name must end in .png"),
        (("ladder.yaml", "--error-at-most", "1", "--time-at-most", "1"), "not both"),
        (("ladder.yaml", "--time-at-most", "0", *QUICK), "the cheapest choice takes"),
        (("discs", "--with", "frames=9", "--set", "circle.crash=true"),
         "has a value in none of 9 frames"),
        (("ladder.yaml", "--error", "angle"), "frames the truth says nothing of 'angle'"),
        (("loads", "one.txt"), "none of 9 frames has a truth"),
        (("loads",), "'loads' declares no source"),
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_told_in_a_sentence(hand_made, args, message):
    Path("one.txt").write_text("1\n" * 9)
    got = call("tune", *args)
    assert got.exit_code == 2, got.output
    assert message in " ".join(got.output.split())
    assert "Traceback" not in got.output


def test_a_pipeline_without_anything_to_choose_says_so(hand_made):
    text = "pipeline: bare\nsource: {step: made, with: {frames: 9}}\nnodes:\n"
    text += "  mask: {step: pressed, in: frame}\n  circle: {step: disc, in: mask}\n"
    Path("bare.yaml").write_text(text + "outputs: [circle]\n")
    got = call("tune", "bare.yaml", "--field", "circle.radius_cm")
    assert got.exit_code == 2
    assert "pipeline 'bare': nothing to choose: it has no guard" in got.output


def test_frames_in_none_of_which_anything_lies_are_refused(hand_made):
    empty = ",".join(map(str, range(24)))
    got = call("tune", "ladder.yaml", "--source", "made", "--with", "frames=24", "--with",
               f"empty=[{empty}]", *QUICK)  # fmt: skip
    assert got.exit_code == 2
    assert "nothing lies in any of the 12 frames that choose" in " ".join(got.output.split())


@pytest.mark.slow
def test_only_numbers_are_chosen_where_that_is_asked_for(hand_made):
    got = call("tune", "ladder.yaml", "--frames", "24", "--rounds", "1", "--levels",
               "-o", "out.yaml")  # fmt: skip
    assert got.exit_code == 0, got.output
    assert " is as good" in " ".join(got.output.split())
    text = Path("out.yaml").read_text()
    assert text.startswith("# Numbers in guards by 'tactile-graph tune ladder --levels': ")

    def bare(text: str) -> list[str]:
        kept = [re.sub(r"\b\d+(\.\d+)?\b", "N", line) for line in text.splitlines()]
        left = ("#", "pipeline:", "evolves:", "about:")
        return [line for line in kept if not line.lstrip().startswith(left)]

    swapped = (("touched and volt", "volt and touched"),
               ("load.total < 9 and touched", "touched and load.total < 9"))  # fmt: skip
    given = LADDER
    for one, other in swapped:
        given = given.replace(one, other)
    assert bare(text) == bare(given)


def test_numbers_alone_are_refused_where_no_guard_has_one(hand_made):
    Path("none.yaml").write_text(
        LADDER.replace("footprint.count > 0", "load.total > load.x_cm - 9")
        .replace("load.total < 9 and ", "")
        .replace(", when: first.radius_cm > 0.9", "")
    )
    got = call("tune", "none.yaml", "--frames", "24", "--rounds", "1", "--levels")
    assert got.exit_code == 2
    assert "--levels: no guard of pipeline 'ladder' that may be chosen compares" in " ".join(
        got.output.split()
    )


@pytest.mark.slow
def test_truth_is_counted_as_convert_counts_it(tmp_path):
    lines = [",".join(str(c % 16 * 3 + c // 16 * (k % 3)) for c in range(256)) for k in range(6)]
    lines[2], lines[5] = lines[2][:90], lines[5][:90]
    (tmp_path / "bad.csv").write_text("\n".join(lines) + "\n")
    truth = tmp_path / "truth.csv"
    truth.write_text("frames,kind,x_cm,y_cm,radius_cm\n4-5,circle,1,2,3\n")
    got = call("tune", "circle-3", tmp_path / "bad.csv", "--truth", truth)
    said = " ".join(got.output.split())
    assert "those that were left out, of which 2 is the first, count too" in said
    assert "1 frame with a known truth" in said  # the last one, which is cut, is no frame too many
