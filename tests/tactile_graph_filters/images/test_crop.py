import numpy as np
import pytest

from helpers_filters import ORIGIN, PITCH, drawn, image_of
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.images.crop import Cropped, crop

MASK = drawn("""
    ......
    ..##..
    ...#..
    ......
""")


def picture(valid=None):
    return image_of(np.arange(24.0).reshape(4, 6), "gram", valid)


def test_the_part_keeps_its_place_on_the_pad():
    image, mask = crop(picture(), MASK, margin=0)
    assert image.values.tolist() == [[8.0, 9.0], [14.0, 15.0]]
    assert mask.values.tolist() == [[True, True], [False, True]]
    assert image.origin_cm == mask.origin_cm
    assert image.origin_cm == pytest.approx((ORIGIN[0] + 2 * PITCH[0], ORIGIN[1] + PITCH[1]))
    assert image.x_cm == pytest.approx(picture().x_cm[2:4])
    assert image.y_cm == pytest.approx(picture().y_cm[1:3])
    assert image.quantity == "gram"


def test_the_margin_goes_as_far_as_the_image_does():
    assert crop(picture(), MASK, margin=1).image.shape == (4, 4)
    whole = crop(picture(), MASK, margin=99)
    assert whole.image.shape == whole.mask.shape == (4, 6)
    assert whole.image.origin_cm == pytest.approx(ORIGIN)


def test_invalid_cells_are_cropped_along():
    valid = np.ones((4, 6), bool)
    valid[1, 2] = False
    assert crop(picture(valid), MASK, margin=0).image.valid.tolist() == [
        [False, True],
        [True, True],
    ]


def test_nothing_of_the_whole_image_is_kept_alive():
    cropped = crop(picture(), MASK)
    assert cropped.image.values.base is None
    assert cropped.mask.values.base is None


def test_an_empty_mask_is_degenerate():
    with pytest.raises(Degenerate, match="no cell of the mask is on, so there is no contact"):
        crop(picture(), MASK.with_values(np.zeros((4, 6), bool)))


def test_ports_for_an_image_or_a_mask_take_the_result():
    assert Cropped.provides == {Image: "image", Mask: "mask"}
