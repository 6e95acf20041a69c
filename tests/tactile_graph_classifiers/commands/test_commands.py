"""The commands learn, forget, objects and identify, from the command line as people call them."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from tactile_graph import Frame
from tactile_graph.api.pipeline import load
from tactile_graph.cli import cli
from tactile_graph.cli.endings import ending
from tactile_graph_classifiers.commands.identify import _Lines
from tactile_graph_classifiers.distances.identity import UNKNOWN, Identity
from tactile_graph_sources.writers.write_npz import write_npz

DISCS = {"small": (500.0, 3.8), "large": (2500.0, 6.9), "strange": (5000.0, 5.0)}


@pytest.fixture(scope="module")
def recordings(tmp_path_factory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("recordings")
    paths = {}
    for seed, (name, (grams, radius)) in enumerate(DISCS.items()):
        scene = {"objects": [{"shape": "disc", "name": name, "weight_g": grams,
                              "radius_cm": radius}]}  # fmt: skip
        pipeline = load("features").with_source("simulate", scene=scene, frames=12)
        paths[name] = folder / f"{name}.npz"
        write_npz(paths[name], pipeline.frames(seed))
    return paths


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def run(*args: object) -> tuple[int, str, str]:
    """Return the exit code, the answer, and what was told beside it."""
    with CliRunner().isolation() as (out, err, _):
        code = ending(lambda: cli.main([*map(str, args)], standalone_mode=False), False)
        return code, out.getvalue().decode(), err.getvalue().decode()


def call(*args: object) -> tuple[int, str]:
    """Return the exit code and all that was said."""
    code, answer, told = run(*args)
    return code, answer + told


def answer(*args: object) -> tuple[int, str]:
    """Return the exit code and the answer alone: kernels may be compiled on the way."""
    return run(*args)[:2]


def learned(recordings: dict[str, Path]) -> None:
    for name in ("small", "large"):
        assert call("learn", name, recordings[name])[0] == 0


def test_objects_are_learned_listed_described_and_forgotten(recordings):
    code, text = answer("learn", "small", recordings["small"], "--frames", 5)
    assert (code, text.strip()) == (
        0, "tactile-objects.sqlite: small (disc): 5 readings learned, 5 in all"
    )  # fmt: skip
    assert "7 readings learned, 12 in all" in call(
        "learn", "small", recordings["small"], "--frames", "5:"
    )[1]  # fmt: skip
    code, text = answer("objects")
    assert code == 0
    assert "measured by describe, readings in gram" in text
    assert [line.split()[:3] for line in text.splitlines()[2:]] == [["small", "disc", "12"]]
    code, text = call("objects", "small")
    assert code == 0
    assert "load_offset_cm" in text
    assert answer("forget", "small") == (
        0, "tactile-objects.sqlite: small forgotten, with 12 readings\n"
    )  # fmt: skip
    assert answer("objects") == (0, "tactile-objects.sqlite: no objects\n")


@pytest.mark.slow
def test_an_object_is_renamed_merged_and_forgotten_by_recording(recordings):
    learned(recordings)
    told = answer("objects", "--rename", "small", "Mu\u0308nze")
    assert told == (0, "tactile-objects.sqlite: small is M\u00fcnze now, 12 readings\n")
    assert "M\u00fcnze, disc, 12 readings" in call("objects", "Mu\u0308nze")[1]
    code, text = call("objects", "--rename", "large", "M\u00fcnze")
    assert code == 2
    assert "'M\u00fcnze' is there already, with 12 readings; name another, or let" in text
    assert call("objects", "--rename", "large", "M\u00fcnze", "--merge")[0] == 0
    code, text = call("forget", "M\u00fcnze", "--recording", recordings["large"])
    assert code == 0
    assert f"12 readings of M\u00fcnze forgotten, those of {recordings['large']}" in text
    assert answer("forget", "M\u00fcnze", "--recording", recordings["small"]) == (
        0, "tactile-objects.sqlite: M\u00fcnze forgotten, with 12 readings\n"
    )  # fmt: skip


@pytest.mark.slow
def test_learning_the_same_frames_twice_is_told(recordings):
    assert "count twice" not in call("learn", "small", recordings["small"], "--frames", 4)[1]
    code, answered, told = run("learn", "small", recordings["small"], "--frames", "2:7")
    assert code == 0
    assert "5 readings learned, 9 in all" in answered
    assert "2 of these were learned before, from the same frames or a copy of them, and" in told
    assert "tactile-graph forget small begins anew" in told
    shutil.copy(recordings["small"], "copy.npz")
    assert "7 of these were learned before" in call("learn", "small", "copy.npz", "--frames", 7)[1]
    assert "count twice" not in call("learn", "large", recordings["small"], "--frames", 3)[1]


@pytest.mark.slow
def test_a_name_like_a_known_one_is_told_with_whether_they_look_the_same(recordings):
    learned(recordings)
    told = run("learn", " Small", recordings["small"])[2]
    assert "'Small' is a new object beside 'small', " in told
    assert "so they look the same; did you mean 'small'? Then tactile-graph forget Small" in told
    assert "did you mean" not in run("learn", "Small", recordings["small"])[2]
    told = run("learn", "LARGE", recordings["small"])[2]
    assert "beside 'large', 0 of whose 24 readings are named as the other when left out;" in told


@pytest.mark.slow
def test_few_readings_are_told_where_they_make_shares_and_strangers_a_guess(recordings):
    for name in ("small", "large"):
        *_, told = run("learn", name, recordings[name], "--frames", 3)
    few = "fewer than 10 readings of large (3), small (3)"
    assert f"these shares tell little yet: {few}, which leave it guessing" in told
    assert few in run("objects")[2]
    assert f"strangers may pass for known, and margins say little: {few}; learn more" in run(
        "identify", recordings["strange"], "--frames", 1
    )[2]  # fmt: skip
    for name in ("small", "large"):
        told = run("learn", name, recordings[name], "--frames", "3:")[2]
    assert "fewer than" not in told + run("identify", recordings["small"], "--frames", 1)[2]


@pytest.mark.slow
def test_what_is_named_right_without_its_recording_is_told(recordings):
    run("learn", "small", recordings["small"])
    told = run("learn", "large", recordings["large"])[2]
    assert "of one recording: large, small; if its frames are of one press, what is named" in told
    assert "of their recording are left out" not in told
    shutil.copy(recordings["small"], "again.npz")
    told = run("learn", "large", "again.npz")[2]  # without one, large is what the other is
    assert "0.0 % of 24 readings are named right when all of their recording are left out" in told
    assert "of one recording: small; " in told


@pytest.mark.slow
def test_recordings_are_identified_frame_by_frame_and_strangers_are_unknown(recordings):
    learned(recordings)
    code, text = answer("identify", recordings["large"], recordings["strange"], "--frames", "11:14")
    lines = text.splitlines()
    assert code == 0
    assert lines[0].split() == ["frame", "object", "distance", "runner-up", "margin"]
    assert lines[1].split()[:2] == ["11", "large"]
    assert lines[1].split()[3] == "small"
    assert lines[2].split()[:2] == ["12", "unknown"]
    assert "nearest: large, accepted up to" in lines[2]
    assert lines[2].endswith("(truly strange)")
    assert lines[4:] == ["unknown: 2, large: 1", "right: 1 of 3"]


@pytest.mark.slow
def test_recordings_of_several_presses_are_named_once_each(recordings):
    learned(recordings)
    both = (recordings["large"], recordings["strange"])
    code, text = answer("identify", *both, "--together", "recording")
    lines = text.splitlines()
    assert code == 0
    assert lines[0].split() == [
        "recording", "presses", "object", "distance", "runner-up", "margin"
    ]  # fmt: skip
    assert lines[1].split()[:3] == ["large.npz", "12", "large"]
    assert lines[2].split()[:3] == ["strange.npz", "12", "unknown"]
    assert lines[2].endswith("(truly strange)")
    assert lines[3:] == ["large: 1, unknown: 1", "right: 1 of 2"]
    code, text = answer("identify", recordings["large"], recordings["large"], "--together", "all")
    assert text.splitlines()[1].split()[:3] == ["all", "24", "large"]
    code, text, told = run("identify", both[0], "--together", "all", "--pipeline", "identify")
    assert (code, text) == (2, "")
    assert "'mahalanobis' of node 'identity' names each reading by itself" in told


@pytest.mark.slow
def test_presses_of_several_objects_are_not_named_together(recordings):
    learned(recordings)
    scene = "scene={in_turn: [[{shape: disc, name: %s, weight_g: 500, radius_cm: 3.8}], []%s]}"
    source = ("identify", "--source", "simulate", "--together", "recording", "--frames", 6,
              "--with")  # fmt: skip
    code, text, told = run(*source, scene % ("small", ""))
    assert (code, told) == (0, "left out: 3 frames: when touched is false\n")
    assert text.splitlines()[1].split()[:3] == ["recording", "3", "small"]
    other = ", [{shape: disc, name: large, weight_g: 2500, radius_cm: 6.9}]"
    code, text, told = run(*source, scene % ("small", other))
    assert code == 2
    assert "--together: recording holds several objects: large, small; name one object" in told
    code, text, told = run(*source, "scene={objects: []}")
    assert code == 2
    assert "the source gave no frame in which an object could be named" in told


@pytest.mark.slow
def test_export_and_import_move_objects_between_databases(recordings):
    learned(recordings)
    assert answer("objects", "--export", "o.yaml")[1] == "o.yaml: 2 objects exported\n"
    code, text = answer("objects", "--import", "o.yaml", "--database", "b.sqlite")
    assert (code, text.splitlines()[0]) == (0, "b.sqlite: 2 objects imported")
    assert answer("objects", "--export", "-")[1] == Path("o.yaml").read_text(encoding="utf-8")
    assert answer("objects", "--export", "-", "--database", "b.sqlite")[1] == Path(
        "o.yaml"
    ).read_text(encoding="utf-8")
    code, text = call("objects", "--import", "o.yaml")
    assert code == 2
    assert "there already: large, small; forget them first" in text
    assert call("objects", "--export", "nowhere/o.yaml")[0] == 2
    edited = Path("o.yaml").read_text(encoding="utf-8") + "# edited\n"
    Path("o.yaml").write_text(edited, encoding="utf-8")
    code, text = call("objects", "--export", "o.yaml")
    assert code == 2
    assert "--export o.yaml: is there already; name another file, or write over it with" in text
    assert Path("o.yaml").read_text(encoding="utf-8") == edited
    assert call("objects", "--export", "o.yaml", "--overwrite")[0] == 0
    assert "edited" not in Path("o.yaml").read_text(encoding="utf-8")


def test_frames_that_fail_or_are_empty_are_left_out_and_counted(tmp_path, recordings):
    Path("p.yaml").write_text(
        "pipeline: p\nnodes:\n"
        "  load: {step: load, in: frame}\n"
        "  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}\n"
        "  features: {step: features, in: {image: frame, mask: footprint},"
        " when: load.total > 8}\n"
        "outputs: [features]\n"
    )
    code, text = call("learn", "small", recordings["small"], "--pipeline", "p.yaml")
    assert code == 2
    assert "nothing to learn: no frame gave a reading (12 frames: when load.total > 8" in text
    code, text = call(
        "learn", "both", recordings["small"], recordings["large"], "--pipeline", "p.yaml"
    )
    assert code == 0
    assert "12 readings learned" in text
    assert "left out: 12 frames: when load.total > 8 is false\n" in text


UNGUARDED = """
pipeline: p
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  siemens: {step: decouple, in: frame}
  grams: {step: force, in: siemens}
  features: {step: features, in: {image: grams, mask: footprint}}
  identity: {step: mahalanobis, in: features}
outputs: [features, identity]
"""


@pytest.mark.slow
def test_frames_that_fail_make_the_exit_code_1_and_the_others_count():
    Path("p.yaml").write_text(UNGUARDED)
    scene = "scene={in_turn: [[{shape: disc, weight_g: 900, radius_cm: 4}], []]}"
    source = ("--source", "simulate", "--with", scene, "--frames", 8, "--pipeline", "p.yaml")
    code, text = call("learn", "disc", *source)
    assert code == 1
    assert "disc (disc): 4 readings learned, 4 in all" in text
    assert "left out: 4 frames: the footprint is empty" in text
    code, text = call("identify", *source)
    assert code == 1
    assert text.count("failed: the footprint is empty") == 4
    assert "(failed): 4" in text


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (("learn", "x"), "name the recordings to learn from, or a --source"),
        (("identify",), "name the recordings to identify, or a --source"),
        (("objects",), "no such object database; 'tactile-graph learn' makes one"),
        (("forget", "x"), "no such object database"),
        (("identify", "--source", "simulate"), "no such object database"),
        (("objects", "x", "--export", "-"), "give one of NAME, --export, --import and --rename"),
        (("objects", "--merge"), "--merge: goes with --rename OLD NEW"),
        (("learn", "x", "--source", "simulate", "--pipeline", "circle-3"),
         "pipeline 'circle-3' gives no measurements, but circle"),
        (("learn", "x", "--source", "simulate", "--pipeline", "feature"),
         "did you mean 'features'"),
        (("learn", "unknown", "--source", "simulate", "--frames", "1"), "must be printable text"),
        (("learn", "x", "--source", "simulate", "--shape", "disk"), "'disk' is not one of"),
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_said_with_exit_code_2(args, message):
    code, text = call(*args)
    assert code == 2
    assert message in " ".join(text.split())


@pytest.mark.slow
def test_names_that_are_not_known_come_with_the_nearest(recordings):
    learned(recordings)
    for command in (("forget", "smal"), ("objects", "smal")):
        code, text = call(*command)
        assert code == 2
        assert "no object named 'smal'; did you mean 'small'?" in text


@pytest.mark.slow
def test_a_pipeline_that_does_not_identify_is_refused(recordings):
    learned(recordings)
    code, text = call("identify", recordings["small"], "--pipeline", "features")
    assert code == 2
    assert "pipeline 'features' has no such node; name one with --only" in text


def test_a_database_may_have_any_name(recordings):
    learned(recordings)
    name = 'my "cups" \N{HOT BEVERAGE}\N{GRINNING FACE}.sqlite'
    Path("tactile-objects.sqlite").rename(name)
    code, text = answer("identify", recordings["large"], "--database", name, "--frames", "1")
    assert code == 0
    assert text.splitlines()[1].split()[1] == "large"


@pytest.mark.slow
def test_learning_says_how_well_the_objects_are_told_apart(recordings):
    assert "named right" not in answer("learn", "small", recordings["small"])[1]
    text = answer("learn", "large", recordings["large"])[1]
    assert "tactile-objects.sqlite: 100.0 % of 24 readings are named right when left out" in text
    last = answer("objects")[1].splitlines()[-1]
    assert last == "100.0 % of 24 readings are named right when left out."
    assert "named right" not in answer("forget", "large")[1]


@pytest.mark.slow
def test_readings_in_another_unit_end_identify_at_once_with_the_remedy(recordings):
    learned(recordings)
    Path("raw.csv").write_text(
        "\n".join(",".join("9" if 4 < x < 9 and 4 < y < 9 else "0" for x in range(16))
                  for y in range(16)) + "\n"
    )  # fmt: skip
    code, text, told = run("identify", "raw.csv")
    assert (code, text) == (2, "")
    told = " ".join(told.split())
    assert (
        "takes gram at port 'features', got a frame of raw; tactile-objects.sqlite: the objects"
        " were learned in gram; learn them from recordings like these" in told
    )


@pytest.mark.slow
def test_volts_are_taken_for_a_pad_nobody_named_only_with_a_word_and_stay_as_they_are_if_told(
    recordings,
):
    for name in ("small", "large"):
        frames = load("features").with_source("recording", path=str(recordings[name])).frames()
        write_npz(Path(f"{name}.npz"), [replace(frame, truth=None) for frame in frames])
    law = "the volts were taken for those of pad 'thesis', by its circuit and law"
    assert law in run("learn", "small", "small.npz")[2]
    assert law in run("identify", "small.npz", "--frames", 1)[2]
    named = ("--set", "siemens.pad=thesis", "--set", "grams.pad=thesis")
    assert law not in run("learn", "small", "small.npz", *named)[2]
    assert law not in run("learn", "small", recordings["small"])[2]  # simulated, on that pad
    bare = ("--database", "bare.sqlite", "--with", "quantity=raw")
    for name in ("small", "large"):
        code, _, told = run("learn", name, f"{name}.npz", *bare)
        assert (code, law in told) == (0, False)
    assert "readings in raw" in answer("objects", *bare[:2])[1]
    assert answer("identify", "large.npz", *bare)[1].splitlines()[-1] == "large: 12"
    told = " ".join(run("identify", "large.npz", *bare[:2])[2].split())
    assert "or take these for bare readings too (--with quantity=raw)" in told


@pytest.mark.slow
def test_another_grid_or_pitch_than_was_learned_on_is_told(recordings):
    learned(recordings)
    assert ", of 16 x 16 elements 1.3 x 1.3 cm apart" in answer("objects")[1]
    for name, columns, pitch_cm in (("fine", 16, 0.5), ("wide", 20, 1.3)):
        values = np.zeros((16, columns))
        values[4:9, 4:9] = 500.0
        frames = [Frame.of(values, pitch_cm, quantity="gram", index=k) for k in range(4)]
        write_npz(Path(f"{name}.npz"), frames)
    told = run("identify", "fine.npz")[2]
    assert "frames are of 16 x 16 elements 0.5 x 0.5 cm apart, but the objects were learned" in told
    code, told = call("learn", "x", "fine.npz")
    assert code == 2
    assert "those of another instrument go into a database of their own" in told
    code, told = call("learn", "x", "fine.npz", "wide.npz", "--database", "b.sqlite")
    assert (code, Path("b.sqlite").exists()) == (2, False)
    assert "learn those of one instrument" in told
    code, told = call("learn", "x", "wide.npz")
    assert code == 0
    assert "these are readings of 16 x 20 elements" in told


@pytest.mark.slow
def test_a_database_of_the_thesis_features_serves_the_default_pipeline(recordings):
    for name in ("small", "large"):
        assert call("learn", name, recordings[name], "--pipeline", "features")[0] == 0
    text = answer("identify", recordings["large"], "--frames", 3)[1]
    assert text.splitlines()[-1] == "right: 3 of 3"
    text = answer("identify", recordings["large"], "--frames", 3, "--pipeline", "identify")[1]
    assert text.splitlines()[-1] == "right: 3 of 3"


@pytest.mark.slow
def test_reliefs_are_learned_of_presses_that_were_kept(recordings):
    learned(recordings)
    code, text = call("learn-reliefs")
    assert code != 0
    assert "small" in text
    assert "fewer than 8 presses are kept" in text
    assert "--keep-presses" in text
    code, text = call("identify", recordings["small"], "--pipeline", "identify-reliefs")
    assert code != 0
    assert "no relief was learned of the present readings; 'tactile-graph learn-reliefs'" in text


@pytest.mark.slow  # reliefs are learned
def test_objects_are_identified_by_their_reliefs(recordings):
    for name in ("small", "large"):
        assert call("learn", name, recordings[name], "--keep-presses", "--frames", 8)[0] == 0
    code, text = call("learn-reliefs")
    assert code == 0, text
    assert "reliefs of 2 objects learned" in text
    code, text = answer("identify", recordings["large"], "--pipeline", "identify-reliefs")
    assert code == 0
    assert text.count("\n") > 12
    assert "right: 1" in text  # 10 to 12 of 12
    frames = load("features").with_source("recording", path=str(recordings["large"])).frames()
    narrow = [Frame.of(f.image.values[:, :15], f.image.pitch_cm, quantity="volt") for f in frames]
    write_npz(Path("narrow.npz"), narrow)
    code, text = call("identify", "narrow.npz", "--pipeline", "identify-reliefs")
    assert code != 0
    assert text.count("16 x 15 cells of 1.3 cm; reliefs in") == 1
    code, text = call("identify", "narrow.npz", recordings["large"], "--pipeline",
                      "identify-reliefs")  # fmt: skip
    assert code == 1
    assert text.count("failed: OtherPadError: image: 16 x 15 cells") == len(narrow)
    assert "right: 1" in text  # the other recording is named all the same


def test_a_line_says_why_what_is_near_enough_is_unknown():
    note = "reaches the pad's edge, and may be disc too"
    it = Identity(UNKNOWN, "", False, 0.9, 2.5, "box", "disc", 1.2, 0.25, note=note)
    assert _Lines("identity").told(it, "").endswith(f"nearest: box, accepted up to 2.5; {note}")
