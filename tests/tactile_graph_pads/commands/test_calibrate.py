"""``calibrate`` goes from recordings of known loads to a file that reads them back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml
from click.testing import CliRunner

from helpers_calibration import GRAMS, counting_pad, frame, many_files, on_four, one_file
from tactile_graph.code_version import code_version
from tactile_graph.errors import DataError, UsageError
from tactile_graph.plugins import registry
from tactile_graph.steps import Report
from tactile_graph.wires import Frame, Image
from tactile_graph_filters.readings.force import Force
from tactile_graph_pads.calibration.calibration import load_calibration
from tactile_graph_pads.commands.calibrate import calibrate
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.recording import recording
from tactile_graph_sources.writers.write_npz import write_npz

PAD = load_pad("plain")


def run(*args: object) -> str:
    result = CliRunner().invoke(calibrate, [str(a) for a in args], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def test_one_recording_of_many_loads_calibrates_by_its_truth(tmp_path: Path) -> None:
    out = tmp_path / "c.yaml"
    said = run(one_file(tmp_path / "one.npz"), "-o", out, "--about", "bench pad")
    made = load_calibration(out)
    assert [p.load_g for p in made.points] == [g / 4 for g in GRAMS]
    assert made.fit.kind == "polynomial"
    assert made.quality.rms_percent < 2.0
    assert f"off by {made.quality.rms_percent:.1f} % (rms)" in said
    assert "R²" in said
    assert f"wrote {out}" in said


def test_the_curve_weighs_what_it_was_not_calibrated_with(tmp_path: Path) -> None:
    run(one_file(tmp_path / "one.npz"), "-o", tmp_path / "c.yaml")
    made = load_calibration(tmp_path / "c.yaml")
    found = made.grams_of(PAD.forward(on_four(PAD, 600.0)))
    assert found.valid.all()
    assert found.load_g.sum() == pytest.approx(600.0, rel=0.03)


@pytest.mark.parametrize("fit", ["isotonic", "sums", "power"])
def test_recordings_with_their_loads_calibrate_conductance(tmp_path: Path, fit: str) -> None:
    given = many_files(tmp_path, quantity="counts", pad=counting_pad())
    out = tmp_path / "c.yaml"
    run(*given, "--pad", "thesis", "--decouple", "--fit", fit, "-o", out)
    made = load_calibration(out)
    assert made.reading == "siemens"
    assert made.units.reading == "S"
    found = made.grams_of(PAD.conductance_s(on_four(PAD, 600.0)))
    assert found.load_g.sum() == pytest.approx(600.0, rel=0.03)


def test_the_file_says_where_it_came_from(tmp_path: Path) -> None:
    given = many_files(tmp_path)
    run(*given, "--fit", "isotonic", "-o", tmp_path / "c.yaml")
    told = load_calibration(tmp_path / "c.yaml").provenance
    assert told.made_by == f"tactile-graph {code_version()}"
    assert told.group == (2, 2)
    assert [o.file for o in told.recordings] == [f"load-{g:g}.npz" for g in GRAMS]
    assert {o.frames for o in told.recordings} == {3}
    assert all(len(o.sha256) == 64 for o in told.recordings)


def test_a_whole_pad_is_a_group_of_its_own_shape(tmp_path: Path) -> None:
    given = []
    for g in (10.0, 20.0, 40.0):
        path = tmp_path / f"all-{g:g}.npz"
        write_npz(path, [Frame(PAD.image(PAD.forward(np.full((16, 16), g))))])
        given.append(f"{path}={256 * g}")
    run(*given, "--group", "all", "--fit", "isotonic", "-o", tmp_path / "c.yaml")
    made = load_calibration(tmp_path / "c.yaml")
    assert made.provenance.group == (16, 16)
    assert [p.load_g for p in made.points] == [10.0, 20.0, 40.0]


def test_an_empty_recording_is_taken_off(tmp_path: Path) -> None:
    pad = counting_pad()
    given = many_files(tmp_path, quantity="counts", pad=pad)
    empty = tmp_path / "empty.npz"
    write_npz(empty, [frame(pad, 0.0, quantity="counts")])
    run(*given, "--empty", empty, "--fit", "isotonic", "-o", tmp_path / "c.yaml")
    made = load_calibration(tmp_path / "c.yaml")
    assert made.reading == "counts"
    volts = PAD.forward(on_four(PAD, GRAMS[0]))[3, 4]
    assert made.from_reading == pytest.approx(volts / pad.converter.step_v, abs=0.5)


def raised(folder: Path, rest: float = 0.3) -> tuple[list[str], Path]:
    """Recordings of loads on a pad that reads something when empty, and one of it empty."""
    empty = np.random.default_rng(0).normal(rest, 0.03, (16, 16))
    given = []
    for grams in GRAMS:
        one = frame(PAD, grams)
        write_npz(
            folder / f"{grams:g}.npz", [Frame(one.image.with_values(one.image.values + empty))]
        )
        given.append(f"{folder / f'{grams:g}.npz'}={grams}")
    write_npz(folder / "empty.npz", [Frame(PAD.image(empty, "volt"))])
    return given, folder / "empty.npz"


@pytest.mark.parametrize("fit", ["polynomial", "isotonic"])
def test_the_line_to_paste_gives_the_grams_of_a_pad_whose_empty_readings_were_taken_off(
    tmp_path: Path, fit: str
) -> None:
    given, empty = raised(tmp_path)
    out = tmp_path / "c.yaml"
    run(*given, "--empty", empty, "--fit", fit, "-o", out)
    first, line = out.read_text().splitlines()[:2]
    assert "above the empty pad's" in first
    node = yaml.safe_load(line.split("In a pipeline:")[1])
    assert node == {"force": {"step": "force", "in": "frame", "with": {"calibration": str(out)}}}
    step = Force(calibration=Path(node["force"]["with"]["calibration"]))
    for grams in GRAMS:
        image = next(iter(recording(path=tmp_path / f"{grams:g}.npz", report=Report()))).image
        assert step(image).filled().sum() == pytest.approx(grams, rel=0.1), grams
    told = load_calibration(out).provenance
    assert told.empty is not None
    assert (told.empty.file, told.empty.frames) == ("empty.npz", 1)


@pytest.mark.slow
def test_the_offset_that_a_file_keeps_is_in_what_the_curve_reads(tmp_path: Path) -> None:
    pad = counting_pad()
    given = many_files(tmp_path, quantity="counts", pad=pad)
    empty = tmp_path / "empty.npz"
    write_npz(empty, [frame(pad, 0.0, quantity="counts")])
    run(*given, "--empty", empty, "--pad", "thesis", "--decouple", "--fit", "power",
        "-o", tmp_path / "c.yaml")  # fmt: skip
    offset = np.array(load_calibration(tmp_path / "c.yaml").offset)
    assert offset.shape == (16, 16)
    np.testing.assert_allclose(offset, PAD.conductance_s(np.zeros((16, 16))), atol=1e-7)


def test_a_pad_of_too_many_elements_to_keep_is_refused_before_the_work(tmp_path: Path) -> None:
    empty = tmp_path / "e.npz"
    write_npz(empty, [Frame(Image(np.zeros((130, 130)), quantity="volt"))])
    refused(UsageError, "has 16900 elements, and a calibration file keeps .* of 16384 at most",
            f"{tmp_path / 'gone.npz'}=3", "--empty", empty, "-o", tmp_path / "c.yaml")  # fmt: skip


@pytest.mark.slow
def test_it_draws_what_it_found(tmp_path: Path) -> None:
    run(one_file(tmp_path / "one.npz"), "--plot", tmp_path / "c.png")
    assert (tmp_path / "c.png").read_bytes().startswith(b"\x89PNG")


def test_a_list_calibrates(tmp_path: Path) -> None:
    many_files(tmp_path)
    rows = [f"load-{g:g}.npz,{g}" for g in GRAMS]
    (tmp_path / "l.csv").write_text("\n".join(["recording,load_g", *rows]))
    assert "fit of 8 loads" in run("--loads", tmp_path / "l.csv")


def test_recordings_that_do_not_say_their_quantity_are_counts_of_the_pad_named(
    tmp_path: Path,
) -> None:
    pad = counting_pad()
    given = []
    for grams in GRAMS:
        counts = frame(pad, grams, quantity="counts").image.values
        np.save(tmp_path / f"{grams:g}.npy", counts[None])
        given.append(f"{tmp_path / f'{grams:g}.npy'}={grams}")
    said = run(*given, "--pad", "thesis", "-o", tmp_path / "c.yaml")
    assert "that do not say their quantity are taken for counts of pad thesis" in said
    assert load_calibration(tmp_path / "c.yaml").reading == "volt"


# -- what is refused -------------------------------------------------------------------------


def refused(error: type[Exception], match: str, *args: object) -> None:
    with pytest.raises(error, match=match):
        run(*args)


def test_nothing_given_is_refused() -> None:
    refused(UsageError, "nothing to calibrate from: give recordings as FILE=GRAMS, or --loads")


def test_too_few_loads_are_refused(tmp_path: Path) -> None:
    refused(DataError, "too few loads: a polynomial of order 5 needs 6 different ones, got 3",
            *many_files(tmp_path, GRAMS[:3]))  # fmt: skip


def test_only_empty_frames_are_too_few_loads(tmp_path: Path) -> None:
    write_npz(tmp_path / "e.npz", [frame(PAD, 0.0, truth=True)])
    refused(DataError, "too few loads: every frame is of the empty pad", tmp_path / "e.npz")


@pytest.mark.slow
def test_swapped_loads_are_refused(tmp_path: Path) -> None:
    given = many_files(tmp_path)
    a, b = (g.rpartition("=") for g in (given[1], given[4]))
    given[1], given[4] = f"{a[0]}={b[2]}", f"{b[0]}={a[2]}"
    refused(DataError, "loads in disorder: .* were loads mixed up", *given)


@pytest.mark.slow
def test_saturated_loads_are_refused(tmp_path: Path) -> None:
    given = many_files(tmp_path, (*GRAMS, 20_000.0, 60_000.0))
    refused(DataError, "saturated: from 5000 to 15000 g an element", *given)
    refused(DataError, "saturated: under 1000 g an element reads", *given, "--full-scale", 1.8)


@pytest.mark.slow
def test_a_curve_that_would_fall_is_refused(tmp_path: Path) -> None:
    grams = (60.0, 75.0, 90.0, 110.0, 3000.0, 3300.0, 9000.0)
    refused(
        DataError, "not monotone: the polynomial of order 5 falls", *many_files(tmp_path, grams)
    )
    assert "fit of 7 loads" in run(*many_files(tmp_path, grams), "--fit", "isotonic")


def test_different_quantities_do_not_mix(tmp_path: Path) -> None:
    volts = many_files(tmp_path, GRAMS[:4])
    (tmp_path / "counts").mkdir()
    counts = tmp_path / "counts" / "a.npz"
    image = PAD.image(on_four(PAD, 500.0), "counts")
    write_npz(counts, [Frame(image)])
    refused(DataError, r"a.npz: holds counts, but .*load-60.npz volt: convert one of them",
            *volts, f"{counts}=500")  # fmt: skip
    refused(DataError, r"load-60.npz: holds volt, but .*a.npz counts: convert one of them",
            *volts, "--empty", counts)  # fmt: skip


def small(path: Path, shape: tuple[int, int], pitch_cm: float) -> str:
    values = np.zeros(shape)
    values[:2, :2] = 1.0
    write_npz(path, [Frame(Image(values, (pitch_cm, pitch_cm), quantity="volt"))])
    return f"{path}=500"


def test_recordings_of_different_pads_do_not_mix(tmp_path: Path) -> None:
    a, fewer, wider = (
        small(tmp_path / name, shape, pitch_cm)
        for name, shape, pitch_cm in (
            ("a.npz", (8, 8), 1.0), ("fewer.npz", (8, 6), 1.0), ("wider.npz", (8, 8), 1.3)
        )
    )  # fmt: skip
    refused(DataError, r"fewer.npz: has 8 x 6 elements, but .*a.npz has 8 x 8", a, fewer)
    refused(DataError, r"wider.npz: has a pitch of 1.3 x 1.3 cm, but .*a.npz of 1 x", a, wider)
    empty = tmp_path / "wider.npz"
    refused(DataError, r"a.npz: has a pitch of 1 x 1 cm, but .*wider", a, "--empty", empty)


def test_an_assumed_pitch_is_not_held_against_a_known_one(tmp_path: Path) -> None:
    given = many_files(tmp_path, GRAMS[:3])
    np.save(tmp_path / "e.npy", np.zeros((3, 16, 16)))
    refused(DataError, "load-60.npz: holds volt, but .*e.npy raw", *given, "--empty",
            tmp_path / "e.npy")  # fmt: skip
    bare = []
    for grams in GRAMS[:3]:
        np.save(tmp_path / f"{grams:g}.npy", np.load(tmp_path / f"load-{grams:g}.npz")["values"])
        bare.append(f"{tmp_path / f'{grams:g}.npy'}={grams}")
    write_npz(tmp_path / "e.npz", [Frame(PAD.image(np.zeros((16, 16)), "raw"))])
    said = run(*bare, "--empty", tmp_path / "e.npz", "--fit", "isotonic")
    assert "fit of 3 loads" in said


def test_settings_of_the_reader_hold_for_all_recordings(tmp_path: Path) -> None:
    given = []
    for path in [tmp_path / "e.npy", *(tmp_path / f"{g}.npy" for g in (30, 60, 120, 240, 480))]:
        values = np.zeros((3, 4, 6))
        values[:, 1:3, 2:4] = 0.0 if path.stem == "e" else np.sqrt(float(path.stem))
        np.save(path, values.reshape(3, 24))
        given += [f"{path}={path.stem}"] if path.stem != "e" else ["--empty", path]
    told = ("--with", "rows=4", "--with", "columns=6", "--with", "quantity=volt")
    assert "V" in run(*given, *told, "--fit", "isotonic")
    # a text need not be YAML: it is the reader that has no use for it
    refused(DataError, "time_format: its times", *given, "--with", "time_format=%H:%M")
    refused(UsageError, "rows", *given, "--with", "rows=0")


def test_grams_are_no_readings(tmp_path: Path) -> None:
    write_npz(tmp_path / "g.npz", [Frame(PAD.image(on_four(PAD, 500.0), "gram"))])
    refused(DataError, "only readings can be calibrated, these are gram already",
            f"{tmp_path / 'g.npz'}=500")  # fmt: skip


def test_decoupling_needs_a_circuit(tmp_path: Path) -> None:
    refused(UsageError, "--decouple needs --pad: whose circuit is it", "a.npz=1", "--decouple")


def test_a_place_to_write_is_checked_before_the_work(tmp_path: Path) -> None:
    refused(UsageError, "there is no folder", "a.npz=1", "-o", tmp_path / "none" / "c.yaml")
    refused(UsageError, "its name must end in", "a.npz=1", "--plot", tmp_path / "c.txt")


def test_a_group_has_rows_and_columns() -> None:
    result = CliRunner().invoke(calibrate, ["a.npz=1", "--group", "four"])
    assert result.exit_code == 2
    assert "must be ROWSxCOLUMNS or 'all', got 'four'" in result.output


def test_without_a_source_of_recordings_it_says_which_plugin_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = one_file(tmp_path / "one.npz")
    monkeypatch.setenv(registry.ENVIRONMENT, "-sources")
    monkeypatch.setattr(registry, "_override", None)
    registry.installed.cache_clear()
    try:
        refused(UsageError, "recordings need the step 'recording': .*blocked", given)
    finally:
        registry.installed.cache_clear()
