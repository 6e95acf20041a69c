"""``check_step`` finds what is broken, tells it in a line, and leaves what is right in peace."""

from __future__ import annotations

import math
import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import numpy as np
import pytest

from tactile_graph import Degenerate, Image, Mask, Points, Skip
from tactile_graph.errors import UsageError
from tactile_graph.steps import Grid, Quantity
from tactile_graph.testing import BrokenPromises, Case, all_cases, check_step, examine_step
from tactile_graph.testing import examination as trials
from tactile_graph.testing import trial as calls
from tactile_graph.testing.same import same
from tactile_graph.vocabulary import QUANTITIES
from tactile_graph.wires.stacks import Column, MaskStack


def all_finite(image: Image) -> None:
    if not image.values.size or not np.isfinite(image.filled()).all():
        raise Degenerate("no reading, or one that is no number")


# -- right -----------------------------------------------------------------------------------


def halved(
    image: Image, *, share: float = 0.5
) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    """Return half of each value."""
    all_finite(image)
    return image.with_values(image.values * share)


class Steady:
    """Return the mean of this image and the last; the first has none."""

    def __init__(self) -> None:
        self._last: Image | None = None

    def __call__(self, image: Image) -> float:
        all_finite(image)
        last, self._last = self._last, image
        if last is None:
            raise Skip("warming up")
        return 0.5 * float(np.mean(image.values / 2)) + 0.5 * float(np.mean(last.values / 2))


def scattered(points: Points, *, rng: np.random.Generator) -> Points:
    """Return the points moved a little; NaN is refused."""
    if not np.isfinite(points.xy_cm).all():
        raise Degenerate("a point is not finite")
    return Points(points.xy_cm + 0.01 * rng.standard_normal(points.xy_cm.shape))


@pytest.mark.parametrize("step", [halved, Steady, scattered])
def test_a_step_that_keeps_its_promises_passes(step: Callable[..., Any]) -> None:
    report = check_step(step)
    assert report.lines() == []
    assert report.n_cases > 15


# -- broken on purpose -----------------------------------------------------------------------


def writes_through(mask: Mask) -> Mask:
    mask.values.setflags(write=True)
    mask.values[:1] = False
    return Mask(mask.values.copy(), mask.pitch_cm)


def writes(mask: Mask) -> Mask:
    values = mask.values
    values |= True
    return mask


def gives_an_image(mask: Mask) -> Mask:
    return Image(mask.values.astype(float))  # type: ignore[return-value]


def gives_nothing(mask: Mask) -> float:
    return None if mask.count == 1 else 1.0  # type: ignore[return-value]


def forgets_the_quantity(image: Image) -> Annotated[Image, Quantity.like("image")]:
    return Image(np.zeros(image.shape), image.pitch_cm)


def loses_a_row(mask: Mask) -> Annotated[Mask, Grid.like("mask")]:
    return Mask(mask.values[1:].copy(), mask.pitch_cm)


def forgets_the_pitch(mask: Mask) -> Annotated[Mask, Grid.like("mask")]:
    return Mask(mask.values.copy())


def is_random(mask: Mask) -> float:
    return float(np.random.default_rng().random())


COUNTED: list[int] = []


def counts_its_calls(mask: Mask) -> int:
    COUNTED.append(1)
    return len(COUNTED)


class BreaksWarmedUp:
    """Skip five frames; then give NaN."""

    def __init__(self) -> None:
        self._n = 0

    def __call__(self, mask: Mask) -> float:
        self._n += 1
        if self._n <= 5:
            raise Skip(f"warming up: frame {self._n} of 5")
        return float("nan")


class HoldsALambda:
    stateless = True

    def __init__(self) -> None:
        self._double = lambda value: 2 * value

    def __call__(self, mask: Mask) -> int:
        return int(self._double(mask.count))


class Locked(NamedTuple):
    lock: Any


def answers_with_a_lock(mask: Mask) -> Locked:
    return Locked(threading.Lock())


def fails_without_cells(mask: Mask) -> int:
    return int(mask.values.astype(int).max())


def hands_nan_on(points: Points) -> Points:
    return Points(points.xy_cm[:, ::-1].copy())


def overflows(image: Image) -> float:
    all_finite(image)
    return float((image.filled() ** 2).sum())


def says_no_reason(mask: Mask) -> int:
    if not mask.count:
        raise Degenerate
    return mask.count


def says_too_much(mask: Mask) -> int:
    if not mask.count:
        raise Degenerate("nothing\nis\npressed")
    return mask.count


def ends_the_program(mask: Mask) -> int:
    if not mask.count:
        sys.exit("nothing pressed")
    return mask.count


def never_ends(image: Image) -> int:
    if 0.0 < image.peak < 1e-90:
        while True:
            math.sqrt(2.0)
    return 1


class HandsOutItsState:
    def __init__(self) -> None:
        self._sum = np.zeros((1, 2))

    def __call__(self, mask: Mask) -> Mask:
        if self._sum.shape != mask.shape:
            self._sum = np.zeros(mask.shape, dtype=np.bool_)
        self._sum.setflags(write=True)
        self._sum |= mask.values
        return Mask(self._sum, mask.pitch_cm)


def says_badly(mask: Mask) -> int:
    return mask.count


def broken_notice(mask: Mask) -> str:
    raise ValueError(f"{mask.count} cells")


says_badly.notice = broken_notice  # type: ignore[attr-defined]


def says_of_no_port(mask: Mask) -> int:
    return mask.count


says_of_no_port.notice = lambda msk, value: ""  # type: ignore[attr-defined]


class Assuming(NamedTuple):
    x_cm: float

    @property
    def assumed(self) -> str:
        raise KeyError("nobody")


def assumes_badly(mask: Mask) -> Assuming:
    return Assuming(1.0)


class Summed(NamedTuple):
    x_cm: float

    def summary(self) -> dict[str, float]:
        return [self.x_cm]  # type: ignore[return-value]


def sums_badly(mask: Mask) -> Summed:
    return Summed(1.0)


class Nowhere(NamedTuple):
    name: str = "nowhere"

    def outline_cm(self) -> Any:
        return np.full((3, 2), np.nan)


def draws_nowhere(mask: Mask) -> Nowhere:
    return Nowhere()


BROKEN: list[tuple[Callable[..., Any], str]] = [
    (writes_through, "writes into its input mask; change a copy"),
    (writes, "raises ValueError: output array is read-only"),
    (gives_an_image, "promises Mask, but gave Image of"),
    (gives_nothing, "a single cell (and 1 more case): returns None; raise Degenerate or Skip"),
    (forgets_the_quantity, "promises volt, but gave raw"),
    (loses_a_row, "promises 8 x 9 cells, but gave 7 x 9"),
    (forgets_the_pitch, "promises a pitch of 1.3 by 1.3 cm, but gave 1 by 1"),
    (is_random, "gives another answer the second time"),
    (counts_its_calls, "gives another answer the second time"),
    (HoldsALambda, "the step cannot be pickled"),
    (answers_with_a_lock, "its answer cannot be pickled"),
    (fails_without_cells, "an image without cells (and 1 more case): raises ValueError: zero-size"),
    (hands_nan_on, "(and 1 more case): gives as good what is none: xy_cm holds 1 of 48"),
    (overflows, "values of 1e+300: gives as good what is none: the answer is inf"),
    (says_no_reason, "raises Degenerate without a reason"),
    (says_too_much, "raises Degenerate with more than one clear line"),
    (ends_the_program, "raises SystemExit: nothing pressed"),
    (never_ends, "values of 1e-100 (and 1 more case): was stopped after"),
    (BreaksWarmedUp, "an ordinary frame (and 16 more cases): gives as good what is none"),
    (says_badly, "its notice cannot be had: ValueError: "),
    (says_of_no_port, "its notice asks for 'msk', which is none of its ports; did you mean 'mask'"),
    (assumes_badly, "its assumed cannot be had: KeyError: 'nobody'"),
    (sums_badly, "its summary cannot be had: PluginError: Summed.summary() must return a mapping"),
    (draws_nowhere, "its drawing cannot be had: ValueError: none of its 3 places is a number"),
    (HandsOutItsState, "writes into what it gave before; give a copy"),
]


SEVERAL = (writes, loses_a_row, hands_nan_on)
"""Whose one fault breaks several promises."""


@pytest.mark.parametrize(("step", "told"), BROKEN, ids=lambda v: getattr(v, "__name__", ""))
def test_what_is_broken_is_told_in_a_line(
    step: Callable[..., Any], told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if step is never_ends:
        monkeypatch.setattr(trials, "LEAST_S", 0.05)  # which a busy machine may take for the others
    with pytest.raises(BrokenPromises) as caught:
        check_step(step)
    lines = str(caught.value).splitlines()
    assert lines == caught.value.report.lines()
    assert [line for line in lines if told in line], lines
    assert all(line.startswith(f"step {step.__name__!r}: ") for line in lines)
    assert len(lines) == 1 or step in SEVERAL


def goes_away(mask: Mask) -> int:
    os.chdir(os.path.dirname(__file__))
    return mask.count


def has_numpy_raise(mask: Mask) -> int:
    np.seterr(all="raise")
    return mask.count


def has_warnings_raise(mask: Mask) -> int:
    warnings.simplefilter("error")
    return mask.count


def handles_signals(mask: Mask) -> int:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    return mask.count


def draws(mask: Mask) -> int:
    np.random.random()  # noqa: NPY002
    return mask.count


@pytest.mark.parametrize(
    ("step", "what"),
    [
        (goes_away, "the current folder"),
        (has_numpy_raise, "how NumPy tells errors"),
        (has_warnings_raise, "whether warnings are errors"),
        (handles_signals, "the handlers of signals"),
        (draws, "the random numbers of numpy.random"),
    ],
)
def test_what_a_step_changes_for_all_steps_is_told_and_put_back(
    step: Callable[..., Any], what: str
) -> None:
    before = os.getcwd(), np.geterr(), signal.getsignal(signal.SIGTERM)
    report = examine_step(step)
    assert [b.what for b in report.broken] == [
        f"changes {what}, which all steps share; put it back"
    ]
    assert (os.getcwd(), np.geterr(), signal.getsignal(signal.SIGTERM)) == before


def waits(image: Image) -> float:
    time.sleep(60.0)
    return 1.0


@pytest.mark.slow
def test_a_step_that_waits_for_ever_is_told_after_one_case(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calls, "WAITS_S", 0.3)
    report = examine_step(waits)
    (line,) = report.lines()
    assert line.startswith("step 'waits': an ordinary frame: was stopped after 0.")
    assert report.n_cases == 1


def sleepy(image: Image) -> float:
    all_finite(image)
    if image.shape != (8, 9):
        time.sleep(60.0)
    return 1.0


def test_no_more_cases_are_tried_once_several_took_too_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(calls, "WAITS_S", 0.03)
    report = examine_step(sleepy)
    assert report.n_cases < 10
    (line,) = report.lines()
    assert "(and 2 more cases): was stopped after " in line


class Spot:
    def __init__(self, x_cm: float) -> None:
        self.x_cm = x_cm


def spot(mask: Mask) -> Spot:
    """Return a record that does not say when another equals it."""
    return Spot(float(mask.count))


def test_a_record_without_an_equality_is_held_against_another_by_its_content() -> None:
    assert check_step(spot).n_values > 15


def short(mask: Mask) -> float:
    return float(mask.count)


def two_values(mask: MaskStack) -> Column:
    return Column(np.zeros(3))


short.stacked = two_values  # type: ignore[attr-defined]


class Incomparable:
    def __init__(self, count: int) -> None:
        self.count = count

    def __eq__(self, other: object) -> bool:
        raise RuntimeError("no equality")

    __hash__ = None  # type: ignore[assignment]


def test_a_record_whose_equality_raises_is_held_against_another_by_its_content() -> None:
    assert same(Incomparable(1), Incomparable(1))
    assert not same(Incomparable(1), Incomparable(2))


def test_the_same_fault_of_a_stacked_form_is_one_line() -> None:
    (line,) = examine_step(short).lines()
    assert line.endswith("gives no stack of as many values as it took: Column of 3")


def test_a_signature_that_does_not_hold_together_is_told() -> None:
    def bare(image, *, level=1.0):  # type: ignore[no-untyped-def]
        return image

    (line,) = examine_step(bare).lines()
    assert line == "step 'bare': its signature: parameter 'level' has no annotation"


def test_a_report_is_shown_as_lines() -> None:
    def unlike(image: Image) -> float:
        return math.nan

    report = examine_step(unlike)
    assert str(report).splitlines() == report.lines()
    kept = examine_step(halved)
    told = f"{kept.n_values} of {kept.n_cases} cases gave a value"
    assert str(kept) == f"step 'halved' keeps its promises: {told}"
    untried = str(examine_step("simplify_polygon"))
    assert untried.startswith("step 'simplify_polygon' was not tried: ")
    assert "must be given" in untried


# -- what cannot be tried --------------------------------------------------------------------


def needs_a_level(mask: Mask, *, level: float) -> float:
    return level * mask.count


class Unheard:
    """A type that no step gives."""


def needs_the_unheard(thing: Unheard) -> int:
    return 1


def test_a_missing_setting_is_asked_for_and_taken() -> None:
    with pytest.raises(UsageError, match="'needs_a_level' cannot be tried: setting 'level' is mis"):
        check_step(needs_a_level)
    assert check_step(needs_a_level, settings={"level": 2.0}).n_values > 10


def test_settings_that_a_step_refuses_are_no_promise_broken() -> None:
    assert "must be given" in examine_step("simplify_polygon").untried


@pytest.mark.slow
def test_a_value_that_nothing_gives_is_made_by_the_author() -> None:
    assert "no step on offer gives a Unheard" in examine_step(needs_the_unheard).untried
    made = check_step(needs_the_unheard, inputs={"thing": lambda case: case.name})
    assert made.n_values == made.n_cases > 15


@pytest.mark.slow
def test_types_of_plugins_are_made_by_the_steps_that_give_them() -> None:
    report = check_step("rotate_points")
    assert report.n_values > 15


# -- the cases -------------------------------------------------------------------------------


def test_every_case_has_a_name_and_fits_together() -> None:
    found = list(all_cases())
    assert len({c.name for c in found}) == len(found)
    for case in found:
        assert case.values.shape == case.on.shape
        assert case.xy_cm.shape[1:] == (2,)


@pytest.mark.parametrize("quantity", sorted(QUANTITIES))
def test_a_case_makes_new_values_each_time(quantity: str) -> None:
    case: Case = next(iter(all_cases()))
    one, other = case.image(quantity), case.image(quantity)
    assert (one.values == other.values).all()
    assert not np.may_share_memory(one.values, other.values)
    assert one.quantity == quantity
