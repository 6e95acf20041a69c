"""``--plot``: strips and films of a run, refused beforehand where they could not be drawn."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import pytest
from PIL import Image as Pillow

from helpers_cli import call
from tactile_graph.cli.output import plot
from tactile_graph.draw import film as films


@pytest.mark.slow
def test_run_writes_a_film_and_says_what_was_cut(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done = call("run", "discs", "--frames", 4, "--plot", "film.gif")
    assert done.exit_code == 0, done.output
    assert "wrote film.gif" in done.output
    with Pillow.open(hand_made / "film.gif") as gif:
        assert gif.n_frames == 4
    monkeypatch.setattr(films, "MOST_PICTURES", 2)
    told = call("run", "discs", "--frames", 4, "--plot", "film.gif").output
    assert "the film holds the first 2 pictures; --frames A:B takes others" in told


@pytest.mark.slow
@pytest.mark.parametrize("times", [1, 2])
def test_ctrl_c_while_a_film_is_painted_keeps_what_is_painted_unless_it_comes_again(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch, times: int
) -> None:
    real = films.Gif.add

    def add(self: films.Gif, *args: object) -> None:
        real(self, *args)
        for _ in range(times):
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(films.Gif, "add", add)
    done = call("run", "discs", "--frames", 4, "--plot", "film.gif")
    assert done.exit_code == 130
    kept = "wrote film.gif\nstopped while painting: the film holds 1 of 4 pictures" in done.stdout
    lost = "film.gif: not written; nothing of it is kept" in done.stderr
    assert (kept, lost) == (times == 1, times == 2)
    assert (hand_made / "film.gif").exists() == (times == 1)


@pytest.mark.usefixtures("hand_made")
def test_mp4_without_ffmpeg_is_refused_before_the_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    done = call("run", "discs", "--plot", "film.mp4")
    assert done.exit_code == 2
    assert 'films in MP4 need imageio-ffmpeg: pip install "tactile-graph[film]"' in done.stderr
    assert done.stdout == ""


@pytest.mark.usefixtures("hand_made")
def test_an_extra_that_is_broken_is_not_called_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "imageio_ffmpeg.py").write_text("import tg_no_such_module\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "imageio_ffmpeg", raising=False)
    done = call("run", "discs", "--plot", "film.mp4")
    assert done.exit_code == 2
    told = "it is installed, but cannot be imported: No module named 'tg_no_such_module'"
    assert told in " ".join(done.stderr.split())


def test_the_endings_of_strips_are_those_they_are_drawn_in() -> None:
    from tactile_graph.draw.strip import FORMATS

    assert {f".{form}" for form in FORMATS} == set(plot.PICTURES)
