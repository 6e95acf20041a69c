"""Elements pressed in most frames rest where the others do; loose and stuck ones do not."""

import numpy as np
import pytest

from tactile_graph.errors import DataError
from tactile_graph_pads.learning.resting import resting_among_objects


def walked_on(share, scale, shape=(16, 12), n=100):
    """Return frames that read 0 but for a foot of uneven pressure in a share of them."""
    rng = np.random.default_rng(3)
    values = np.zeros((n, *shape))
    foot = scale * rng.uniform(0.2, 1.0, (n, 5, 4))
    values[:, 4:9, 3:7] = np.round(foot / 5.0) * 5.0
    values[rng.permutation(n)[: int(n * (1.0 - share))]] = 0.0
    return values


@pytest.mark.parametrize("share", [0.55, 0.8])
@pytest.mark.parametrize("scale", [100.0, 300.0])
def test_elements_pressed_in_most_frames_rest_where_the_others_do(share, scale):
    found = resting_among_objects(walked_on(share, scale), "it")
    assert found.good.all()
    assert not found.offset.any()
    assert not found.noise.any()


def test_stuck_elements_and_loose_contacts_are_stuck_still():
    values = walked_on(0.6, 100.0)
    values[:, 12, 9] = 150.0
    values[20:, 13, 2] = 150.0
    stuck = resting_among_objects(values, "it").stuck
    assert [tuple(at) for at in np.argwhere(stuck)] == [(12, 9), (13, 2)]


def test_what_is_hardly_ever_taken_off_is_refused():
    with pytest.raises(DataError, match=r"in more than half of the frames.*give it by --empty"):
        resting_among_objects(walked_on(0.95, 300.0), "it")


@pytest.mark.parametrize("noise", [1.0, 10.0])
def test_offsets_of_noise_that_is_cut_off_are_no_press(noise):
    rng = np.random.default_rng(4)
    offset = rng.normal(0.0, 0.5 * noise, (16, 12))
    values = np.maximum(np.round(offset + rng.normal(0.0, noise, (200, 16, 12))), 0.0)
    found = resting_among_objects(values, "it").offset
    assert found == pytest.approx(np.maximum(offset, 0.0), abs=0.5 + 0.4 * noise)


def test_frames_and_elements_that_are_not_read_tell_nothing():
    values = walked_on(0.6, 100.0)
    unread = np.full((80, 16, 12), np.nan)
    found = resting_among_objects(np.concatenate([unread, values]), "it")
    assert found.good.all()
    assert not found.offset.any()
    values[np.argsort(values.sum(axis=(1, 2)), kind="stable")[:50], 0, 0] = np.nan
    assert not resting_among_objects(values, "it").offset.any()
