import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_filters import ORIGIN, PITCH, drawn, image_of
from helpers_panel import panel_frames, real_panel_frames
from tactile_graph import loads
from tactile_graph.errors import PipelineError
from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_filters.contacts.sharpen_contacts import sharpen_contacts

SHARE_WIDTH = 2.0 * np.log(1 / 0.5)


def bump(x, y, sigma=2.0, peak=400.0):
    """Return a blurred fingertip, its middle at (x, y) in cells from the corner."""
    i, j = np.mgrid[:24, :30] + 0.5
    values = peak * np.exp(-((j - x) ** 2 + (i - y) ** 2) / (2 * sigma**2))
    return Image(values, PITCH, ORIGIN, "raw")


def found(image, level=20.0, **settings):
    return sharpen_contacts(
        contacts(image, image.mask(image.values > level), margin=1).contacts, **settings
    )


@settings(max_examples=30, deadline=None)
@given(st.floats(10, 20), st.floats(10, 14), st.floats(50, 1000))
def test_centre_and_area_of_a_bump_come_out_between_the_cells_at_any_strength(x, y, peak):
    one = found(bump(x, y, peak=peak), level=0.05 * peak, share=0.5, finer=16).contacts[0]
    cell = PITCH[0] * PITCH[1]
    assert one.x_cm == pytest.approx(ORIGIN[0] + x * PITCH[0], abs=0.05 * PITCH[0])
    assert one.y_cm == pytest.approx(ORIGIN[1] + y * PITCH[1], abs=0.05 * PITCH[1])
    assert one.area_cm2 == pytest.approx(np.pi * 4.0 * SHARE_WIDTH * cell, rel=0.1)


def test_a_higher_share_makes_a_smaller_contact():
    areas = [found(bump(14, 12), share=share).contacts[0].area_cm2 for share in (0.3, 0.6, 0.9)]
    assert areas == sorted(areas, reverse=True)


def test_what_was_counted_and_weighed_stays():
    image = bump(14, 12)
    before = contacts(image, image.mask(image.values > 20), margin=1).contacts[0]
    after = sharpen_contacts([before]).contacts[0]
    for name in ("number", "n_cells", "load", "peak", "box"):
        assert getattr(after, name) == getattr(before, name)
    assert after.area_cm2 < before.area_cm2


def test_contacts_without_load_and_no_contacts_at_all_stay_as_they_are():
    flat = contacts(image_of([[0.0, -1.0]]), drawn("##")).contacts
    assert sharpen_contacts(flat).contacts[0] is flat[0]
    assert sharpen_contacts([]) == ((), 0)


def test_a_single_cell_is_a_smaller_cell_about_its_middle():
    one = contacts(image_of([[0, 0, 0], [0, 5, 0], [0, 0, 0]]), drawn("...\n.#.\n..."), margin=1)
    sharp = sharpen_contacts(one.contacts, share=0.5, finer=8).contacts[0]
    middle = ORIGIN[0] + 1.5 * PITCH[0], ORIGIN[1] + 1.5 * PITCH[1]
    assert (sharp.x_cm, sharp.y_cm) == pytest.approx(middle)
    assert 0 < sharp.area_cm2 < PITCH[0] * PITCH[1]
    assert sharpen_contacts(one.contacts, share=0.999, finer=2).contacts[0] is one.contacts[0]


def test_cells_are_not_cut_into_more_than_memory_holds():
    text = (
        "pipeline: fine\nnodes: {one: {step: sharpen_contacts, in: frame, with: {finer: 1000000}}}"
    )
    with pytest.raises(PipelineError, match="finer: must be <= 64, got 1000000"):
        loads(f"{text}\noutputs: [one]\n")


@pytest.mark.slow
@pytest.mark.parametrize("real", [True, False], ids=["real", "look-alike"])
def test_on_a_capacitive_panel_the_areas_are_right_in_the_middle_and_none_is_missed(real, tmp_path):
    ratios = []
    for frame in real_panel_frames(slice(None, None, 6)) if real else panel_frames(tmp_path):
        got = found(frame.image, level=100.0).contacts
        assert len(got) == len(frame.truth)
        for one in got:
            true = min(
                frame.truth,
                key=lambda t: np.hypot(t.shape.x_cm - one.x_cm, t.shape.y_cm - one.y_cm),
            )
            ratios.append(one.area_cm2 / true.shape.area_cm2)
    assert 0.85 < np.median(ratios) < 1.15
