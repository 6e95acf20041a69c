"""Several contacts on one pad: each has an outline of its own."""

import warnings

import numpy as np
import pytest

from tactile_graph import Frame, load
from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.any_pad.locate_contacts import LocateContacts, alone
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.single.density.element_terms import ON, UNKNOWN
from tactile_graph_pads.pad import load_pad

pytestmark = pytest.mark.usefixtures("plain_kernels")


def contacts_of(frame):
    return load("locate-contacts").runner(only=("objects",))(frame)["objects"].contacts


def two_discs(seed=3):
    scene = {
        "objects": [
            {"shape": "disc", "name": n, "weight_g": w, "radius_cm": r, "place": at}
            for n, w, r, at in (("a", 2000.0, 2.6, [4.5, 5.0]), ("b", 3000.0, 3.4, [14.0, 14.5]))
        ]
    }
    (frame,) = load("contacts").with_source("simulate", scene=scene, frames=1).frames(seed)
    return frame


@pytest.mark.slow  # three shapes are looked for
def test_each_contact_has_its_outline_the_largest_first():
    frame = two_discs()
    step = LocateContacts(shapes=["disc"])
    found = step(frame.image, contacts_of(frame))
    assert found.count == 2
    assert found.names == ("disc", "disc")
    large, small = found.shapes
    assert (large.x_cm, large.y_cm) == pytest.approx((14.0, 14.5), abs=0.4)
    assert (small.x_cm, small.y_cm) == pytest.approx((4.5, 5.0), abs=0.4)
    assert large.radius_cm == pytest.approx(3.4, abs=0.4)


def test_other_contacts_say_nothing_of_one():
    frame = two_discs()
    readings = observed(frame.image, load_pad("thesis"))
    owner = np.zeros(readings.states.shape, int)
    owner[:8], owner[8:] = 1, 2
    first = alone(readings, owner, 1)
    assert (first.states[8:] == UNKNOWN).all()
    assert first.touched == int((readings.states[:8] == ON).sum())


def test_a_contact_of_noise_has_no_outline():
    frame = two_discs()
    readings = observed(frame.image, load_pad("thesis"))
    owner = np.full(readings.states.shape, 2)
    owner[readings.states == ON] = 1
    with pytest.raises(Degenerate, match="contact 2: no reading rises above the noise"):
        alone(readings, owner, 2)


def held_beside_free():
    """Return counts over two discs, of which a converter's range holds some of one."""
    rng, at = np.random.default_rng(1), np.arange(16) + 0.5
    strong = 5000.0 * (np.hypot(at - 4.0, at[:, None] - 4.0) < 3.0)
    weak = 900.0 * (np.hypot(at - 12.0, at[:, None] - 11.0) < 2.6)
    loads = (strong + weak) * np.exp(rng.normal(0.0, 0.3, strong.shape))
    counts = np.round(50.0 + loads + rng.normal(0.0, 5.0, strong.shape))
    return Frame.of(np.clip(counts, 0.0, 4095.0), 1.0, quantity="counts")


@pytest.mark.slow
def test_a_contact_beside_one_that_a_limit_holds_is_located_without_warnings():
    frame = held_beside_free()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = LocateContacts(shapes=["disc"])(frame.image, contacts_of(frame))
    assert found.count == 2
    assert (found.shapes[1].x_cm, found.shapes[1].y_cm) == pytest.approx((12.0, 11.0), abs=0.4)


def test_no_contact_has_no_outline():
    assert LocateContacts(shapes=["disc"])(two_discs().image, ()).count == 0
