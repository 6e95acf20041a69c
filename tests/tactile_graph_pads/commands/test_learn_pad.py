"""``learn-pad`` goes from recordings to a pad file that steps use, and refuses what it cannot."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from helpers_html import read_html
from helpers_learning import MadeUpPad, untold
from helpers_panel import panel_frames
from helpers_recordings import SHARED, shared
from tactile_graph import Frame, loads
from tactile_graph.cli import cli
from tactile_graph.code_version import code_version
from tactile_graph.errors import DataError, UsageError
from tactile_graph_pads.commands.learn_pad import learn_pad
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.writers.write_npz import write_npz


def run(*args: object) -> str:
    result = CliRunner().invoke(learn_pad, [str(a) for a in args], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def test_an_empty_recording_alone_makes_a_pad_with_noise_and_offset(tmp_path: Path) -> None:
    pad, out = MadeUpPad(), tmp_path / "pad.yaml"
    empty, _ = pad.recorded(tmp_path, n_objects=1)
    said = run("--empty", empty, "-o", out)
    learned = load_pad(out).learned
    assert learned is not None
    assert learned.noise == pytest.approx(2.0, rel=0.1)
    assert learned.table.offset == pytest.approx(pad.offset, abs=1.5)
    assert learned.pitch_cm == (0.5, 0.8)
    assert learned.table.good.all()
    assert "No objects were recorded" in said
    assert f"# Made by tactile-graph {code_version()} on 2" in out.read_text("utf-8")


@pytest.mark.slow
def test_empty_frames_among_those_of_objects_are_not_said_to_bear_any(tmp_path: Path) -> None:
    empty, objects = MadeUpPad().recorded(tmp_path, n_objects=40)
    said = " ".join(run(empty, objects).split())
    assert re.search(r"from \d+ frames in all, each element where untouched", said)
    assert "frames of the empty pad" in " ".join(run("--empty", empty).split())


def test_a_table_that_was_edited_stays_unless_it_is_to_be_overwritten(tmp_path: Path) -> None:
    empty, _ = MadeUpPad().recorded(tmp_path, n_objects=1)
    table = tmp_path / "pad.elements.csv"
    table.write_text("edited")
    told = f"-o {table}: is there already; name another file, or write over it with --overwrite"
    assert told in refused("--empty", empty, "-o", tmp_path / "pad.yaml")
    assert table.read_text() == "edited"
    run("--empty", empty, "-o", tmp_path / "pad.yaml", "--overwrite")
    assert table.read_text() != "edited"


@pytest.mark.slow
def test_with_objects_it_tells_what_is_dead_stuck_and_uneven(tmp_path: Path) -> None:
    pad = MadeUpPad(
        gain_sigma=0.3, dead=((4, 5), (9, 11)), dead_row=6, stuck=((3, 16),), turn_on=40.0
    )
    empty, objects = pad.recorded(tmp_path, n_objects=400)
    out, page = tmp_path / "pad.yaml", tmp_path / "pad.html"
    said = run("--empty", empty, objects, "-o", out, "--plots", page)
    found = load_pad(out)
    assert found.learned is not None
    state = found.learned.table.state
    assert found.defects.dead_rows == (6,)
    assert set(found.defects.dead_elements) == {(4, 5), (9, 11)}
    assert {tuple(at) for at in np.argwhere(state == "stuck")} == {(3, 16)}
    assert (state == "dead").sum() == pad.columns + 2
    good = found.learned.table.good
    gain = np.log(found.learned.table.gain)[good]
    assert np.corrcoef(gain, np.log(pad.gain)[good])[0, 1] > 0.9
    assert found.learned.turn_on is not None
    assert found.learned.turn_on.reading == pytest.approx(40.0, rel=0.15)
    assert f"{pad.columns + 2} dead, or never loaded (row 6 among them)" in said
    assert f"{pad.columns + 2} elements read nothing between others that objects press" in said
    _check_page(page)


def _check_page(path: Path) -> None:
    root = read_html(path.read_text("utf-8").removeprefix("<!doctype html>"))
    titles = [h2.text for h2 in root.all("h2")]
    for title in ("The empty pad", "Gains", "Readings under objects", "Law", "Places before"):
        assert any(t.startswith(title) for t in titles), title
    pictures = root.all("img")
    assert len(pictures) == len(root.all("figcaption")) == 5
    assert all(p.attributes["src"].startswith("data:image/png;base64,") for p in pictures)
    assert all(p.attributes["alt"] for p in pictures)
    assert "cross-validated by recording" in root.text


@pytest.mark.slow
def test_what_it_wrote_puts_objects_it_has_not_seen_nearer_with_a_true_deviation(
    tmp_path: Path,
) -> None:
    pad, out = MadeUpPad(lean_cells=2.0, stretch=1.0), tmp_path / "pad.yaml"
    run("--empty", *pad.recorded(tmp_path), "-o", out)
    before, after, stated = placed(out, list(pad.objects(80)))
    assert np.median(np.hypot(*after.T)) < 0.5 * np.median(np.hypot(*before.T))
    assert 1 / 1.5 < np.sqrt(np.mean((after / stated) ** 2)) < 1.5


def placed(pad: Path, frames: list[Frame]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return errors before and after, and stated deviations, in cells, of one contact a frame."""
    run = loads(f"""
pipeline: placed
source: {{step: sample, with: {{name: discs}}}}
nodes:
  readings: {{step: correct_readings, in: frame, with: {{pad: {pad}}}}}
  touched: {{step: threshold_learned, in: readings, with: {{pad: {pad}}}}}
  contacts: {{step: contacts, in: [readings, touched]}}
  placed: {{step: correct_place, in: [readings, contacts.contacts], with: {{pad: {pad}}}}}
outputs: [contacts, placed]
""").runner()
    rows = []
    for frame in frames:
        result, pitch = run(frame), np.array(frame.image.pitch_cm)
        if result["contacts"].count == len(frame.truth or ()):
            for plain, at in zip(
                result["contacts"].contacts, result["placed"].contacts, strict=True
            ):
                places = np.array([(t.shape.x_cm, t.shape.y_cm) for t in frame.truth or ()])
                off = (np.array([plain.x_cm, plain.y_cm]) - places) / pitch
                k = int(np.hypot(*off.T).argmin())
                now = (np.array([at.x_cm, at.y_cm]) - places[k]) / pitch
                rows.append((off[k], now, np.array([at.x_std_cm, at.y_std_cm]) / pitch))
    before, after, stated = (np.array(part) for part in zip(*rows, strict=True))
    assert len(before) > 0.9 * len(frames)
    return before, after, stated


@pytest.mark.slow
def test_a_panel_without_an_empty_recording_is_learned_where_it_is_untouched(
    tmp_path: Path,
) -> None:
    frames = [Frame(f.image, k, truth=f.truth) for k, f in enumerate(panel_frames(tmp_path, 60))]
    for part in range(6):
        write_npz(tmp_path / f"part{part}.npz", frames[10 * part : 10 * part + 8])
    said = run(*sorted(tmp_path.glob("part*.npz")), "-o", tmp_path / "pad.yaml")
    assert "No recording of the empty pad" in said
    before, after, _ = placed(tmp_path / "pad.yaml", frames[8::10] + frames[9::10])
    assert np.median(np.hypot(*after.T)) < 0.7 * np.median(np.hypot(*before.T))


@pytest.mark.slow
def test_on_people_never_seen_the_centre_comes_within_a_quarter_of_a_cell(tmp_path: Path) -> None:
    """What is told of others is learned from one folder and nothing else."""
    shared("capcontact")
    shared("capcontact_others")
    from helpers_recordings import frames_of

    run(*sorted((SHARED / "capcontact").glob("*.npz")), "-o", tmp_path / "pad.yaml")
    paths = sorted((SHARED / "capcontact_others").glob("*.npz"))
    before, after, stated = placed(tmp_path / "pad.yaml", [frames_of(p)[0][0] for p in paths])
    assert np.median(np.hypot(*before.T)) > 0.3
    assert np.median(np.hypot(*after.T)) <= 0.25
    assert 1 / 1.5 < np.sqrt(np.mean((after / stated) ** 2)) < 1.5


def test_weights_on_the_command_line_make_a_law(tmp_path: Path) -> None:
    pad = MadeUpPad()
    empty, _ = pad.recorded(tmp_path, n_objects=1)
    given = []
    for k, height in enumerate(np.linspace(80.0, 400.0, 12)):
        path = tmp_path / f"weight{k}.npz"
        write_npz(path, untold(iter([pad.frame(((4.0 + k, 6.0, height),))])))
        given.append(f"{path}={10.0 * height:g}")
    write_npz(tmp_path / "light.npz", untold(iter([pad.frame(((9.0, 6.0, 3.0),))])))
    out = tmp_path / "pad.yaml"
    said = run("--empty", empty, *given, f"{tmp_path / 'light.npz'}=30", "-o", out)
    learned = load_pad(out).learned
    assert learned is not None
    readings, grams = np.array(learned.curve).T
    assert (np.diff(grams) >= 0.0).all()
    # the made-up pad reads in proportion: 16.9 cells of height h weigh 10 h
    assert np.interp(200.0, readings, grams) == pytest.approx(10 / 18.5 * 200, rel=0.15)
    assert "held-out weights off by" in said
    assert "In 1 of 13 frames of known weight no reading is more than noise" in said
    assert "No places are known" in said


@pytest.mark.slow
def test_places_can_be_told_by_a_list(tmp_path: Path) -> None:
    pad = MadeUpPad(lean_cells=2.0)
    empty, _ = pad.recorded(tmp_path, n_objects=1)
    frames = list(pad.objects(40))
    write_npz(tmp_path / "o.npz", untold(iter(frames)))
    lines = [
        f"o.npz,{k},{t.shape.x_cm:.4f},{t.shape.y_cm:.4f}"
        for k, f in enumerate(frames)
        for t in f.truth or ()
    ]
    listed = tmp_path / "places.csv"
    listed.write_text("\n".join(["recording,frame,x_cm,y_cm", *lines]) + "\n")
    said = run("-e", empty, tmp_path / "o.npz", "--places", listed, "-o", tmp_path / "p.yaml")
    assert re.search(r"place +\d+ places in 12 recordings or stretches", said)


@pytest.mark.slow
def test_places_on_a_pad_whose_pitch_is_assumed_teach_nothing_until_it_is_told(
    tmp_path: Path,
) -> None:
    pad = MadeUpPad(pitch_cm=(0.5, 0.5))
    frames = list(pad.objects(60))
    np.save(tmp_path / "e.npy", [f.image.values for f in pad.empty()])
    np.save(tmp_path / "o.npy", [f.image.values for f in frames])
    lines = [
        f"o.npy,{k},{t.shape.x_cm:.4f},{t.shape.y_cm:.4f}"
        for k, f in enumerate(frames)
        for t in f.truth or ()
    ]
    listed, out = tmp_path / "places.csv", tmp_path / "p.yaml"
    listed.write_text("\n".join(["recording,frame,x_cm,y_cm", *lines]) + "\n")
    given = ("-e", tmp_path / "e.npy", tmp_path / "o.npy", "--places", listed, "-o", out)
    said = run(*given)
    assert "The pitch of 1 cm is assumed: no recording says it" in said
    assert re.search(r"No correction of place: \d+ of 60 known places met a contact", said)
    assert "1 cm the pitch, which is assumed?" in said
    assert not (tmp_path / "p.place.npz").exists()
    said = run(*given, "--with", "pitch_cm=0.5", "--overwrite")
    assert "assumed" not in said
    assert re.search(r"place +60 places in 12 recordings or stretches", said)
    assert load_pad(out).learned.pitch_cm == (0.5, 0.5)


# -- what a stranger meets -------------------------------------------------------------------


def refused(*args: object) -> str:
    result = CliRunner().invoke(cli, ["learn-pad", *map(str, args)])
    assert result.exit_code != 0
    assert "Traceback" not in result.output
    error = result.exception
    assert isinstance(error, SystemExit | DataError | UsageError)
    return result.output + str(error)


def test_what_is_no_empty_recording_is_refused_with_a_place(tmp_path: Path) -> None:
    pad = MadeUpPad()
    resting = [pad.frame(((7.0, 5.0, 300.0),), k) for k in range(20)]
    write_npz(tmp_path / "resting.npz", resting)
    said = refused("--empty", tmp_path / "resting.npz")
    assert re.search(r"not empty: \d+ neighbouring elements around row 5, column 7", said)
    comes = [*pad.empty(20), *(pad.frame(((7.0, 5.0, 300.0),), k) for k in range(10))]
    write_npz(tmp_path / "comes.npz", comes)
    said = refused("--empty", tmp_path / "comes.npz")
    assert "not empty: in 10 of 30 frames, first in frame 20" in said


def test_too_few_frames_say_how_many_are_needed(tmp_path: Path) -> None:
    empty, objects = MadeUpPad().recorded(tmp_path, n_empty=3, n_objects=6)
    assert "too few frames of the empty pad: got 3, at least 5" in refused("-e", empty)
    said = refused(objects)
    assert "too few frames to tell the empty pad without a recording of it: got 6" in said


@pytest.mark.slow
def test_recordings_of_different_pads_are_refused_by_name(tmp_path: Path) -> None:
    empty, _ = MadeUpPad().recorded(tmp_path)
    (tmp_path / "b").mkdir()
    _, other = MadeUpPad(rows=12).recorded(tmp_path / "b")
    said = refused("-e", empty, other)
    assert re.search(r"has 12 x 20 elements, but .*empty.npz has 14 x 20", said)
    _, other = MadeUpPad(pitch_cm=(1.0, 1.0)).recorded(tmp_path / "b")
    assert "pitch of 1 x 1 cm" in refused("-e", empty, other)
    said = refused("-e", empty, "--pad", "thesis")
    assert "has 16 x 16 elements, the recordings have 14 x 20" in said


def test_objects_that_read_nothing_are_refused(tmp_path: Path) -> None:
    pad = MadeUpPad()
    empty, _ = pad.recorded(tmp_path)
    write_npz(tmp_path / "nothing.npz", pad.empty(10))
    assert "nothing lies on the pad in any frame" in refused("-e", empty, tmp_path / "nothing.npz")


def test_a_drift_is_told_and_is_no_noise(tmp_path: Path) -> None:
    pad = MadeUpPad()
    frames = [
        Frame.of(f.image.values + 0.5 * k, pad.pitch_cm, quantity="raw", index=k)
        for k, f in enumerate(pad.empty(60))
    ]
    write_npz(tmp_path / "drifts.npz", frames)
    said = " ".join(run("-e", tmp_path / "drifts.npz", "-o", tmp_path / "p.yaml").split())
    assert re.search(r"drifts by (29|30)[.\d]* over the recording, 1[45] times the noise", said)
    learned = load_pad(tmp_path / "p.yaml").learned
    assert learned is not None
    assert learned.noise == pytest.approx(2.0, rel=0.1)


def test_mistakes_of_the_command_line_are_told_before_the_work(tmp_path: Path) -> None:
    empty, objects = MadeUpPad().recorded(tmp_path, n_objects=12)
    assert "nothing to learn from" in refused()
    assert "must end in .yaml" in refused("-e", empty, "-o", tmp_path / "pad.txt")
    assert "must end in .yaml" in refused("-e", empty, "-o", os.devnull)
    assert "is given as empty and as a recording of objects" in refused("-e", empty, empty)
    assert "unknown setting 'pich_cm'; did you" in refused("-e", empty, "--with", "pich_cm=1")
    assert "are named on the command line" in refused("-e", empty, "--with", "path=a.npy")
    assert "unknown quantity '@x'" in refused("-e", empty, "--with", "quantity=@x")
    (tmp_path / "p.csv").write_text("recording,x_cm,y_cm\nobject.npz,1,2\n")
    said = refused("-e", empty, objects, "--places", tmp_path / "p.csv")
    assert "did you mean 'objects.npz'" in said
