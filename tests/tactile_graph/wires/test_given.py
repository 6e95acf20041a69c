"""What people hand in as frames becomes frames, or is told to be none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame, Image, load
from tactile_graph.errors import UsageError
from tactile_graph.wires.given import as_frame, as_frames

IMAGE = Image(np.ones((2, 3)), (0.5, 0.5), quantity="gram")


def test_frames_images_and_arrays_are_taken() -> None:
    own = Frame(IMAGE, index=7)
    frames = list(as_frames([own, IMAGE, np.ones((2, 3)), [[1.0]]]))
    assert frames[0] is own
    assert [f.index for f in frames] == [7, 1, 2, 3]
    assert frames[1].image is IMAGE
    assert frames[2].image.quantity == "raw"
    assert [f.index for f in as_frames(np.ones((2, 4, 4)))] == [0, 1]


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ("a.npy", r"got a path or text, 'a.npy'; with_source\('recording', path='a.npy'\) reads"),
        (Path("a b{}.npy"), r"got a path or text, 'a b\{\}.npy'; .*path='a b\{\}.npy'\)"),
        (IMAGE, "got one Image: a list of it is a stream of one"),
        (Frame(IMAGE), "got one Frame"),
        (np.ones((2, 3)), "got one ndarray"),
        ({"frames": np.ones((1, 2, 3))}, "got a dict: give one of its values; it has: frames"),
        (3, "got int"),
    ],
)
def test_what_is_no_stream_of_frames_is_refused_at_once(given: Any, told: str) -> None:
    with pytest.raises(UsageError, match=f"frames are needed, {told}"):
        as_frames(given)


@pytest.mark.parametrize(
    ("given", "told"),
    [("my.npy", "got a path or text"), ([Frame(IMAGE)] * 2, r"got a list of 2; stream\(\) takes")],
)
def test_what_is_no_frame_is_refused(given: Any, told: str) -> None:
    with pytest.raises(UsageError, match=f"a frame is needed, {told}"):
        as_frame(given)


def test_a_pipeline_takes_images_and_refuses_paths() -> None:
    pipeline = load("contacts")
    assert pipeline.run(IMAGE).frame.image is IMAGE
    assert [r.frame.image for r in pipeline.stream([IMAGE])] == [IMAGE]
    with pytest.raises(UsageError, match="frames are needed"):
        pipeline.stream("my.npy")
    with pytest.raises(UsageError, match="a frame is needed"):
        pipeline.run("my.npy")  # type: ignore[arg-type]
