import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_pads.geometry import Geometry


def test_the_thesis_pad_spans_20_5_cm_with_centres_every_1_3_cm():
    pad = Geometry()
    assert pad.size_cm == pytest.approx((20.5, 20.5))
    np.testing.assert_allclose(pad.x_cm, 0.5 + 1.3 * np.arange(16))
    assert pad.origin_cm == (-0.15, -0.15)


def test_an_image_of_the_pad_has_its_cells_centred_on_the_elements():
    pad = Geometry(3, 5, 0.8, 0.4)
    image = Image(np.zeros(pad.shape), (pad.pitch_cm, pad.pitch_cm), pad.origin_cm)
    np.testing.assert_allclose(image.x_cm, pad.x_cm)
    np.testing.assert_allclose(image.y_cm, pad.y_cm)
    assert pad.size_cm == pytest.approx((5.6, 3.2))
    assert pad.element_area_cm2 == pytest.approx(0.64)
