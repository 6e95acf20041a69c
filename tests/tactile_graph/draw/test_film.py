"""A film of a run: true pace, fixed colours, what was found drawn over, whole or not at all."""

from __future__ import annotations

import resource
import signal
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image as Pillow

from helpers_draw import circle_demo, discs, empty_frame
from tactile_graph import Frame
from tactile_graph.draw import film as films
from tactile_graph.draw import film_files
from tactile_graph.draw.film import Film
from tactile_graph.errors import UsageError

FOUND_RGB = 216, 27, 96


def filmed(frames: Iterable[Frame], path: Path) -> Film:
    pipeline = circle_demo()
    film = Film(pipeline.name, tuple(pipeline.outputs))
    for result in pipeline.stream(frames):
        film.add(result)
    film.write(path)
    return film


def timed(times_s: Iterable[float | None]) -> list[Frame]:
    (disc,) = discs(1)
    return [replace(disc, index=k, time_s=t) for k, t in enumerate(times_s)]


def pictures(path: Path) -> tuple[list[np.ndarray], list[float]]:
    """Return the pictures of a GIF and for how long each is shown, in seconds."""
    shown, seconds = [], []
    with Pillow.open(path) as gif:
        assert gif.info["loop"] == 0
        for k in range(gif.n_frames):
            gif.seek(k)
            shown.append(np.asarray(gif.convert("RGB")).astype(int))
            seconds.append(gif.info["duration"] / 1000.0)
    return shown, seconds


def near(picture: np.ndarray, rgb: tuple[int, int, int]) -> int:
    """Return how many pixels below the legend have about that colour."""
    return int((np.abs(picture[80:] - rgb).max(axis=2) < 40).sum())


@pytest.mark.slow
def test_a_film_runs_at_the_pace_of_the_frames_and_does_not_drift(tmp_path: Path) -> None:
    times = [k / 15.0 for k in range(6)]  # rounded one by one they would end 0.017 s early
    filmed(timed(times), tmp_path / "a.gif")
    _, seconds = pictures(tmp_path / "a.gif")
    assert len(seconds) == 6
    starts = np.concatenate([[0.0], np.cumsum(seconds)[:-1]])
    assert np.abs(starts - times).max() < 0.011


@pytest.mark.slow
def test_frames_that_come_faster_than_pictures_can_are_left_out_at_equal_pace(
    tmp_path: Path,
) -> None:
    film = filmed(timed(k / 100.0 for k in range(21)), tmp_path / "a.gif")
    assert film.n == 6
    _, seconds = pictures(tmp_path / "a.gif")
    assert sum(seconds[:-1]) == pytest.approx(0.2)


@pytest.mark.slow
def test_pauses_are_cut_and_untimed_frames_shown_alike_and_both_said(tmp_path: Path) -> None:
    film = filmed(timed([0.0, 0.5, 60.0]), tmp_path / "a.gif")
    assert (film.shortened, film.timed) == (True, True)
    assert pictures(tmp_path / "a.gif")[1] == pytest.approx([0.5, 1.0, 1.0])
    film = filmed(timed([None, None]), tmp_path / "b.gif")
    assert (film.shortened, film.timed) == (False, False)
    assert pictures(tmp_path / "b.gif")[1] == pytest.approx([0.1, 0.1])


@pytest.mark.slow
def test_what_was_found_and_what_is_true_are_drawn_over_every_picture(tmp_path: Path) -> None:
    filmed([*discs(2), empty_frame(7)], tmp_path / "a.gif")
    (first, second, empty), _ = pictures(tmp_path / "a.gif")
    for picture in (first, second):
        assert near(picture, FOUND_RGB) > 100
    assert near(empty, FOUND_RGB) == 0
    untold = [replace(f, truth=None) for f in discs(2)]
    filmed([*untold, empty_frame(7)], tmp_path / "b.gif")
    (bare, *_), _ = pictures(tmp_path / "b.gif")
    told = np.abs(first - bare)[80:].max(axis=2) > 40
    assert told.sum() > 200, "the dashed line and its halo"


@pytest.mark.slow
def test_colours_mean_the_same_in_all_pictures(tmp_path: Path) -> None:
    faint, strong = (Frame.of(np.full((6, 6), level), quantity="volt") for level in (1.0, 4.0))
    filmed([faint, strong], tmp_path / "a.gif")
    (a, b), _ = pictures(tmp_path / "a.gif")
    middle = a.shape[0] // 2, a.shape[1] // 3
    assert np.abs(a[middle] - (59, 82, 139)).max() < 20, "a quarter of viridis"
    assert np.abs(b[middle] - (253, 231, 37)).max() < 20, "the end of viridis"


@pytest.mark.slow
def test_a_long_run_fills_a_film_and_no_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(films, "MOST_PICTURES", 3)
    film = filmed(timed([0.0, 0.1, 0.2, 0.3]), tmp_path / "a.gif")
    assert (film.n, film.full) == (3, True)
    assert len(pictures(tmp_path / "a.gif")[1]) == 3


def test_a_film_that_breaks_off_leaves_the_old_one_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    old = tmp_path / "a.gif"
    old.write_bytes(b"old")

    def full(self: object, picture: object, seconds: float) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(films.Gif, "add", full)
    with pytest.raises(UsageError, match=r"a\.gif: cannot be written: No space left on device"):
        filmed(discs(1), old)
    assert [p.name for p in tmp_path.iterdir()] == ["a.gif"]
    assert old.read_bytes() == b"old"


def test_a_film_is_written_into_an_old_one_that_cannot_be_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*paths: object) -> None:
        raise PermissionError(13, "Access is denied")

    (tmp_path / "a.gif").write_bytes(b"old")
    monkeypatch.setattr("os.replace", refused)
    filmed(discs(1), tmp_path / "a.gif")
    assert [p.name for p in tmp_path.iterdir()] == ["a.gif"]
    assert len(pictures(tmp_path / "a.gif")[1]) == 1


@pytest.mark.slow
def test_mp4_repeats_pictures_as_long_as_they_last(tmp_path: Path) -> None:
    library = pytest.importorskip("imageio_ffmpeg", reason="the 'film' extra is not installed")
    filmed(timed([0.0, 0.2, 0.6]), tmp_path / "a.mp4")
    n, seconds = library.count_frames_and_secs(str(tmp_path / "a.mp4"))
    assert (n, seconds) == (25, pytest.approx(1.0, abs=0.05))
    assert [p.name for p in tmp_path.iterdir()] == ["a.mp4"]


@pytest.mark.slow
def test_an_mp4_for_which_there_is_no_room_leaves_the_old_one_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No file of ffmpeg's can be larger than 4096 bytes, as if the disc were full then."""
    pytest.importorskip("imageio_ffmpeg", reason="the 'film' extra is not installed")
    old = tmp_path / "a.mp4"
    old.write_bytes(b"old")
    real = films.Mp4.__init__

    def begin(self: films.Mp4, *args: object) -> None:
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
        try:
            real(self, *args)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)

    monkeypatch.setattr(films.Mp4, "__init__", begin)
    with pytest.raises(UsageError, match=r"a\.mp4: cannot be written: File too large"):
        filmed(timed([0.0, 1.0]), old)
    assert [p.name for p in tmp_path.iterdir()] == ["a.mp4"]
    assert old.read_bytes() == b"old"


ENDS = {
    "before it has read a picture": (
        "echo 'av_interleaved_write_frame(): No space left on device' >&2; exit 1",
        "No space left on device",
    ),
    "when all is read": (
        "cat > /dev/null; echo '[out#0] No space left on device' >&2; exit 228",
        "No space left on device",
    ),
    "for a reason of its own": ("cat > /dev/null; echo odd >&2; exit 3", "ffmpeg: odd"),
    "without a word": ("cat > /dev/null; exit 3", "ffmpeg: it ended with code 3"),
}


@pytest.mark.parametrize("end", ENDS)
def test_what_ffmpeg_fails_with_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, end: str
) -> None:
    script, told = ENDS[end]
    fake = tmp_path / "ffmpeg"
    fake.write_text(f"#!/bin/sh\n{script}\n")
    fake.chmod(0o700)
    monkeypatch.setattr(
        film_files, "ffmpeg", lambda: SimpleNamespace(get_ffmpeg_exe=lambda: str(fake))
    )

    def film() -> None:
        with film_files.Mp4(tmp_path / "a.mp4", (400, 400)) as mp4:
            mp4.add(np.zeros((400, 400, 3), np.uint8), 0.04)

    with pytest.raises(OSError) as got:
        film()
    assert got.value.strerror == told


def stopped(path: Path, times: int) -> Film:
    """Return a film in whose second picture signals come, one after the other."""
    film = Film("discs", ())
    for result in circle_demo().stream(timed([0.0, 0.1, 0.2, 0.3])):
        film.add(result)

    def interrupt(done: int, n: int) -> None:
        assert n == 4
        for _ in range(times if done == 2 else 0):
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        film.write(path, interrupt)
    return film


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_ctrl_c_ends_a_film_with_the_picture_in_hand(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    if suffix == ".mp4":
        library = pytest.importorskip("imageio_ffmpeg", reason="the 'film' extra is missing")
    film = stopped(path, 1)
    assert (film.n_painted, film.written) == (2, True)
    if suffix == ".gif":
        assert len(pictures(path)[0]) == 2
    else:
        assert library.count_frames_and_secs(str(path))[0] == 5
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_ctrl_c_once_more_leaves_the_old_film_and_nothing_else(tmp_path: Path, suffix: str) -> None:
    if suffix == ".mp4":
        pytest.importorskip("imageio_ffmpeg", reason="the 'film' extra is missing")
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"old")
    assert not stopped(path, 2).written
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == b"old"
