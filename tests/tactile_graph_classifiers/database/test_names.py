"""Names of objects, and of the recordings that readings are of."""

import pytest

from tactile_graph_classifiers.database.names import is_of_recording


@pytest.mark.parametrize(
    ("source", "file", "its"),
    [
        ("press.npz frame 3", "press.npz", True),
        ("press.npz left frame 3", "press.npz", True),
        ("press frame 3", "press", True),
        ("press 2.csv frame 3", "press", False),
        ("press 2.csv frame 3", "press 2.csv", True),
        ("other.npz frame 3", "press.npz", False),
    ],
)
def test_a_recording_is_told_from_another_whose_name_begins_so(
    source: str, file: str, its: bool
) -> None:
    assert is_of_recording(source, file) is its
