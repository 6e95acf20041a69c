"""Records changed as `dataclasses.replace` changes them."""

from dataclasses import FrozenInstanceError, replace

import pytest

from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.noise import Noise


def test_a_changed_record_is_another_with_some_fields_others():
    before = Model(0, noise=Noise(sigma=0.7))
    after = changed(before, whole=0.5, noise=changed(before.noise, voids=0.2))
    assert after == replace(before, whole=0.5, noise=replace(before.noise, voids=0.2))
    assert before == Model(0, noise=Noise(sigma=0.7))
    with pytest.raises(FrozenInstanceError):
        after.whole = 0.1  # type: ignore[misc]


def test_what_a_record_has_kept_for_itself_is_left_behind():
    before = Model(0)
    kept = before._noise_at(1.3)
    after = changed(before, noise=Noise(sigma=0.9))
    assert after._noise_at(1.3)[0][0] == 0.9
    assert before._noise_at(1.3) is kept
