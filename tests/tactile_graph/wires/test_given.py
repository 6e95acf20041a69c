"""What people hand in as frames becomes frames, or is told to be none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame, Image, load
from tactile_graph.errors import FrameError, UsageError
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


ONES = np.ones((2, 3))


def _image(values: Any = ONES, *rest: Any, **more: Any) -> Image:
    return Image(np.array(values), *rest, **more)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (_image(quantity="volts"), "unknown quantity 'volts'; did you mean 'volt'"),
        (_image(ONES, (0.0, 1.0)), "a pitch must be > 0 cm"),
        (_image(ONES, (-1.0, 1.0)), "a pitch must be > 0 cm"),
        (_image(ONES, (np.nan, 1.0)), "a pitch must be > 0 cm"),
        (_image(ONES, ("1", 1.0)), "a pitch is one number or two"),
        (_image(ONES, (1.0, 1.0), (np.inf, 0.0)), "an origin must be within"),
        (_image(ONES + 1j), "a frame takes real numbers, got complex128"),
        (
            _image(valid=np.ones((1, 3), bool)),
            r"valid must be a bool .* got bool of shape \(1, 3\)",
        ),
        (_image(valid=np.ones((2, 3))), r"valid must be a bool .* got float64"),
        (ONES + 1j, "a frame takes real numbers, got complex128"),
    ],
)
def test_an_image_that_makes_no_frame_is_refused_as_an_array_is(given: Any, told: str) -> None:
    pipeline = load("contacts")
    with pytest.raises(FrameError, match=f"^{told}") as caught:
        pipeline.run(given)
    assert isinstance(caught.value, UsageError)
    assert isinstance(caught.value, ValueError)
    with pytest.raises(FrameError, match=f"^frame 1: {told}"):
        list(pipeline.stream([_image(), given]))


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_cells_of_an_image_that_are_no_readings_are_as_those_of_an_array(dtype: type) -> None:
    values = np.array([[1.0, np.nan, 2.0], [np.inf, 1e-30, 3.0]], dtype)
    values[1, 1] **= 4  # of double precision it is next to nothing
    got, wanted = as_frame(Image(values.copy())).image, Frame.of(values).image
    np.testing.assert_array_equal(got.values, wanted.values)
    np.testing.assert_array_equal(got.valid, wanted.valid)
    assert got.values.dtype == dtype
    assert not got.values.flags.writeable
    valid = np.array([[True, False, False], [True, True, True]])
    both = as_frame(Image(values.copy(), valid=valid)).image
    assert both.valid.tolist() == [[True, False, False], [False, True, True]]
    assert both.values.tolist() == [[1.0, 0.0, 0.0], [0.0, 0.0, 3.0]]


def test_a_pitch_of_an_image_may_be_given_as_that_of_a_frame() -> None:
    assert as_frame(Image(ONES.copy(), 1.3)).image.pitch_cm == (1.3, 1.3)  # type: ignore[arg-type]
    assert as_frame(Image(ONES.copy(), np.array([1, 2]))).image.pitch_cm == (1.0, 2.0)  # type: ignore[arg-type]


def test_a_pipeline_takes_images_and_refuses_paths() -> None:
    pipeline = load("contacts")
    assert pipeline.run(IMAGE).frame.image is IMAGE
    assert [r.frame.image for r in pipeline.stream([IMAGE])] == [IMAGE]
    with pytest.raises(UsageError, match="frames are needed"):
        pipeline.stream("my.npy")
    with pytest.raises(UsageError, match="a frame is needed"):
        pipeline.run("my.npy")  # type: ignore[arg-type]
